"""Results of trials."""

from dataclasses import dataclass

from pneumo_ros.errors import PneumoError

ENDS = {
    "time": "time is up",
    "travel": "went far enough",
    "limit": "reached the limit",
    "still": "did not move",
}


class AbortedError(PneumoError):
    """The plant did something forbidden; the valve must be closed."""


@dataclass(frozen=True)
class TrialResult:
    """One trial: why it ended, how long the valve was open [s], the way from its start [m], the final speed [m/s]."""

    name: str
    voltage: str
    ended: str  # a key of ENDS
    seconds: float
    travel: float
    speed: float

    @property
    def text(self) -> str:
        """One readable line."""
        motion = f"{1e3 * self.speed:+.1f} mm/s at the end, {1e3 * self.travel:.0f} mm"
        return f"{self.name}: {self.voltage}, {motion}, {self.seconds:.1f} s: {ENDS[self.ended]}"
