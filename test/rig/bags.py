"""Runs as rosbag2 folders: MCAP, zstd, the topics of a rig. Values are patched into messages serialised once."""

import struct
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from .sensors import PRESSURE_NOISE, Run

_STORE = get_typestore(Stores.ROS2_JAZZY)
_STAMP, _MARK = (1234567891, 987654321), 1234.56789
TOPICS = {
    "joint_states": "sensor_msgs/msg/JointState",
    "chamber_a/pressure": "sensor_msgs/msg/FluidPressure",
    "chamber_b/pressure": "sensor_msgs/msg/FluidPressure",
    "valve/command": "std_msgs/msg/Float64",
}


def _serialised(kind: str, **fields: object) -> bytes:
    return bytes(_STORE.serialize_cdr(_STORE.types[kind](**fields), kind))


def _header() -> object:
    time = _STORE.types["builtin_interfaces/msg/Time"](*_STAMP)
    return _STORE.types["std_msgs/msg/Header"](stamp=time, frame_id="")


def _templates() -> dict[str, bytes]:
    """One message of each topic, with marks in place of stamp and value."""
    empty = np.empty(0)
    joint = {"name": ["piston"], "position": np.array([_MARK]), "velocity": empty, "effort": empty}
    pressure = {"fluid_pressure": _MARK, "variance": PRESSURE_NOISE**2}
    fields = {
        "joint_states": {"header": _header(), **joint},
        "chamber_a/pressure": {"header": _header(), **pressure},
        "chamber_b/pressure": {"header": _header(), **pressure},
        "valve/command": {"data": _MARK},
    }
    return {topic: _serialised(kind, **fields[topic]) for topic, kind in TOPICS.items()}


def _messages(template: bytes, stamps: np.ndarray, values: np.ndarray) -> list[bytes]:
    """The template with each stamp [ns since epoch] and value in place of its marks."""
    rows = np.tile(np.frombuffer(template, np.uint8), (len(values), 1))
    at = template.index(struct.pack("<d", _MARK))
    rows[:, at : at + 8] = values.astype("<f8").view(np.uint8).reshape(-1, 8)
    at = template.find(struct.pack("<iI", *_STAMP))
    if at >= 0:
        time = np.column_stack(np.divmod(stamps, 10**9)).astype("<u4")
        rows[:, at : at + 8] = time.view(np.uint8).reshape(-1, 8)
    return [row.tobytes() for row in rows]


def _queue(run: Run, start: int) -> list[tuple[int, str, bytes]]:
    """All messages of a run with log time [ns] and topic, in the order they arrived."""
    stamps, arrived, templates = start + run.stamps, start + run.log_times, _templates()
    sensors = {
        "joint_states": run.position,
        "chamber_a/pressure": run.pressure_a,
        "chamber_b/pressure": run.pressure_b,
    }
    sent = start + run.command_index * 10**6
    queue = []
    for topic, values in sensors.items():
        raw = _messages(templates[topic], stamps, values)
        queue += list(zip(arrived.tolist(), [topic] * len(raw), raw, strict=True))
    raw = _messages(templates["valve/command"], sent, run.voltage[run.command_index])
    queue += list(zip(sent.tolist(), ["valve/command"] * len(raw), raw, strict=True))
    return sorted(queue, key=lambda message: message[0])


def write(folder: Path, run: Run, start: int) -> None:
    """Write the run to the rosbag2 folder `folder`, which must not exist; it starts at `start` ns since epoch."""
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections = {topic: writer.add_connection(topic, kind, typestore=_STORE) for topic, kind in TOPICS.items()}
        for log_time, topic, raw in _queue(run, start):
            writer.write(connections[topic], log_time, raw)
