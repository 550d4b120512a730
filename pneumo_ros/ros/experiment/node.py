"""The experiment: conducts a programme on a live plant, and closes the valve whatever happens."""

import json
import threading
import time
from collections.abc import Iterable
from pathlib import Path

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pneumo_ros.axis.experiment.events import Events
from pneumo_ros.axis.experiment.preparing import prepare
from pneumo_ros.axis.experiment.settings import SETTINGS
from pneumo_ros.axis.health import Health
from pneumo_ros.axis.priority import PRIORITY, take_priority
from pneumo_ros.axis.rig import live_rig
from pneumo_ros.axis.roles import CONTROLLER
from pneumo_ros.errors import DataError, PneumoError, UsageError
from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.programme_file import programme_text
from pneumo_ros.experiment.summary import recorded, summary
from pneumo_ros.experiment.trial_result import AbortedError
from pneumo_ros.files import write_whole
from pneumo_ros.records.contract import COMMAND, JOINT_STATES
from pneumo_ros.ros import messages, readers
from pneumo_ros.ros.experiment.plant import Plant
from pneumo_ros.ros.experiment.takes import Takes
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.qos import ACKNOWLEDGED, PUBLISH, SUBSCRIBE
from pneumo_ros.ros.rivals import Rivals
from pneumo_ros.ros.simulated import SimulatedRig

CHECK = 0.1  # s between two checks of the plant, at most
SIMULATED = 1_000_000_000  # ns between stamps and wall time: more means another clock


class InterruptedExperimentError(PneumoError):
    """The experiment was ended from outside."""

    exit_code = 130


