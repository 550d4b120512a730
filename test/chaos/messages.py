"""Faults in messages: storms, NaN and infinities, wrong names, wrong stamps, oversized messages."""

import math
import struct
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from chaos.field import MARK, Field

STRANGE = (math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, 0.0)
MANY = 100_000  # names or points of an oversized message
STORM = 5000  # messages, at 10 kHz
RAW = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


def joint_state(values: list[float], names: list[str], stamp: int = 0) -> JointState:
    """A joint state that is marked as sent by a fault; stamp in ns, 0 for now."""
    message = JointState(name=names, position=values, velocity=values, effort=values)
    message.header.frame_id = MARK
    seconds, message.header.stamp.nanosec = divmod(stamp or time.time_ns(), 1_000_000_000)
    message.header.stamp.sec = min(max(seconds, -(2**31)), 2**31 - 1)
    return message


def pressure(value: float, stamp: int = 0) -> FluidPressure:
    """A pressure, likewise."""
    message = FluidPressure(fluid_pressure=value)
    message.header = joint_state([], [], stamp).header
    return message


def storm(field: Field) -> None:
    """10 kHz on a topic that a node listens to, for half a second."""
    topic, kind, message = field.random.choice((
        ("valve/command", Float64, Float64(data=field.random.uniform(-2.0, 2.0))),
        ("position/reference", Float64, Float64(data=0.1)),
        ("joint_states", JointState, joint_state([0.1], ["piston"])),
        ("joint_commands", JointState, joint_state([0.1], ["piston"])),
        ("chamber_a/pressure", FluidPressure, pressure(2e5)),
    ))  # fmt: skip
    publisher = field.probe.publisher(kind, topic, RAW)
    begin = time.monotonic()
    for number in range(STORM):
        time.sleep(max(0.0, begin + 1e-4 * number - time.monotonic()))
        publisher.publish(message)


def strange_numbers(field: Field) -> None:
    """NaN, infinities and the largest and smallest doubles, on every input."""
    for value in STRANGE:
        field.probe.publisher(Float64, "valve/command").publish(Float64(data=value))
        field.probe.publisher(Float64, "position/reference").publish(Float64(data=value))
        field.probe.publisher(JointState, "joint_states").publish(joint_state([value], ["piston"]))
        field.probe.publisher(JointState, "joint_commands").publish(joint_state([value], ["piston"]))
        field.probe.publisher(FluidPressure, "chamber_b/pressure").publish(pressure(value))
        field.probe.supply(value)
        field.probe.trajectory([(1.0, value, value)])
    field.probe.supply(7e5)
    field.probe.trigger("controller/resume")


def empty(field: Field) -> None:
    """Messages without their content."""
    field.probe.publisher(JointState, "joint_states").publish(joint_state([], []))
    field.probe.publisher(JointState, "joint_states").publish(joint_state([], ["piston"]))
    field.probe.publisher(JointState, "joint_commands").publish(joint_state([], ["piston"]))
    field.probe.publisher(JointTrajectory, "joint_trajectory").publish(JointTrajectory())
    points = [JointTrajectoryPoint()] * 3
    field.probe.publisher(JointTrajectory, "joint_trajectory").publish(
        JointTrajectory(joint_names=["piston"], points=points)
    )


def oversized(field: Field) -> None:
    """A hundred thousand joints, and as many points."""
    names = [f"joint_{k}" for k in range(MANY)]
    field.probe.publisher(JointState, "joint_states").publish(joint_state([0.1] * MANY, names))
    field.probe.publisher(JointState, "joint_commands").publish(joint_state([0.1] * MANY, names))
    field.probe.trajectory([(0.01 * k, 0.1 * math.sin(0.01 * k)) for k in range(MANY // 50)])
    field.probe.trigger("controller/resume")


def wrong_names(field: Field) -> None:
    """Missing joints, a duplicate name, more names than numbers, and names with arbitrary characters."""
    for names, values in (
        (["pistn"], [0.1]), (["piston", "piston"], [0.1, 0.2]), (["a", "piston"], [0.1]), ([""], [0.1]),
        (["\u202e\n"], [1.0]),
    ):  # fmt: skip
        field.probe.publisher(JointState, "joint_states").publish(joint_state(values, names))
        field.probe.publisher(JointState, "joint_commands").publish(joint_state(values, names))
        field.probe.trajectory([(1.0, 0.1)], names)


def clock_jumps(field: Field) -> None:
    """Measurements stamped an hour ago, in an hour, before 1970, at the end of time; then trajectories likewise."""
    for offset in (-3600, 3600, -(2**33), 2**33, 0):
        stamp = time.time_ns() + offset * 1_000_000_000
        field.probe.publisher(JointState, "joint_states").publish(joint_state([0.1], ["piston"], stamp))
        field.probe.publisher(FluidPressure, "chamber_a/pressure").publish(pressure(2e5, stamp))
        field.probe.trajectory([(1.0, 0.1)], stamp=joint_state([], [], stamp).header.stamp)
    field.probe.trigger("controller/resume")


def broken_bytes(field: Field) -> None:
    """Bytes that are not a message of the topic's type, and some that nearly are."""
    head = b"\0\1\0\0"
    stamped = head + struct.pack("<iII", 1, 1, len(MARK) + 1) + MARK.encode() + b"\0"
    sent = [
        head, head + struct.pack("<d", math.nan), head + field.random.randbytes(8), b"\0\0\0\0" + b"\xff" * 8,
        stamped + b"\xff" * 40, stamped[:20], head + b"\xff" * 60, stamped + field.random.randbytes(64),
    ]  # fmt: skip
    for kind, topic in (
        (Float64, "valve/command"), (Float64, "position/reference"), (FluidPressure, "supply/pressure"),
        (FluidPressure, "chamber_a/pressure"), (JointState, "joint_states"), (JointState, "joint_commands"),
        (JointTrajectory, "joint_trajectory"),
    ):  # fmt: skip
        for data in sent:
            with suppress(RuntimeError):  # the middleware itself refuses a length that overflows
                field.probe.publisher(kind, topic, RAW).publish(data)
    field.probe.supply(7e5)
    field.probe.trigger("controller/resume")


MESSAGES: dict[str, Callable[[Field], Any]] = {
    "storm of 10 kHz": storm,
    "NaN, infinite and extreme numbers": strange_numbers,
    "empty messages": empty,
    "oversized messages": oversized,
    "wrong joint names": wrong_names,
    "clock jumps": clock_jumps,
    "bytes that are no message": broken_bytes,
}
