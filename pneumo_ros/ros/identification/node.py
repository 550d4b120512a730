"""The identification: makes a machine from recordings, while its services keep answering."""

import json
import time
from collections import deque
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from std_msgs.msg import String
from std_srvs.srv import Trigger

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.identification import result_file
from pneumo_ros.axis.identification.arrivals import Arrivals, Print
from pneumo_ros.axis.identification.settings import SETTINGS
from pneumo_ros.axis.identification.worker import Line, Worker
from pneumo_ros.axis.rig import recorded_as, rig_of
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Library, load_model, model_from_dict
from pneumo_ros.plant.axes_section import place_of
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.ros.description import Description, describe
from pneumo_ros.ros.identification.target import Target
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.qos import LATCHED

LOOK = 0.5  # s between two looks for recordings


class Identification(AxisNode):
    """Watches recordings, identifies, publishes, writes a machine file and, if asked, sets it on another node."""

    def __init__(self, effects_files: Iterable[str | Path] = ()) -> None:
        """Raises UsageError or DataError for a bad parameter or machine file."""
        super().__init__("identification", SETTINGS)
        self.parameters.refuse_unknown()
        self._files = tuple(effects_files)
        values = self.parameters.values()
        self._rig = rig_of(values)
        named = (
            self._rig.machine if self._rig.machine and "model" not in self.parameters.begun_with else values["model"]
        )
        self.start_model = self.model = load_model(named, self._files)
        self._axis = place_of(named)[1] or ""  # of two.yaml:shoulder, whose recordings hold all axes
        self._words = recorded_as(values, closed_signal(self.model))
        self._arrivals, self._ready, self._waiting = Arrivals(), dict[Path, Print](), dict[Path, str]()
        self._used: dict[Path, Print] = {}  # at the last start
        self._changed = time.monotonic()
        self._progress, self._stage = 0, "idle"
        self._done, self._last, self._applied = 0, "", ""
        self._refused: dict[str, str] = {}
        self._warnings: list[str] = []
        self._failure = ""
        self._lines: deque[Line] = deque()
        self._worker, self._target = Worker(self._told), Target(self)
        self._description = Description(self, self._describe)
        self._results = self.create_publisher(String, "~/result", LATCHED)
        self.create_service(Trigger, "~/identify", self._identify)
        self.create_timer(LOOK, self._look, clock=self.steady_clock)

    # --- recordings -----------------------------------------------------------------------------------------------

    def _look(self) -> None:
        """Look for recordings; with `auto`, start when they have not changed for `quiet` s."""
        named = [Path(name).expanduser() for name in self.parameters["bags"] if name]
        folder = self.parameters["folder"]
        ready, waiting = self._arrivals.look(named, Path(folder).expanduser() if folder else None)
        if ready != self._ready:
            self._changed = time.monotonic()
        self._ready, self._waiting = ready, waiting
        calm = time.monotonic() - self._changed >= self.parameters["quiet"]
        fresh = any(self._used.get(path) != mark for path, mark in ready.items())
        if self.parameters["auto"] and calm and fresh and not self._worker.busy:
            self._begin()

    def _begin(self) -> None:
        self._used, self._progress, self._stage = dict(self._ready), 0, "starting"
        self._refused, self._warnings, self._failure = {}, [], ""
        self.get_logger().info(f"identifying {self.start_model.name} from {len(self._used)} recordings")
        self._worker.start(
            {
                "machine": self.start_model.as_dict(), "name": self.start_model.name,
                "files": [str(path) for path in self._files], "bags": [str(path) for path in self._used],
                "axis": self.parameters["axis"] or self._rig.namespace or self._axis,
                "joint_name": self.parameters["joint_name"] or self._rig.joint, "words": list(self._words),
                "whole_model": self.parameters["whole_model"],
            }
        )  # fmt: skip

    def _identify(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Start now; the result comes on ~/result."""
        response.success = False
        waiting = "; ".join(f"{path.name} {why}" for path, why in self._waiting.items())
        if self._worker.busy:
            response.message = f"already at work: {self._stage}, {self._progress} %"
        elif not self._ready:
            response.message = f"no recording is ready{': ' + waiting if waiting else '; set bags or folder'}"
        else:
            self._begin()
            more = f"; left out: {waiting}" if waiting else ""
            response.success, response.message = True, f"identifying from {len(self._used)} recordings{more}"
        return response

    # --- reports of the work, which arrive in a thread of their own; the executor handles them ----------------------

    def _told(self, line: Line) -> None:
        self._lines.append(line)
        self.executor.create_task(self._hear)

    def _hear(self) -> None:
        while self._lines:
            self._handle(self._lines.popleft())

    def _handle(self, line: Line) -> None:
        if "progress" in line:
            self._advance(int(line["progress"]), line["text"])
        elif "refused" in line:
            self._refused[line["refused"]] = line["reason"]
            self.get_logger().warning(f"refused: {line['reason']}")
        elif "warning" in line:
            self._warnings.append(line["warning"])
            self.get_logger().warning(line["warning"])
        elif "failed" in line:
            self._fail_softly(line["failed"])
        elif "result" in line:
            self._finish_work(dict(line["result"]))

    def _advance(self, percent: int, text: str) -> None:
        if percent // 10 > self._progress // 10:
            self.get_logger().info(f"{10 * (percent // 10)} %: {text}")
        self._progress, self._stage = percent, text

    def _fail_softly(self, reason: str) -> None:
        """The work failed; the node goes on, because better recordings may come."""
        self._failure, self._stage = reason, "idle"
        self.get_logger().error(reason)

    def _finish_work(self, result: dict[str, Any]) -> None:
        self._done += 1
        self._progress, self._stage = 100, "idle"
        self.model = model_from_dict(result["machine"], self.start_model.name, Library(self._files))
        try:
            path = result_file.store(self.model, result, Path(self.parameters["output"]).expanduser())
        except (PneumoError, OSError) as error:
            self._fail_softly(f"the machine file cannot be written: {error}")
        else:
            self._last = result["machine_file"] = str(path)
        self.get_logger().info(result_file.sentence(result))
        self._description.publish()
        self._publish({**result_file.message(result), "applied": None})
        if self.parameters["apply"]:
            self._apply(result)

    def _publish(self, content: dict[str, Any]) -> None:
        self._results.publish(String(data=json.dumps(content)))

    # --- applying -------------------------------------------------------------------------------------------------

    def _apply(self, result: dict[str, Any]) -> None:
        """Set what was determined on the target, and report whether it was accepted."""
        values, name = result_file.determined(result), self.parameters["target"]

        def done(successful: bool, reason: str) -> None:
            self._applied = f"set on {name}" if successful else f"refused by {name}: {reason}"
            tell = self.get_logger().info if successful else self.get_logger().error
            tell(f"{len(values)} parameters {self._applied}")
            applied = {"target": name, "successful": successful, "reason": reason, "parameters": values}
            self._publish({**result_file.message(result), "applied": applied})

        self._target.set(name, values, done)

    # --- what it says ---------------------------------------------------------------------------------------------

    def health(self) -> Health:
        """Progress, counts, and everything that was refused."""
        values: dict[str, object] = {"stage": self._stage, "progress_percent": self._progress}
        values |= {"recordings_ready": len(self._ready), "recordings_waiting": len(self._waiting)}
        values |= {"identifications": self._done, "machine_file": self._last, "applied": self._applied}
        values |= {f"waiting {path}": why for path, why in self._waiting.items()}
        warnings = [f"refused: {reason}" for reason in self._refused.values()] + self._warnings
        if self._applied.startswith("refused"):
            warnings.append(self._applied)
        return Health(values, warnings, [self._failure] if self._failure else [])

    def finish(self) -> None:
        """Stop the running work."""
        self._worker.stop()

    def _describe(self) -> dict[str, object]:
        return {**describe(self.model.as_dict(), 0), "seed": None}
