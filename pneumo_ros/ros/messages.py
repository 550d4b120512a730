"""Sensor messages as bytes: serialised once, then only their numbers change. Sending costs a third of an object's."""

import struct

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.records.message_types import trimmed

_STAMP, _NUMBER = struct.Struct("<iI"), struct.Struct("<d")  # CDR on little-endian machines
_MARK = Time(sec=0x1A2B3C4D, nanosec=0x0E0F1011)


class Template:
    """A serialised message with places for its stamp and some numbers.

    The places are found by the marks that the message was filled with, so its layout need not be known.
    """

    def __init__(self, message: JointState | FluidPressure | Clock | Float64, numbers: list[float]) -> None:
        """`message` has the stamp _MARK, if it has one, and each of `numbers`, in order, exactly once."""
        # After an empty sequence rclpy leaves extra bytes, which other readers refuse.
        self._buffer = bytearray(trimmed(serialize_message(message), _type(message)))
        self._stamp = None if isinstance(message, Float64) else self._place(_STAMP.pack(_MARK.sec, _MARK.nanosec))
        self._numbers = [self._place(_NUMBER.pack(number)) for number in numbers]

    def _place(self, mark: bytes) -> int:
        if self._buffer.count(mark) != 1:
            raise RuntimeError("this middleware does not serialise to little-endian CDR")
        return self._buffer.index(mark)

    def fill(self, stamp_ns: int, *numbers: float) -> bytes:
        """The message with this stamp [ns] and these numbers."""
        if self._stamp is not None:
            _STAMP.pack_into(self._buffer, self._stamp, *divmod(stamp_ns, 1_000_000_000))
        for place, value in zip(self._numbers, numbers, strict=True):
            _NUMBER.pack_into(self._buffer, place, value)
        return bytes(self._buffer)


def _type(message: JointState | FluidPressure | Clock | Float64) -> str:
    """Name of a message's type, such as "std_msgs/msg/Float64"."""
    return f"{type(message).__module__.partition('.')[0]}/msg/{type(message).__name__}"


def joint_state(joint: str, velocity: bool = True, effort: bool = True) -> Template:
    """Template of a joint state; `fill` takes position [m] and, if present, velocity [m/s] and effort [N]."""
    position, speed, force = 1.2345e-67, 2.3456e-78, 3.4567e-89
    speeds, forces = [speed] if velocity else [], [force] if effort else []
    message = JointState(name=[joint], position=[position], velocity=speeds, effort=forces)
    message.header.stamp = _MARK
    return Template(message, [position, *speeds, *forces])


def load_cell(joint: str) -> Template:
    """Template of a joint state with an effort alone; `fill` takes the force [N]."""
    message = JointState(name=[joint], effort=[3.4567e-89])
    message.header.stamp = _MARK
    return Template(message, [3.4567e-89])


def pressure(frame: str) -> Template:
    """Template of a pressure at `frame`; `fill` takes pressure [Pa] and variance [Pa2]."""
    value, variance = 1.2345e-67, 2.3456e-78
    message = FluidPressure(fluid_pressure=value, variance=variance)
    message.header.stamp, message.header.frame_id = _MARK, frame
    return Template(message, [value, variance])


def clock() -> Template:
    """Template of a /clock message; `fill` takes no number."""
    return Template(Clock(clock=_MARK), [])


def number() -> Template:
    """Template of a plain number; `fill` ignores the stamp."""
    return Template(Float64(data=1.2345e-67), [1.2345e-67])
