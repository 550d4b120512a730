"""The watcher: live data of an axis as lines of JSON for a page; it sets parameters of its nodes on request.

A line on standard output every 100 ms: `series`, name -> [[time s, value], ...] since the last line, and `status`, the
diagnostics of each node. A line on standard input, {"node": "/simulator", "name": "piston.mass", "value": 6.0}, sets a
parameter; the answer is a line {"answer": ..., "successful": ...}. It ends when its standard input closes.
"""

import json
import queue
import sys
import threading
from collections.abc import Callable, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import deserialize_message

from pneumo_ros.axis.setting import Setting
from pneumo_ros.records import contract
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.identification.target import Target
from pneumo_ros.ros.intake import Intake, Taken
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.readers import JointReader, number, pressure
from pneumo_ros.ros.run import run

PERIOD = 0.1  # s between lines
MOST = 10  # values of a series in a line: 100 Hz are enough for the eye
DIAGNOSTICS = "/diagnostics"
NUMBERS = {"position/reference": "reference", contract.COMMAND: "voltage"}
PRESSURES = {contract.PRESSURE_A: "pressure_a", contract.PRESSURE_B: "pressure_b"}
SETTINGS = (Setting("joint_name", contract.JOINT, "the piston in joint_states", live=False),)


class Watcher(AxisNode):
    """Reports received messages."""

    def __init__(self) -> None:
        super().__init__("watcher", SETTINGS)
        self.parameters.refuse_unknown()
        self._joints = {name: JointReader(self.parameters["joint_name"]) for name in self._joint_topics()}
        self._readers: dict[str, tuple[str, Callable[[bytes], float]]] = {}
        self._intake, self._target = Intake(self), Target(self)
        self._asked: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        for topic in self._joints:
            self._intake.subscribe(topic, contract.TYPES[contract.JOINT_STATES], False)
        self._intake.subscribe(DIAGNOSTICS, "diagnostic_msgs/msg/DiagnosticArray", False)
        for names, read in ((NUMBERS, number), (PRESSURES, pressure)):
            for topic, name in names.items():
                whole = self.resolve_topic_name(topic)
                self._readers[whole] = (name, read)
                self._intake.subscribe(whole, contract.TYPES[topic], False)
        self.create_timer(PERIOD, self._tell, clock=self.steady_clock)

    def _joint_topics(self) -> tuple[str, str]:
        """Joint states and setpoints, by their full names."""
        return self.resolve_topic_name(contract.JOINT_STATES), self.resolve_topic_name(contract.SETPOINT)

    def start(self) -> None:
        """Listen to standard input."""
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        for line in sys.stdin:
            self._asked.put(json.loads(line))
        self.end()

    def _tell(self) -> None:
        heard = self._intake.take()
        series: dict[str, list[tuple[float, float]]] = {}
        status: dict[str, Any] = {}
        for one in heard:
            if one.topic == DIAGNOSTICS:
                status |= _status(one.payload)
            else:
                for name, value in self._values(one):
                    series.setdefault(name, []).append((one.received * 1e-9, value))
        thinned = {name: values[:: -(-len(values) // MOST)] for name, values in series.items()}
        _say({"series": thinned, "status": status})
        if not self._asked.empty():
            asked = self._asked.get()
            self._target.set(str(asked["node"]), {str(asked["name"]): asked["value"]}, _answer)

    def _values(self, one: Taken) -> list[tuple[str, float]]:
        if one.topic not in self._joints:
            name, read = self._readers[one.topic]
            return [(name, read(one.payload))]
        sample = self._joints[one.topic].read(one.payload)
        if sample is None:
            return []
        if one.topic == self._joint_topics()[1]:
            return [("setpoint", sample.position)]
        velocity = [] if sample.velocity is None else [("velocity", sample.velocity)]
        return [("position", sample.position), *velocity]


def _status(payload: bytes) -> dict[str, Any]:
    """Diagnostics by node: level, sentence and values."""
    found = deserialize_message(payload, DiagnosticArray).status
    return {
        one.name: {"level": one.level[0], "message": one.message, "values": {p.key: p.value for p in one.values}}
        for one in found
    }


def _answer(successful: bool, reason: str) -> None:
    _say({"answer": reason, "successful": successful})


def _say(line: dict[str, Any]) -> None:
    print(json.dumps(line), flush=True)


def main(args: Sequence[str] | None = None) -> int:
    """Run the node; returns the exit code of the process."""
    given = parse("watcher", "Report what an axis does as lines of JSON.", SETTINGS, args)
    return run(lambda: [Watcher()], "watcher", given.ros)


if __name__ == "__main__":
    sys.exit(main())
