"""The wanted motion: one setpoint for every instant, from the targets, streams and trajectories that come in."""

from enum import Enum

from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.motion.profile import Profile, braking
from pneumo_ros.control.motion.trajectory import Trajectory
from pneumo_ros.control.setpoint import Reference, Setpoint


class Kind(Enum):
    """The source of the motion."""

    NONE = "no reference"
    TARGET = "target"
    STREAM = "stream"
    TRAJECTORY = "trajectory"
    FREE = "reference"


class Motion:
    """The wanted position of the piston. No request makes the setpoint jump, and it never runs away from the piston.

    Times [s] rise from call to call; `measured` [m] is the piston's position. A motion that is `following_error` [m]
    away from the piston restarts at the piston, a trajectory is given up; `reason` then says why. A stream ends at its
    last position when nothing came for `pause` [s].
    """

    def __init__(self, limits: Limits, following_error: float = 0.05, pause: float = 0.2) -> None:
        self.limits, self.following_error, self.pause = limits, following_error, pause
        self.kind, self.reason = Kind.NONE, ""
        self.reference: Reference = _nothing
        self.target: float | None = None  # end of the motion, or the last request [m]
        self.trajectory: Trajectory | None = None
        self._asked, self._drift = 0.0, 0.0

    def at(self, time: float, measured: float) -> Setpoint | None:
        """The setpoint at `time`; None before anything was asked for."""
        if self.kind is Kind.NONE:
            return None
        if self._drift and time - self._asked > self.pause:
            self.reason = f"nothing came for {self.pause:g} s; the last position is held"
            self._go(self._within(self.reference(time)), time)
        wanted = self._within(self.reference(time))
        if self.kind is not Kind.FREE and abs(wanted.position - measured) > self.following_error:
            self.restart(time, measured, f"the piston is {measured - wanted.position:+.3g} m off")
            wanted = self.reference(time)
        return wanted

    @property
    def asked(self) -> bool:
        """Whether anything was asked for yet."""
        return self.kind is not Kind.NONE

    # --- what comes in ----------------------------------------------------------------------------------------------

    def aim(self, position: float, velocity: float | None, time: float, measured: float) -> None:
        """Go to `position` [m], which itself moves at `velocity` [m/s]; None: computed from the earlier request.

        Raises UsageError, and continues as before, for a position that is not finite or outside the limits.
        """
        self.limits.require(position)
        drift = self._rate(position, time) if velocity is None else velocity
        again = self.kind in (Kind.TARGET, Kind.STREAM) and (position, drift) == (self.target, self._drift)
        passed = time - self._asked
        now = self.start_of(time, measured)
        self.target, self._asked = position, time
        if again and not drift:
            return
        if velocity is not None and self._smooth(now, position, velocity, passed):
            self.kind, self._drift, self.reference = Kind.STREAM, velocity, _ramp(position, velocity, time)
        else:
            self._go(now, time, drift)

    def start_of(self, begin: float, measured: float) -> Setpoint:
        """The setpoint from which a trajectory has to begin at time `begin`."""
        return Setpoint(measured) if self.kind is Kind.NONE else self._within(self.reference(begin))

    def follow(self, trajectory: Trajectory, measured: float) -> None:
        """Follow a trajectory from `start_of` its begin; until then the earlier reference goes on."""
        before = (lambda time: Setpoint(measured)) if self.kind is Kind.NONE else self.reference
        self.reference = lambda time: trajectory(time) if time >= trajectory.begin else before(time)
        self.kind, self.target, self._drift, self.reason = Kind.TRAJECTORY, trajectory.goal, 0.0, ""
        self.trajectory = trajectory

    def follow_freely(self, reference: Reference) -> None:
        """Follow any function of time, as it is."""
        self.kind, self.reference, self.target, self._drift = Kind.FREE, reference, None, 0.0

    def brake(self, time: float, measured: float, reason: str = "") -> float:
        """Come to rest within the limits, and stay there; returns when it will be at rest [s]."""
        profile = braking(self.start_of(time, measured), time, self.limits)
        self.kind, self.reference, self.target, self._drift = Kind.TARGET, profile, profile.target, 0.0
        self.reason = reason
        return profile.end

    def rest(self, time: float, measured: float, reason: str = "") -> None:
        """Stay where the piston is."""
        self.kind, self.target, self.reason = Kind.TARGET, measured, reason
        self._go(Setpoint(measured), time)

    def restart(self, time: float, measured: float, reason: str) -> None:
        """Restart from where the piston is: to the same target; a trajectory and a free reference end."""
        if self.kind in (Kind.TRAJECTORY, Kind.FREE):
            self.rest(time, measured, reason)
        elif self.kind in (Kind.TARGET, Kind.STREAM):
            self.reason = reason
            self._go(Setpoint(measured), time)

    def change_limits(self, limits: Limits, time: float) -> None:
        """Continue within other limits; a target outside of them becomes the nearest one inside."""
        self.limits = limits
        if self.kind in (Kind.TARGET, Kind.STREAM) and self.target is not None:
            self.target = limits.clip(self.target)
            self._go(self.reference(time), time)

    def follows(self, trajectory: Trajectory) -> bool:
        """Whether `trajectory` is being followed: nothing else has replaced it."""
        return self.kind is Kind.TRAJECTORY and self.trajectory is trajectory

    # --- how --------------------------------------------------------------------------------------------------------

    def _go(self, now: Setpoint, time: float, drift: float = 0.0) -> None:
        assert self.target is not None
        self.kind, self._drift = Kind.STREAM if drift else Kind.TARGET, drift
        self.reference = Profile(now, time, self.target, self.limits, drift)

    def _rate(self, position: float, time: float) -> float:
        """Velocity [m/s] of a stream of positions, 0 for a single position or a jump."""
        passed = time - self._asked
        if self.target is None or not 0.0 < passed <= self.pause or self.kind is Kind.TRAJECTORY:
            return 0.0
        rate = (position - self.target) / passed
        return rate if abs(rate) <= self.limits.speed else 0.0

    def _smooth(self, now: Setpoint, position: float, velocity: float, passed: float) -> bool:
        """Whether a stream continues from the setpoint, within the acceleration possible between two messages."""
        most = 2.0 * self.limits.acceleration * passed
        return (
            0.0 < passed <= self.pause
            and abs(velocity - now.velocity) <= most
            and abs(position - now.position) <= most * passed
        )

    def _within(self, wanted: Setpoint) -> Setpoint:
        """An extrapolated stream also stays within the limits."""
        inside = self.limits.clip(wanted.position)
        return wanted if self.kind is not Kind.STREAM or inside == wanted.position else Setpoint(inside)


def _nothing(time: float) -> Setpoint:
    raise RuntimeError("asked for a setpoint before there was one")


def _ramp(position: float, velocity: float, begin: float) -> Reference:
    return lambda time: Setpoint(position + velocity * (time - begin), velocity)
