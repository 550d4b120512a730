"""Whether a measured position can be that of the piston, and whether the piston moves where it is pushed. No ROS."""

from dataclasses import dataclass

BEYOND = 0.1  # of the half stroke: a sensor's zero may lie a little beside mid stroke
LEAP, FASTEST = 0.02, 20.0  # m, m/s; a farther step between two measurements is none of a piston


def outside(position: float, stroke: float) -> str:
    """A sentence where `position` [m] lies outside of a `stroke` [m] about 0, or ""."""
    most = 0.5 * stroke * (1.0 + BEYOND)
    if abs(position) <= most:
        return ""
    units = (
        "; is it in mm?" if abs(position) > 20.0 * most else "; 0 is mid stroke: is the zero of the sensor elsewhere?"
    )
    return f"position {position:.4g} m lies outside of the stroke, +-{0.5 * stroke:g} m{units}"


def leapt(before: float, position: float, passed: float) -> str:
    """A sentence where no piston goes from `before` to `position` [m] in the time that `passed` [s], or ""."""
    step = abs(position - before)
    if step <= max(LEAP, FASTEST * passed):
        return ""
    return f"the position leapt by {position - before:+.3g} m in {1e3 * passed:.3g} ms: check the sensor, then ~/resume"


@dataclass
class Stall:
    """Notices a piston that stands still although the valve is opened far: it is blocked, or the air is missing."""

    patience: float = 1.0  # s, for which it must stand
    moved: float = 5e-4  # m; less counts as standing
    error: float = 2e-3  # m from the setpoint; nearer, standing is right
    opening: float = 0.5  # of the largest voltage
    _anchor: float = 0.0
    _since: float | None = None
    seconds: float = 0.0

    def look(self, time: float, position: float, wanted: float, share: float) -> None:
        """Take a measurement at `time` [s]; `share`: of the largest voltage that was sent."""
        pushed = abs(share) >= self.opening and abs(wanted - position) > self.error
        if not pushed or self._since is None or abs(position - self._anchor) > self.moved:
            self._anchor, self._since = position, time if pushed else None
        self.seconds = 0.0 if self._since is None else time - self._since

    @property
    def warning(self) -> str:
        """A sentence while it stalls, or ""."""
        if self.seconds < self.patience:
            return ""
        return (
            f"stalled: it has not moved for {self.seconds:.0f} s although the valve is open; it is blocked, the air is "
            "missing, or load and friction exceed the force"
        )
