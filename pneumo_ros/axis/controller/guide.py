"""Requests to the piston, and how they are carried out: following, holding, stopped or venting. No ROS in here."""

import math
from collections.abc import Mapping, Sequence
from enum import Enum

from pneumo_ros.axis.controller.supply import Supply
from pneumo_ros.control import Law, Reference, Setpoint
from pneumo_ros.control.motion import Capability, Limits, Motion, Trajectory, Vent, Waypoint, ahead, require, slowed
from pneumo_ros.errors import UsageError

SETTLING = 0.1  # s at rest, before the valve is closed at the end of a stop
NEAR = 0.01  # m; a smooth reference nearer to the piston than this is followed without a profile


class Mode(Enum):
    """What the piston does."""

    FOLLOWING = "following"
    HOLDING = "holding"
    STOPPING = "stopping"
    STOPPED = "stopped"
    VENTING = "venting"


class Guide:
    """Takes references while it is following; `stop`, `hold` and `vent` end that until `resume`.

    Times [s] are the control loop's. A refused request raises UsageError and changes nothing.
    """

    def __init__(self, law: Law) -> None:
        """`law` knows the machine and the valve."""
        self.law, self.mode = law, Mode.FOLLOWING
        self.limits, self.motion = Limits(), Motion(Limits())
        self.slow_down = self.vent_unseen = False
        self.supply = Supply()
        self.built_in: tuple[Reference, bool] | None = None  # a reference from parameters, and whether it jumps
        self.position: float | None = None
        self._time = 0.0  # of the last measurement
        self._early: tuple[float, float | None] | None = None  # requested before the first measurement
        self._vent: Vent | None = None
        self._closing = math.inf  # when the valve is closed, at the end of a stop

    @property
    def capability(self) -> Capability:
        """What the machine can do at the present supply pressure."""
        return Capability(self.law.machine, self.law.valve, self.supply.pressure)

    # --- every measurement ------------------------------------------------------------------------------------------

    def wanted(self, time: float, position: float) -> Setpoint | None:
        """The setpoint, None if there is nothing to follow."""
        self.position, self._time = position, time
        if self.mode is Mode.STOPPING and time >= self._closing:
            self.close()
        if self._early is not None:
            early, self._early = self._early, None
            self.motion.aim(*early, time, position)
        if self.built_in is not None and self.mode is Mode.FOLLOWING and not self.supply.lost:
            self._follow_built_in(time, position)
        return self.motion.at(time, position)

    def forced(self, time: float, pressures: Mapping[str, float | None]) -> float | None:
        """The voltage that replaces the law's; None: the law decides."""
        if self._vent is not None:
            return self._vent.voltage(time, pressures)
        return 0.0 if self.mode is Mode.STOPPED or self.supply.lost else None

    def restart(self, time: float, position: float) -> None:
        """Restart from where the piston is, after a pause of the measurements or a step of the clock."""
        self.motion.restart(time, position, "measurements were missing")

    def supplied(self, pressure: float, time: float) -> None:
        """Take the supply pressure [Pa abs]; when it returns, the piston holds its present position."""
        before, changed = self.supply.lost, self.supply.take(pressure, time)
        if self._vent is not None and not self.supply.shut_off(self.law.machine.atmospheric_pressure):
            self.close()  # otherwise the open valve would drive the piston
        if self.position is not None and before and not self.supply.lost and self.motion.asked:
            self._settle(time, "the supply pressure was lost")
        if changed:
            self.fit(time)

    def fit(self, time: float) -> None:
        """Fit the limits to what the machine can do; call it when either has changed."""
        self.motion.change_limits(self.capability.fit(self.limits.on_stroke(self.law.machine.stroke)), time)

    # --- requests ---------------------------------------------------------------------------------------------------

    def aim(self, position: float, velocity: float | None, time: float) -> None:
        """Go to a position [m] that moves at `velocity` [m/s]; None: estimated from successive requests."""
        self._require_following()
        self.motion.limits.require(position)
        if velocity is not None and not math.isfinite(velocity):
            velocity = None
        if self.position is None:
            self._early = (position, velocity)
        else:
            self.motion.aim(position, velocity, time, self.position)

    def follow(self, waypoints: Sequence[Waypoint], delay: float, time: float) -> tuple[Trajectory, float]:
        """Follow waypoints that start `delay` [s] from now (may be negative); the trajectory and its slowing factor."""
        self._require_following()
        if self.built_in is not None:
            raise UsageError("the controller follows its own reference; set reference.shape to topic first")
        if self.position is None:
            raise UsageError("there is no measurement yet")
        begin, points = time + max(delay, 0.0), ahead(waypoints, max(-delay, 0.0))
        start, factor = self.motion.start_of(begin, self.position), 1.0
        if self.slow_down:
            trajectory, factor = slowed(start, begin, points, self.motion.limits, self.capability)
        else:
            trajectory = Trajectory(start, begin, points)
            require(trajectory, self.motion.limits, self.capability)
        self.motion.follow(trajectory, self.position)
        return trajectory, factor

    def hold(self, time: float, reason: str = "hold was called") -> None:
        """Brake within the limits and stay there, under control."""
        self._require_position()
        assert self.position is not None
        if self.mode in (Mode.STOPPED, Mode.VENTING):
            self._settle(time, reason)
        elif self.mode is not Mode.STOPPING:
            self.motion.brake(time, self.position, reason)
        self.mode, self._vent = Mode.HOLDING, None

    def halt(self, time: float) -> None:
        """Brake within the limits, and go on taking references."""
        self._require_following()
        if self.position is not None and self.motion.asked:
            self.motion.brake(time, self.position, "halt was requested")

    def stop(self, time: float) -> float:
        """Brake within the limits, then close the valve; a trajectory is given up. Returns the stopping distance [m].

        The valve is closed at once where nothing moves under control. A second stop changes nothing.
        """
        if self.mode is Mode.STOPPING and self.position is not None and self.motion.target is not None:
            return abs(self.motion.target - self.position)
        if self.mode in (Mode.STOPPED, Mode.VENTING) or self.supply.lost or not self.motion.asked:
            self.close()
            return 0.0
        assert self.position is not None
        self._early = None
        end = self.motion.brake(time, self.position, "stop was called")
        self.mode, self._closing = Mode.STOPPING, end + SETTLING
        assert self.motion.target is not None
        return abs(self.motion.target - self.position)  # with the lag of the piston behind its setpoint

    def close(self, reason: str = "the valve was closed") -> None:
        """Close the valve at once: the piston coasts. A trajectory is given up."""
        self.mode, self._vent, self._early = Mode.STOPPED, None, None
        self._give_up(reason)

    def vent(self, time: float) -> None:
        """Empty both chambers. The supply must be shut off: otherwise it would drive the piston."""
        atmosphere = self.law.machine.atmospheric_pressure
        self.supply.require_shut_off(atmosphere, self.vent_unseen)
        self.mode, self._vent = Mode.VENTING, Vent(time, atmosphere, self.law.valve.max_voltage)
        self._give_up("the chambers are vented")

    def resume(self, time: float) -> None:
        """Take references again, from where the piston is."""
        if self.mode in (Mode.STOPPED, Mode.VENTING) and self.position is not None and self.motion.asked:
            self._settle(time, "")
        self.mode, self._vent = Mode.FOLLOWING, None

    def _give_up(self, reason: str) -> None:
        if self.position is not None and self.motion.asked:
            self.motion.rest(self._time, self.position, reason)

    def _settle(self, time: float, reason: str) -> None:
        """Hold the present position, after the valve was closed or the chambers were vented."""
        assert self.position is not None
        self.law.reset()
        self.motion.rest(time, self.position, reason)

    # --- how --------------------------------------------------------------------------------------------------------

    def _follow_built_in(self, time: float, position: float) -> None:
        assert self.built_in is not None
        reference, jumps = self.built_in
        if self.motion.reference is reference:
            return
        wanted = reference(time)
        away = wanted.position - self.motion.start_of(time, position).position
        if jumps or abs(away) > NEAR:
            self.motion.aim(wanted.position, 0.0 if jumps else wanted.velocity, time, position)
        else:
            self.motion.follow_freely(reference)

    def _require_following(self) -> None:
        if self.mode is not Mode.FOLLOWING:
            raise UsageError(f"the controller is {self.mode.value}; call ~/resume first")

    def _require_position(self) -> None:
        if self.position is None:
            raise UsageError("there is no measurement yet, so no position to hold")
