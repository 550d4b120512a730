"""A programme: the trials of an experiment in their order, and their common settings."""

import math
import re
from dataclasses import dataclass, replace

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.experiment.voltages import Constant, Ramps, Voltage

MAX_VOLTAGE = 10.0  # V, what valve amplifiers of this kind take


@dataclass(frozen=True)
class Trial:
    """One recorded run. A constant voltage moves the piston one way within limits; others last `seconds`."""

    name: str  # of its recording
    voltage: Voltage
    seconds: float  # longest motion [s]
    patience: float = 0.0  # longest wait for motion [s], of a constant voltage
    travel: float = math.inf  # longest travel [m], likewise
    anywhere: bool = False  # begins where the piston is, for pistons that cannot move

    def __post_init__(self) -> None:
        if not re.fullmatch(r"\w[\w.-]*", self.name):
            raise UsageError(f"trial {brief(self.name)}: its recording needs a plain file name, such as constant_p1100")
        if not (math.isfinite(self.seconds) and self.seconds > 0.0):
            raise UsageError(f"trial {brief(self.name)} lasts {self.seconds:g} s; it takes a time above 0")
        if not (math.isfinite(self.patience) and self.patience >= 0.0 and self.travel > 0.0):
            raise UsageError(f"trial {brief(self.name)}: patience takes 0 s or more, travel more than 0 m")

    @property
    def direction(self) -> int:
        """Which way a constant voltage moves the piston, 1 or -1; 0 for voltages of both signs."""
        return int(math.copysign(1, self.voltage.volts)) if isinstance(self.voltage, Constant) else 0


@dataclass(frozen=True)
class Programme:
    """Trials, and their limits. Positions in m from mid stroke, voltages in V, times in s."""

    experiment: str
    machine: str  # that it was made for
    low: float  # a trial ends, or turns, at these positions
    high: float
    end: float  # distance from mid stroke that counts as the end stop: reaching it ends the programme
    return_right: float  # voltage, positive, that takes the piston back to the right, and to the left
    return_left: float
    trials: tuple[Trial, ...]
    rest: float = 0.6  # at closed valve before each trial, recorded
    prepare: str = ""  # preparation by hand
    closed: float = 0.0  # signal [V] at which the valve is closed; voltages of trials are counted from it
    says_closed: bool = False  # whether a file or machine says so, else 0 V is an assumption
    blind: bool = False  # unit, zero and sign of the position are unknown: only how far it moves counts

    def __post_init__(self) -> None:
        if not -self.end < self.low < self.high < self.end < math.inf:
            raise UsageError(
                f"limits are low {self.low:g} m, high {self.high:g} m, end {self.end:g} m; "
                "they must satisfy -end < low < high < end"
            )
        if not (math.isfinite(self.rest) and self.rest >= 0.2):
            raise UsageError(f"rest is {self.rest:g} s; it takes at least 0.2 s, so that a breakaway is recognised")
        if not self.trials:
            raise UsageError("the programme holds no trial")
        if self.blind and not all(isinstance(trial.voltage, Ramps) for trial in self.trials):
            raise UsageError("a blind programme takes trials of ramps only: other trials need to know where they are")
        self._check_names()
        self._check_voltages()

    def _check_names(self) -> None:
        names = [trial.name for trial in self.trials]
        if repeated := sorted({name for name in names if names.count(name) > 1}):
            raise UsageError(f"trial {repeated[0]} is listed twice; every recording needs a name of its own")

    def _check_voltages(self) -> None:
        given = {trial.name: trial.voltage.largest for trial in self.trials}
        for name, volts in {**given, "return_right": self.return_right, "return_left": self.return_left}.items():
            if not 0.0 < volts <= MAX_VOLTAGE - abs(self.closed):
                most = MAX_VOLTAGE - abs(self.closed)
                beside = f" beside the closed signal of {self.closed:g} V" if self.closed else ""
                raise UsageError(f"{name} is {volts:g} V; allowed is more than 0 to {most:g} V{beside}")

    @property
    def span(self) -> float:
        """Room between the limits [m]."""
        return self.high - self.low


def within(programme: Programme, limits: tuple[float, float]) -> Programme:
    """The programme inside `limits` [m] of a rig, too; UsageError where that leaves no room."""
    if programme.blind:
        return programme
    low, high = max(programme.low, limits[0]), min(programme.high, limits[1])
    if low >= high:
        raise UsageError(
            f"the rig is limited to {limits[0]:g} to {limits[1]:g} m, and {programme.experiment} needs "
            f"{programme.low:g} to {programme.high:g} m: no room is left"
        )
    return replace(programme, low=low, high=high)
