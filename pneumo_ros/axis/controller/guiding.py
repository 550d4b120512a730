"""Parameters of the guide of the piston, and how they are set on it."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.axis.controller.guide import Guide
from pneumo_ros.axis.setting import Setting
from pneumo_ros.control.motion import Limits

SETTINGS = (
    Setting("limits.low", -100.0, "least position; the stroke of the machine limits it, too", "m", -100.0, 100.0),
    Setting("limits.high", 100.0, "largest position; the stroke of the machine limits it, too", "m", -100.0, 100.0),
    Setting("profile.speed", 0.12, "on the way to a position; at most what the machine can do", "m/s", 1e-4, 10.0),
    Setting("profile.acceleration", 1.0, "on the way to a position", "m/s2", 1e-3, 1000.0),
    Setting("profile.jerk", 20.0, "on the way to a position", "m/s3", 1e-2, 1e6),
    Setting("following_error", 0.05, "distance to the piston that ends a trajectory or a profile", "m", 1e-3, 100.0),
    Setting("goal_tolerance", 0.003, "distance from its goal at which a trajectory has succeeded", "m", 1e-5, 1.0),
    Setting("reference_timeout", 0.2, "age of a moving reference at which its last position is held", "s", 0.001, 60.0),
    Setting("trajectory.slow_down", False, "slow down trajectories beyond the limits; false: refuse them"),
    Setting("minimum_supply", 2e5, "supply/pressure below which 0 V is sent; 0: never", "Pa", 0.0, 1e8),
    Setting("vent_unseen", False, "vent even if no supply/pressure shows that the supply is shut off"),
)


def limits_of(values: Mapping[str, Any]) -> Limits:
    """The limits of positions and profiles; UsageError if they leave no room."""
    profile = (values[f"profile.{name}"] for name in ("speed", "acceleration", "jerk"))
    return Limits(values["limits.low"], values["limits.high"], *profile)


def set_guide(guide: Guide, values: Mapping[str, Any], time: float) -> None:
    """Give a guide its parameters, at time [s] of the loop."""
    guide.limits, guide.slow_down = limits_of(values), values["trajectory.slow_down"]
    guide.supply.least, guide.vent_unseen = values["minimum_supply"], values["vent_unseen"]
    guide.motion.following_error, guide.motion.pause = values["following_error"], values["reference_timeout"]
    guide.fit(time)
