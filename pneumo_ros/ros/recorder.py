"""The recorder node: topics as bytes into a rosbag2 folder that is valid at any time."""

import json
import sys
import threading
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rclpy.qos import ReliabilityPolicy
from std_msgs.msg import String

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.priority import PRIORITY, take_priority
from pneumo_ros.axis.setting import Setting
from pneumo_ros.errors import PneumoError, UsageError
from pneumo_ros.plant.axes_section import AXES, axis_names
from pneumo_ros.records import BagTopic, BagWriter
from pneumo_ros.records.contract import DESCRIPTION, TYPES
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.intake import Intake, Taken, latches
from pneumo_ros.ros.message_classes import definition
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.qos import LATCHED
from pneumo_ros.ros.run import run
from pneumo_ros.ros.selection import Selection

TAKE = 0.005  # s between two looks into the queues
DISCOVER = 0.2  # s between two looks at the publishers

SETTINGS = (
    Setting("output", "", "folder to make; none: recording_ and the time, in the current folder", live=False),
    Setting(
        "topics", [*TYPES, "/diagnostics"],
        "topics to record, of the node's namespace unless they start with /; * and ? match any letters", live=False,
    ),
    Setting(
        "axes", [""], "axes in namespaces below the node's, recorded as well; none: those that a description lists",
        live=False,
    ),
    PRIORITY,
)  # fmt: skip


class Recorder(AxisNode):
    """Records the topics its parameter `topics` selects, from its start to its end."""

    def __init__(self) -> None:
        super().__init__("recorder", SETTINGS)
        self.parameters.refuse_unknown()
        self._selection = Selection(self, self.parameters["topics"])
        self._selection.extend(self._of_axes(axis for axis in self.parameters["axes"] if axis))
        output = self.parameters["output"] or time.strftime("recording_%Y_%m_%d-%H_%M_%S")
        self._writer = BagWriter(Path(output).expanduser())
        self._lock = threading.Lock()  # the end comes from another thread than the callbacks
        self._ended = False
        self._held: list[Taken] = []
        self._priority = 0
        self._began = time.monotonic()
        self._intake = Intake(self)
        for topic, (kind, latched) in self._selection.known.items():
            self._intake.subscribe(topic, kind, latched)
        self.create_subscription(String, DESCRIPTION, self._describes, LATCHED)
        self.create_timer(TAKE, self._take, clock=self.steady_clock)
        self.create_timer(DISCOVER, self._discover, clock=self.steady_clock)
        self.get_logger().info(f"recording to {self._writer.path}")

    def chosen(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Of a machine file of several axes, their names."""
        names = {setting.name for setting in SETTINGS}
        return {name: value for name, value in given.items() if AXES not in given or "." not in name or name in names}

    def _of_axes(self, axes: Iterable[str]) -> list[str]:
        """The selected topics of the node's namespace, of each axis below it."""
        return [f"{axis}/{topic}" for axis in axes for topic in self.parameters["topics"] if topic[0] != "/"]

    def _describes(self, message: String) -> None:
        """Record the axes that the description of a machine lists, too."""
        try:
            axes = list(axis_names(json.loads(message.data)["model"]))
            found = self._selection.extend(self._of_axes(axes))
        except (ValueError, TypeError, KeyError, AttributeError, UsageError):  # anybody may publish anything
            return
        if found:
            self.get_logger().info(f"recording the axes {', '.join(axes)}, too")
        for topic, (kind, latched) in found.items():
            self._intake.subscribe(topic, kind, latched)

    def start(self) -> None:
        """Ask for real-time scheduling: otherwise nodes that have it make the middleware's queues overflow."""
        self._priority = take_priority(self.parameters[PRIORITY.name])

    def health(self) -> Health:
        """Counts of messages recorded and lost."""
        counts = self._writer.counts
        lost = dict(self._intake.lost)
        values = {
            "output": self._writer.path,
            "messages": sum(counts.values()),
            "topics": len(counts),
            "lost_messages": sum(lost.values()),
            "real_time_priority": self._priority,
        }
        warnings = [_lost(lost)] if lost else []
        if not counts:
            warnings.append("nothing to record yet: no publisher of any of its topics")
        return Health({**values, **{f"lost_on {topic}": number for topic, number in lost.items()}}, warnings)

    def finish(self) -> None:
        """Record what has arrived, close the bag, and log its contents."""
        with self._lock:
            if self._ended:
                return
            self._ended = True
            self._store(self._held + self._intake.take())
            self._writer.close()
        counts, lost = self._writer.counts, self._intake.lost
        self._intake.close()
        self.get_logger().info(
            f"recorded {sum(counts.values())} messages on {len(counts)} topics to {self._writer.path} "
            f"in {time.monotonic() - self._began:.1f} s; {_lost(lost) if lost else 'nothing lost'}"
        )

    def _take(self) -> None:
        """Fetch new messages, and record those that no earlier message can follow.

        Messages must be in the order of time, also in the bag of a killed recorder. An earlier message may still follow
        those of this round, but not those of the round before.
        """
        with self._lock:
            if self._ended:
                return
            fresh = self._intake.take()
            last = max((one.received for one in self._held), default=None)
            ready = self._held + [one for one in fresh if last is not None and one.received <= last]
            self._held = [one for one in fresh if last is None or one.received > last]
            self._store(ready)

    def _store(self, messages: list[Taken]) -> None:
        """Write messages in the order of time. A bag that cannot be written ends the node."""
        try:
            for one in sorted(messages, key=lambda one: one.received):
                if one.topic not in self._writer.counts:
                    self._writer.add_topic(self._describe(one.topic))
                self._writer.write(one.topic, one.received, one.payload, one.published)
            self._writer.flush_if_due()
        except PneumoError as error:
            self._ended = True
            self.fail(error)

    def _describe(self, topic: str) -> BagTopic:
        """How `topic` is recorded: with its type as installed here, and as its publishers offer it."""
        kind = self._intake.types[topic]
        offered = [one.qos_profile for one in self.get_publishers_info_by_topic(topic)]
        reliable = all(one.reliability != ReliabilityPolicy.BEST_EFFORT for one in offered)
        return BagTopic(topic, kind, bool(offered) and all(map(latches, offered)), reliable, definition(kind))

    def _discover(self) -> None:
        """Subscribe to selected topics that have appeared."""
        for topic, kind, latched in self._selection.appeared(self._intake.types):
            self._intake.subscribe(topic, kind, latched)
        self._intake.relax()


def _lost(lost: dict[str, int]) -> str:
    """Losses in words."""
    return "lost " + ", ".join(f"{number} on {topic}" for topic, number in lost.items())


def main(args: Sequence[str] | None = None) -> int:
    """Run the recorder; returns the exit code of the process."""
    given = parse("recorder", "Record topics into a rosbag2 folder (MCAP).", SETTINGS, args)
    return run(lambda: [Recorder()], "recorder", given.ros)


if __name__ == "__main__":
    sys.exit(main())