class Experiment(AxisNode):
    """Answers every joint state with a voltage until all trials are done or a fault occurs; then closes the valve."""

    def __init__(self, effects_files: Iterable[str | Path] = ()) -> None:
        """Raises UsageError for a bad parameter or programme, DataError for a programme that cannot be read."""
        super().__init__("experiment", SETTINGS)
        self.rivals = Rivals(self, CONTROLLER)
        values = self.parameters
        values.refuse_unknown()
        given = {**values.values(), "model_given": "model" in values.begun_with}
        self.programme, self.folder = prepare(given, tuple(effects_files))
        self._rig = live_rig(values.values(), self.programme.closed, self.programme.says_closed)
        self._events = Events(self.get_logger().info, values["events"], self._abandoned)
        self._conductor = Conductor(self.programme, self._events.report)
        self._reader, self._lock = readers.JointReader(values["joint_name"]), threading.Lock()
        self._begun = self._over = False
        self._origin = self._stamp = 0
        self._started = self._heard = time.monotonic()
        self.rivals.settle()
        self._publisher, self._message = self.create_publisher(Float64, COMMAND, PUBLISH), messages.number()
        self._takes = Takes(self, self.folder, self._give_up)
        self._plant = Plant(self, self._takes.heard, self._publisher)
        self._simulated = None if self._rig.declared else SimulatedRig(self)
        self.create_subscription(JointState, JOINT_STATES, self._joint_states, SUBSCRIBE, raw=True)
        self.create_timer(min(CHECK, 0.25 * values["measurement_timeout"]), self._check, clock=self.steady_clock)

    # --- measurement in, voltage out ----------------------------------------------------------------------------------

    def _joint_states(self, data: bytes) -> None:
        sample = self._reader.read(data)
        if sample is None:
            self._plant.other_joints = self._reader.names(data)
            return
        stamp = sample.stamp or time.time_ns()
        if stamp <= self._stamp:  # late or repeated; after a clock was set back, all are
            return
        self._stamp, self._heard = stamp, time.monotonic()
        volts, failure = 0.0, None  # counted from the closed signal
        if self._begun and not self._over:
            try:
                volts = self._conduct(stamp, sample.position)
            except AbortedError as error:
                failure = error
        self._send(volts)
        if failure is not None:
            self._give_up(failure)
        elif self._conductor.done and not self._over:
            self._over = True
            self.end()

    def _conduct(self, stamp: int, position: float) -> float:
        conductor = self._conductor
        before, outcomes = conductor.recording, len(conductor.outcomes)
        volts = conductor.step((stamp - self._origin) * 1e-9, self._rig.wiring.position(position))
        if conductor.recording and not before:
            self._takes.begin(conductor.recording, stamp)
            self._events.report(f"{self._where}: {conductor.recording}", "trial", index=conductor.index)
        elif before and not conductor.recording:
            self._takes.end(stamp)
        for outcome in conductor.outcomes[outcomes:]:
            self._events.report(outcome.text, "outcome", **recorded(outcome, self.folder))
        return volts

    def _send(self, volts: float) -> None:
        if self._refusal():
            return
        with self._lock:
            closed = self.programme.closed
            sent = self._rig.safe(closed) if self._over else self._rig.command(closed + volts)
            payload = self._message.fill(0, sent)
            self._publisher.publish(payload)
            self._takes.command(self._stamp, payload)

    def _refusal(self) -> str:
        """Why no command may be sent; empty if one may."""
        simulated = self._simulated.closed if self._simulated is not None and self._simulated.found else None
        return self._rig.refusal(self.programme.closed, simulated, verb=self.parameters["events"])

    @property
    def _where(self) -> str:
        return f"{self._conductor.index + 1} of {len(self.programme.trials)}"

    # --- watching -----------------------------------------------------------------------------------------------------

    def _check(self) -> None:
        """Start when all topics of the plant are there; end when one stops."""
        if self._over:
            return
        if not self._begun:
            self._begin_when_complete()
            return
        timeout = self.parameters["measurement_timeout"]
        silent = self._plant.silent(timeout, self._heard)
        if silent:
            self._give_up(AbortedError(f"no {silent} for {timeout:g} s: the state of the plant is unknown"))
        elif self.rivals.others:
            self._give_up(AbortedError(f"{self.rivals.others} has begun to send {COMMAND}, too"))

    def _begin_when_complete(self) -> None:
        missing = self._plant.missing(self._stamp > 0)
        self.rivals.look()
        if self.rivals.others:
            self._give_up(UsageError(f"{self.rivals.others} sends {self._publisher.topic_name}, too; stop it first"))
        elif not missing and not self._refusal():
            away = abs(self._stamp - time.time_ns()) > SIMULATED
            self._takes.simulated = away and self.count_publishers("/clock") > 0
            if not self._takes.simulated:  # without it, nodes that have it would delay the commands
                take_priority(self.parameters[PRIORITY.name])
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self.folder / "programme.yaml", programme_text(self.programme))
            self._origin, self._begun = self._stamp, True
            self._events.report(f"{len(self.programme.trials)} trials, recorded in {self.folder}", "begin")
        elif time.monotonic() - self._started > self.parameters["wait"]:
            self._give_up(DataError(missing) if missing else UsageError(self._refusal()))

    # --- the end ------------------------------------------------------------------------------------------------------

    def _give_up(self, reason: PneumoError) -> None:
        """The closed signal, and the end of the process; from any thread."""
        with self._lock:
            if self._over:
                return
            self._over = True
            if not self._refusal():
                self._publisher.publish(self._message.fill(0, self._rig.safe(self.programme.closed)))
        self.fail(reason)

    def _abandoned(self) -> None:
        self._give_up(InterruptedExperimentError("the command that started the experiment has ended"))

    def finish(self) -> None:
        """The closed signal is the last command; the recordings are closed, and a summary is written beside them."""
        if not self._over:
            where = f" during trial {self._where}" if self._begun else " before the first trial"
            self._give_up(InterruptedExperimentError(f"interrupted{where}"))
        self._send(0.0)
        self._publisher.wait_for_all_acked(ACKNOWLEDGED)
        self._takes.end(self._stamp)
        try:
            self._takes.close()
        except PneumoError as error:
            self.failure = self.failure or error
        self._report()

    def _report(self) -> None:
        """The summary, beside the recordings if there are any."""
        said, content = summary(self.programme, self._conductor, self.folder, self.failure)
        content["lost_messages"] = lost = self._takes.lost
        said += f"; {lost} messages were lost" if lost else ""
        if self._begun:
            write_whole(self.folder / "experiment.json", json.dumps(content, indent=1) + "\n")
        self._events.report(said, "end", code=getattr(self.failure, "exit_code", 0), **content)

    def health(self) -> Health:
        """Progress in the programme."""
        conductor = self._conductor
        values = {"trials_done": len(conductor.outcomes), "trials": len(self.programme.trials)}
        values |= {"recording": conductor.recording or "", "position_m": conductor.position}
        lost = self._takes.lost
        warnings = [f"{lost} messages lost"] if lost else []
        if not self._begun:
            warnings.append(self._plant.missing(self._stamp > 0) or self._refusal() or "about to begin")
        return Health({**values, "lost_messages": lost}, warnings)
