"""Numbers from received bytes: at 1 kHz, building message objects costs more than all work with their numbers.

CDR as in OMG formal/02-06-51, section 9.3: four bytes of encapsulation, then little-endian numbers, aligned to their
size from there; a string or sequence is its length and its elements. Any other encapsulation goes through rclpy.

Any node may publish anything: bytes that are not a valid message read as NaN, or as no joint.
"""

import math
import struct
from typing import NamedTuple

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.ros.message_classes import message_class

_PLAIN = b"\x00\x01"  # encapsulation of little-endian CDR
_COUNT, _NUMBER, _STAMP = struct.Struct("<I"), struct.Struct("<d"), struct.Struct("<iI")
_START = 12  # after encapsulation and stamp: the length of header.frame_id


class JointSample(NamedTuple):
    """One joint of a joint state: stamp [ns], position [m], velocity [m/s] if there is one."""

    stamp: int
    position: float
    velocity: float | None


def number(data: bytes) -> float:
    """The number of a std_msgs/Float64."""
    try:
        return float(_NUMBER.unpack_from(data, 4)[0] if data[:2] == _PLAIN else deserialize_message(data, Float64).data)
    except Exception:  # from struct or from the middleware
        return math.nan


def pressure(data: bytes) -> float:
    """The pressure [Pa] of a sensor_msgs/FluidPressure."""
    try:
        if data[:2] != _PLAIN:
            return float(deserialize_message(data, FluidPressure).fluid_pressure)
        (length,) = _COUNT.unpack_from(data, _START)
        return float(_NUMBER.unpack_from(data, _aligned(_START + 4 + length, 8))[0])
    except Exception:  # likewise
        return math.nan


def stamp_of(data: bytes, message_type: str) -> int:
    """Header stamp [ns] of a serialised message that begins with a header; 0 for bytes that are no such message."""
    try:
        if data[:2] == _PLAIN:
            seconds, nanoseconds = _STAMP.unpack_from(data, 4)
        else:
            stamp = deserialize_message(data, message_class(message_type)).header.stamp
            seconds, nanoseconds = stamp.sec, stamp.nanosec
    except Exception:  # from struct or from the middleware: any node may publish anything
        return 0
    return int(seconds) * 1_000_000_000 + int(nanoseconds)


class JointReader:
    """Reads one joint, by name, from joint states; a message laid out like the last one is read at the same places."""

    def __init__(self, joint: str, whole: bool = False) -> None:
        """Look for `joint`; with `whole` only where there are as many positions as names.

        ros2_control leaves out values without an interface: then it is unknown which joint a position belongs to.
        """
        self._joint, self._whole = joint, whole
        self._length, self._fixed, self._after = -1, b"", b""
        self._begin = self._end = self._position = self._velocity = 0

    def read(self, data: bytes) -> JointSample | None:
        """The joint's sample of a sensor_msgs/JointState; None if it holds no position of that joint."""
        try:
            return self._read(data)
        except Exception:  # not a JointState: from struct or from the middleware
            self._length = -1  # forget the learnt layout
            return None

    def _read(self, data: bytes) -> JointSample | None:
        if data[:2] != _PLAIN:
            return self._of_message(deserialize_message(data, JointState))
        if not self._as_before(data) and not self._learn(data):
            return None
        seconds, nanoseconds = _STAMP.unpack_from(data, 4)
        (position,) = _NUMBER.unpack_from(data, self._position)
        velocity = _NUMBER.unpack_from(data, self._velocity)[0] if self._velocity else None
        return JointSample(seconds * 1_000_000_000 + nanoseconds, position, velocity)

    def names(self, data: bytes) -> list[str]:
        """Names of all joints of a message; none for other bytes."""
        try:
            return list(deserialize_message(data, JointState).name)
        except Exception:  # likewise
            return []

    def _as_before(self, data: bytes) -> bool:
        """Whether all lengths and strings that decide the places are those of the last message."""
        return (
            len(data) == self._length
            and data[_START : self._begin] == self._fixed
            and data[self._end : self._end + 4] == self._after
        )

    def _learn(self, data: bytes) -> bool:
        message = deserialize_message(data, JointState)
        index, positions = self._index(message), len(message.position)
        if index is None:
            return False
        at = _aligned(_START + 4 + _COUNT.unpack_from(data, _START)[0], 4) + 4
        for name in message.name:
            at = _aligned(at, 4) + 4 + len(name.encode()) + 1
        self._begin = _aligned(_aligned(at, 4) + 4, 8)
        self._end = self._begin + 8 * positions
        self._position = self._begin + 8 * index
        self._velocity = _aligned(self._end + 4, 8) + 8 * index if self._has_velocity(message, index) else 0
        self._length, self._fixed, self._after = len(data), data[_START : self._begin], data[self._end : self._end + 4]
        return True

    def _of_message(self, message: JointState) -> JointSample | None:
        index, stamp = self._index(message), message.header.stamp
        if index is None:
            return None
        velocity = message.velocity[index] if self._has_velocity(message, index) else None
        return JointSample(stamp.sec * 1_000_000_000 + stamp.nanosec, message.position[index], velocity)

    def _index(self, message: JointState) -> int | None:
        """Index of the joint's position; None if there is none, or it is unknown."""
        names, positions = list(message.name), len(message.position)
        if self._joint not in names or (self._whole and positions != len(names)):
            return None
        index = names.index(self._joint)
        return index if index < positions else None

    def _has_velocity(self, message: JointState, index: int) -> bool:
        velocities = len(message.velocity)
        return velocities == len(message.name) if self._whole else index < velocities


def _aligned(offset: int, size: int) -> int:
    """The next multiple of `size`, counted from the end of the encapsulation."""
    return 4 + (offset - 4 + size - 1) // size * size
