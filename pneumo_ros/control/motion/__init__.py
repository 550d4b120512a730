"""Wanted motion from requests: profiles to a position, trajectories, streams; and whether it is possible."""

from pneumo_ros.control.motion.capability import Capability
from pneumo_ros.control.motion.feasible import require, slowed
from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.motion.motion import Kind, Motion
from pneumo_ros.control.motion.profile import Profile, braking
from pneumo_ros.control.motion.trajectory import Trajectory
from pneumo_ros.control.motion.vent import Vent
from pneumo_ros.control.motion.waypoint import Waypoint, ahead

__all__ = [
    "Capability",
    "Kind",
    "Limits",
    "Motion",
    "Profile",
    "Trajectory",
    "Vent",
    "Waypoint",
    "ahead",
    "braking",
    "require",
    "slowed",
]
