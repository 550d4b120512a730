"""Messages as bytes: writing and reading agree with rclpy's serialisation and deserialisation."""

import math

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from records.making import STORE
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.ros import messages, readers
from pneumo_ros.ros.readers import stamp_of

STAMP = 1_795_251_234_567_890_123


def joint_state(names: list[str], position: list[float], velocity: list[float], frame: str = "") -> bytes:
    message = JointState(name=names, position=position, velocity=velocity, effort=[1.0] * len(position))
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(STAMP, 1_000_000_000)
    message.header.frame_id = frame
    return serialize_message(message)


@pytest.mark.parametrize("joint", ["piston", "a", "left/piston_joint", "Zylinder_ä"])
def test_a_joint_state_is_filled_in(joint: str) -> None:
    for stamp in (STAMP, 0, 2_000_000):
        message = deserialize_message(messages.joint_state(joint).fill(stamp, 0.1, -0.2, 300.0), JointState)
        assert (list(message.name), list(message.position)) == ([joint], [0.1])
        assert (list(message.velocity), list(message.effort)) == ([-0.2], [300.0])
        assert message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec == stamp
    message = deserialize_message(messages.joint_state(joint, False).fill(STAMP, 0.1, 300.0), JointState)
    assert (list(message.position), list(message.velocity), list(message.effort)) == ([0.1], [], [300.0])


@pytest.mark.parametrize("velocity", [True, False])
@pytest.mark.parametrize("joint", ["piston", "a", "left/piston_joint"])
def test_a_joint_state_ends_where_other_readers_expect_it(joint: str, velocity: bool) -> None:
    """rosbags refuses a message with bytes left over."""
    numbers = [0.1, -0.2, 300.0] if velocity else [0.1, 300.0]
    data = messages.joint_state(joint, velocity).fill(STAMP, *numbers)
    message = STORE.deserialize_cdr(data, "sensor_msgs/msg/JointState")
    assert message.velocity.tolist() == numbers[1:-1]
    assert message.effort.tolist() == [300.0]


def test_other_messages_are_filled_in() -> None:
    pressure = deserialize_message(messages.pressure("chamber_a").fill(STAMP, 3e5, 9e4), FluidPressure)
    assert (pressure.fluid_pressure, pressure.variance, pressure.header.frame_id) == (3e5, 9e4, "chamber_a")
    assert deserialize_message(messages.number().fill(0, -1.5), Float64).data == -1.5
    clock = deserialize_message(messages.clock().fill(STAMP), Clock).clock
    assert (clock.sec, clock.nanosec) == divmod(STAMP, 1_000_000_000)


@pytest.mark.parametrize("frame", ["", "a", "base", "left/chamber_a"])
def test_numbers_and_pressures_are_read(frame: str) -> None:
    assert readers.number(serialize_message(Float64(data=-7.25))) == -7.25
    message = FluidPressure(fluid_pressure=123456.75, variance=5.0)
    message.header.frame_id = frame
    assert readers.pressure(serialize_message(message)) == 123456.75


@pytest.mark.parametrize("frame", ["", "abc", "world"])
@pytest.mark.parametrize("names", [["piston"], ["boom", "piston"], ["x", "arm_2", "piston", "ä"]])
@pytest.mark.parametrize("velocity", [True, False])
def test_a_joint_is_read_by_name(frame: str, names: list[str], velocity: bool) -> None:
    reader, index = readers.JointReader("piston"), names.index("piston")
    for shift in (0.0, 5.0):  # the second one is read at the places learnt from the first
        position = [k + shift for k in range(len(names))]
        speeds = [-p for p in position] if velocity else []
        sample = reader.read(joint_state(names, position, speeds, frame))
        assert sample == (STAMP, position[index], speeds[index] if velocity else None)


def test_a_changed_layout_is_learnt_again() -> None:
    reader = readers.JointReader("piston")
    layouts = [
        (["piston", "boom1"], [1.0, 2.0], [3.0, 4.0]),
        (["boom1", "piston"], [1.0, 2.0], [3.0, 4.0]),  # as long as the one before
        (["piston"], [1.0], []),
        (["boom1", "piston"], [1.0, 2.0], [3.0]),  # velocity shorter than position
    ]
    for names, position, velocity in layouts * 2:
        index = names.index("piston")
        sample = reader.read(joint_state(names, position, velocity))
        assert sample is not None
        assert sample.position == position[index]
        assert sample.velocity == (velocity[index] if index < len(velocity) else None)


def test_a_missing_joint_gives_none() -> None:
    reader = readers.JointReader("piston")
    assert reader.read(joint_state(["boom"], [1.0], [])) is None
    assert reader.read(joint_state(["boom", "piston"], [1.0], [])) is None  # no position of its own
    assert reader.names(joint_state(["boom", "arm"], [1.0, 2.0], [])) == ["boom", "arm"]


def test_nan_and_negative_zero_pass() -> None:
    sample = readers.JointReader("piston").read(joint_state(["piston"], [math.nan], [-0.0]))
    assert sample is not None
    assert math.isnan(sample.position)
    assert math.copysign(1.0, sample.velocity or 1.0) == 1.0


HEAD = b"\0\1\0\0"
NO_MESSAGES = [b"", HEAD, HEAD + b"\xff" * 60, b"\0\0\0\0" + b"\xff" * 60, b"\7\7\7\7" + b"\0" * 60, HEAD + b"\0" * 11]


@pytest.mark.parametrize("data", NO_MESSAGES)
def test_bytes_that_are_no_message_are_no_number_and_no_joint(data: bytes) -> None:
    """Anybody may publish them: a node that crashes on them leaves its valve open."""
    assert not math.isfinite(readers.number(data)) or len(data) >= 12
    assert math.isnan(readers.pressure(data))
    reader = readers.JointReader("piston")
    assert reader.read(data) is None
    assert reader.names(data) == []
    assert stamp_of(data, "sensor_msgs/msg/JointState") == 0 or len(data) >= 12
    good = joint_state(["piston"], [0.25], [])
    sample = reader.read(good)
    assert sample is not None
    assert sample.position == 0.25
    assert reader.read(data) is None
    assert reader.read(good) == sample


@pytest.mark.parametrize("length", range(4, 100, 4))
def test_a_joint_state_cut_anywhere_is_none_or_all_there(length: int) -> None:
    reader, good = readers.JointReader("piston"), joint_state(["a", "piston"], [0.5, 0.25], [1.0, 2.0])
    sample = reader.read(good)
    assert reader.read(good[:length]) in (None, sample)
