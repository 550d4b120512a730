"""The wanted velocity that brings a piston that sticks at low speed to its target."""

import math
from typing import NamedTuple

from pneumo_ros.control.setpoint import Setpoint

PASSED = 0.6  # share of a detour after which the piston turns back
ENDING = 0.3  # a deceleration that leaves less than this share of the speed ends the motion


class Wanted(NamedTuple):
    """Wanted velocity [m/s] and its derivative [m/s2]."""

    velocity: float
    acceleration: float


class Approach:
    """Wanted velocity from setpoint and position error e: v_r = v_d + lambda e / sqrt(1 + |e| / e_1).

    Large errors are approached with the deceleration b = lambda^2 e_1 / 2, as v = sqrt(2 b |e|) does (the velocity part
    is that of Guenther et al. 2006; the root, of the proximate time-optimal servo of G. F. Franklin, J. D. Powell and
    M. Workman, Digital Control of Dynamic Systems, 1998).

    Below the speed at which the Stribeck curve falls faster than drag rises, a piston cannot slide steadily: it stops.
    When it breaks away again it slips some millimetres, because the force falls by F_s - F_c and the air springs are
    soft. Hence two rules of our own for the end of a motion. The piston approaches it no slower than `slowest`, until
    only the stopping distance is left. A piston that has stopped at a wrong place nearer than `detour` first moves past
    the target by `detour`, so that it slides steadily, and then comes back.
    """

    def __init__(self) -> None:
        """Start without a detour."""
        self.reset()

    def reset(self) -> None:
        """Forget the detour."""
        self.detour = 0.0

    def wanted(
        self,
        setpoint: Setpoint,
        error: float,
        velocity: float,
        rate: float,
        braking: float,
        slowest: float,
        stop: float,
    ) -> Wanted:
        """For `error` [m] at `velocity` [m/s]: lambda = `rate` [1/s], b = `braking` [m/s2], slowest [m/s], stop [m]."""
        e = error + self.detour
        bend = 1.0 + 0.5 * abs(e) * rate * rate / braking
        root = math.sqrt(bend)
        v = setpoint.velocity + rate * e / root
        slope = 0.5 * rate * (bend + 1.0) / (bend * root)
        left = remaining(setpoint)
        if left is not None and abs(v) < slowest and abs(e + left) > stop:
            return Wanted(math.copysign(slowest, e + left), 0.0)
        return Wanted(v, setpoint.acceleration + slope * (setpoint.velocity - velocity))

    def watch(self, setpoint: Setpoint, error: float, stuck: bool, tolerance: float, detour: float) -> None:
        """Start or end a detour of `detour` [m]; one starts if the piston is `stuck` beyond `tolerance` [m]."""
        if setpoint.velocity != 0.0 or (self.detour * error < 0.0 and abs(error) > PASSED * detour):
            self.detour = 0.0
        elif self.detour == 0.0 and stuck and tolerance < abs(error) < PASSED * detour:
            self.detour = math.copysign(detour, error)


def remaining(setpoint: Setpoint) -> float | None:
    """Distance [m] to the place where the setpoint comes to rest, if its present jerk brings it to rest; else None.

    With v = v_d + a_d t + j t^2 / 2 the acceleration ends at T = -a_d / j, at the speed v_d + a_d T / 2 and after
    v_d T + a_d T^2 / 3.
    """
    _, v, a, j = setpoint
    if v == 0.0:
        return 0.0
    if v * a >= 0.0 or v * j <= 0.0:
        return None
    time = -a / j
    return v * time + a * time * time / 3.0 if abs(v + 0.5 * a * time) < ENDING * abs(v) else None
