"""Arrays as serialized messages: one message is serialized by rosbags, the others copy its layout."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.records import message_types
from pneumo_ros.records.block import Integers
from pneumo_ros.records.contract import TYPES
from pneumo_ros.records.layout import Layout, leaves
from pneumo_ros.records.message_types import message
from pneumo_ros.records.recording import Array

SECOND = 1_000_000_000  # [ns]


def encode(example: Any, columns: dict[str, NDArray[Any]], count: int) -> list[bytes]:
    """CDR bytes of `count` messages like `example`, with the numbers of `columns`: field -> one row per message."""
    payload = message_types.serialize(example)
    layout = Layout(payload, leaves(message_types.standard_types(), example.__msgtype__))
    data, size = bytearray(payload * count), layout.length
    rows = np.frombuffer(data, dtype=layout.dtype)
    for field, values in columns.items():
        rows[field] = values
    return [bytes(data[start : start + size]) for start in range(0, len(data), size)]


def joint_states(stamp: Integers, joint_name: str, fields: dict[str, Array | None]) -> list[bytes]:
    """sensor_msgs/JointState of one joint: `stamp` (n,) [ns], fields position, velocity and effort (n,) or None."""
    given = {name: values for name, values in fields.items() if values is not None}
    lists = {name: np.zeros(1 if name in given else 0) for name in fields}
    example = message(TYPES["joint_states"], header=_header(), name=[joint_name], **lists)
    return encode(example, _stamps(stamp) | {name: v[:, np.newaxis] for name, v in given.items()}, len(stamp))


def pressures(stamp: Integers, values: Array, variance: float) -> list[bytes]:
    """sensor_msgs/FluidPressure: `stamp` (n,) [ns], `values` (n,) [Pa], `variance` [Pa2]."""
    example = message(TYPES["supply/pressure"], header=_header(), fluid_pressure=0.0, variance=variance)
    return encode(example, _stamps(stamp) | {"fluid_pressure": values}, len(stamp))


def numbers(values: Array) -> list[bytes]:
    """std_msgs/Float64 of each of `values` (n,)."""
    return encode(message("std_msgs/msg/Float64", data=0.0), {"data": values}, len(values))


def text(content: str) -> bytes:
    """std_msgs/String."""
    return message_types.serialize(message("std_msgs/msg/String", data=content))


def _header() -> Any:
    return message("std_msgs/msg/Header", stamp=message("builtin_interfaces/msg/Time", sec=0, nanosec=0), frame_id="")


def _stamps(stamp: Integers) -> dict[str, NDArray[Any]]:
    return {"header.stamp.sec": stamp // SECOND, "header.stamp.nanosec": stamp % SECOND}
