"""The commissioning as a node: begins, says what to swap, begins again when told, and publishes what was found."""

import json
from collections import deque
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

from std_msgs.msg import String
from std_srvs.srv import Trigger

from pneumo_ros.axis.commission.job import DONE, MEND, Job, command_line
from pneumo_ros.axis.commission.settings import SETTINGS
from pneumo_ros.axis.health import Health
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.qos import LATCHED

ERROR = "pneumo: error: "


class Commission(AxisNode):
    """Runs `pneumo commission` on the plant in its namespace; ~/start, ~/stop, ~/result."""

    def __init__(self, effects_files: Iterable[str | Path] = ()) -> None:
        """Raises UsageError for a bad parameter."""
        super().__init__("commission", SETTINGS)
        self.parameters.refuse_unknown()
        self._effects = [word for path in effects_files for word in ("--effects", str(path))]
        self._job: Job | None = None
        self._said: deque[str] = deque(maxlen=100)
        self._again = 0  # times that plugs were mended
        self._state, self._mend, self._failure = "not begun", dict[str, str](), ""
        self._results = self.create_publisher(String, "~/result", LATCHED)
        self.create_service(Trigger, "~/start", self._start)
        self.create_service(Trigger, "~/stop", self._stop)

    def start(self) -> None:
        """Begin, unless it is to wait for ~/start."""
        if self.parameters["auto"]:
            self._begin()

    def ready(self) -> str:
        """What it will move."""
        space = self.get_namespace()
        return f"ready: commissions the axis in {space}" + ("" if self.parameters["auto"] else "; call ~/start")

    # --- services -------------------------------------------------------------------------------------------------

    def _start(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Begin, or go on where it was broken off; after plugs were mended, begin again."""
        if self._job is not None and self._job.busy:
            response.success, response.message = False, f"under way: {self._state}"
            return response
        self._again += bool(self._mend)
        self._begin()
        response.success, response.message = True, "begun; what is found comes on ~/result"
        return response

    def _stop(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Close the valve and break off; ~/start goes on from there."""
        busy = self._job is not None and self._job.busy
        if busy and self._job is not None:
            self._job.stop()
        response.success = busy
        response.message = "the valve is closed; ~/start goes on" if busy else "nothing is under way"
        return response

    def _begin(self) -> None:
        self._state, self._mend, self._failure = "beginning", {}, ""
        line = command_line(self.parameters.values(), self.get_namespace().strip("/"), self._again)
        self._job = Job([*line, *self._effects], self._told, self._ended)

    # --- what the verb says, in threads of its own --------------------------------------------------------------------

    def _told(self, sentence: str) -> None:
        self._said.append(sentence)
        self.executor.create_task(self._log)

    def _log(self) -> None:
        while self._said:
            sentence = self._said.popleft()
            if sentence.startswith(ERROR):
                self._failure = sentence.removeprefix(ERROR)
                self.get_logger().error(self._failure)
            else:
                self._state = sentence
                self.get_logger().info(sentence)

    def _ended(self, code: int, result: dict[str, Any]) -> None:
        self.executor.create_task(partial(self._conclude, code, result))

    def _conclude(self, code: int, result: dict[str, Any]) -> None:
        """Publish the result, or say what to swap; the node goes on."""
        self._log()
        self._mend = result.get("wiring", {}).get("swap", {}) if code == MEND else {}
        if code == DONE:
            self._state = "done"
            self.get_logger().info(f"done: {result.get('machine_file') or result.get('rig_file')}")
        elif code == MEND:
            self._state = "waits for plugs to be mended, or for as_wired"
            for word, remedy in self._mend.items():
                self.get_logger().error(f"{word}: {remedy}; then call ~/start")
        else:
            self._state = f"ended with exit code {code}"
        if result:
            self._results.publish(String(data=json.dumps({**result, "exit_code": code})))

    # --- what it says -------------------------------------------------------------------------------------------------

    def health(self) -> Health:
        """What is being done, and what is to be mended."""
        warnings = [f"{word}: {remedy}" for word, remedy in self._mend.items()]
        values = {"state": self._state, "machine_file": self.parameters["output"], "begun_again": self._again}
        return Health(values, warnings, [self._failure] if self._failure else [])

    def finish(self) -> None:
        """The valve is closed."""
        if self._job is not None:
            self._job.stop()
