"""Messages that ask for a motion, as waypoints for the guide."""

from builtin_interfaces.msg import Duration, Time
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pneumo_ros.control.motion import Waypoint
from pneumo_ros.errors import UsageError


def waypoints_of(message: JointTrajectory, joint: str) -> list[Waypoint]:
    """The points of `joint` among those of all joints.

    Raises UsageError where the joint is missing, or arrays are of another length than the list of joints.
    """
    names = list(message.joint_names)
    if names.count(joint) != 1:
        raise UsageError(
            f"the trajectory is for {', '.join(names) or 'no joint'}; this controller moves joint '{joint}' "
            "(parameter joint_name)"
        )
    return [_waypoint(number, point, len(names), names.index(joint)) for number, point in enumerate(message.points, 1)]


def nanoseconds(moment: Time | Duration) -> int:
    """A stamp or duration [ns]."""
    return int(moment.sec * 1_000_000_000 + moment.nanosec)


def _waypoint(number: int, point: JointTrajectoryPoint, joints: int, index: int) -> Waypoint:
    found: list[float | None] = []
    for name in ("positions", "velocities", "accelerations"):
        values = getattr(point, name)
        if len(values) not in ((joints,) if name == "positions" else (0, joints)):
            raise UsageError(f"point {number} of the trajectory has {len(values)} {name} for {joints} joints")
        found.append(float(values[index]) if len(values) else None)
    position, velocity, acceleration = found
    assert position is not None
    return Waypoint(nanoseconds(point.time_from_start) * 1e-9, position, velocity, acceleration)
