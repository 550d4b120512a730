"""Arrays as a recording in the topics of the contract."""

import json
import time as clock
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.files import whole_folder
from pneumo_ros.records import contract, encoding
from pneumo_ros.records.bag_writer import BagWriter, check_new
from pneumo_ros.records.block import Integers
from pneumo_ros.records.metadata import BagTopic
from pneumo_ros.records.recording import Array

Stream = tuple[Integers, list[bytes]]  # recorded times (n,) [ns] and as many messages


def write_recording(
    path: str | Path,
    *,
    time: Array,
    position: Array,
    velocity: Array | None = None,
    effort: Array | None = None,
    pressure_a: Array | None = None,
    pressure_b: Array | None = None,
    supply_pressure: Array | None = None,
    pressure_variance: float = 0.0,
    load_cell: Array | None = None,
    reference: Array | None = None,
    others: Mapping[str, Array] | None = None,
    voltage: Array | None = None,
    command_time: Array | None = None,
    command: Array | None = None,
    description: dict[str, Any] | None = None,
    start_ns: int | None = None,
    joint_name: str = contract.JOINT,
    namespace: str = "",
) -> None:
    """Write a new rosbag2 folder, which appears whole or not at all; `read_recording` gives the same arrays back,
    times to the nanosecond.

    `time` (n,) [s] increases; its zero is `start_ns` [ns] since the epoch (None: now). Signals (n,):
    position [m], velocity [m/s], effort [N], absolute pressures [Pa] with one variance [Pa2], the force of a load cell
    [N], the wanted position [m], and `others`, signals by the names of their topics. The valve command is
    either `voltage` (n,) [V], held from each sample to the next and written when it changes, or `command_time` (m,)
    [s] with `command` (m,) [V]. Raises UsageError for arrays of other shapes, DataError when `path` exists.
    """
    signals = {
        "position": position, "velocity": velocity, "effort": effort, "pressure_a": pressure_a,
        "pressure_b": pressure_b, "supply_pressure": supply_pressure, "load_cell": load_cell, "reference": reference,
        "voltage": voltage, **(others or {}),
    }  # fmt: skip
    check_new(Path(path))
    _check(time, signals)
    if (command_time is None) != (command is None) or (voltage is not None and command is not None):
        raise UsageError("give the valve command as voltage, or as command_time and command together")
    if voltage is not None:
        changed = np.flatnonzero(np.diff(voltage, prepend=np.nan) != 0)
        command_time, command = time[changed], voltage[changed]
    origin = clock.time_ns() if start_ns is None else start_ns
    stamp = _nanoseconds(time, origin)
    streams: dict[str, Stream] = {}
    if description is not None:
        streams[contract.DESCRIPTION] = (stamp[:1], [encoding.text(json.dumps(description))])
    if command_time is not None and command is not None:
        streams[contract.COMMAND] = (_nanoseconds(command_time, origin), encoding.numbers(np.asarray(command)))
    joint = {"position": position, "velocity": velocity, "effort": effort}
    streams[contract.JOINT_STATES] = (stamp, encoding.joint_states(stamp, joint_name, joint))
    gas = {contract.PRESSURE_A: pressure_a, contract.PRESSURE_B: pressure_b, contract.SUPPLY_PRESSURE: supply_pressure}
    for name, values in gas.items():
        if values is not None:
            streams[name] = (stamp, encoding.pressures(stamp, values, pressure_variance))
    if load_cell is not None:
        measured = {"position": None, "velocity": None, "effort": load_cell}
        streams[contract.LOAD_CELL] = (stamp, encoding.joint_states(stamp, joint_name, measured))
    plain = {**({} if reference is None else {contract.REFERENCE: reference}), **(others or {})}
    streams |= {name: (stamp, encoding.numbers(values)) for name, values in plain.items()}
    with whole_folder(path) as folder:
        _write(folder, namespace.strip("/"), streams)


def _write(folder: Path, namespace: str, streams: dict[str, Stream]) -> None:
    """All messages in the order of time; at equal times in the order of the streams."""
    names = {name: f"/{namespace}/{name}" if namespace else f"/{name}" for name in streams}
    kinds = {name: contract.TYPES.get(name, contract.TYPES[contract.COMMAND]) for name in streams}
    topics = [BagTopic(names[name], kind, name in contract.LATCHED) for name, kind in kinds.items()]
    messages = [(names[name], payload) for name, (_, payloads) in streams.items() for payload in payloads]
    times = np.concatenate([stamp for stamp, _ in streams.values()])
    with BagWriter(folder, topics) as writer:
        for index in np.argsort(times, kind="stable").tolist():
            topic, payload = messages[index]
            writer.write(topic, int(times[index]), payload)


def _nanoseconds(time: Array, origin: int) -> Integers:
    since: NDArray[np.int64] = np.rint(np.asarray(time) * 1e9).astype(np.int64)
    return since + origin


def _check(time: Array, signals: dict[str, Array | None]) -> None:
    """Raises UsageError unless time increases and every signal has one value for each time."""
    if time.ndim != 1 or len(time) < 2 or not np.isfinite(time).all() or not (np.diff(time) > 0).all():
        raise UsageError("time must be at least two finite values that increase")
    for name, values in signals.items():
        if values is not None and np.shape(values) != time.shape:
            raise UsageError(
                f"{name} has shape {np.shape(values)}, time has {time.shape}: give one value for each time"
            )
