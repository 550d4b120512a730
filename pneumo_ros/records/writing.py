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
from pneumo_ros.measured import PLAIN
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
    further: Mapping[str, Array] | None = None,
    others: Mapping[str, Array] | None = None,
    voltage: Array | None = None,
    command_time: Array | None = None,
    command: Array | None = None,
    command_b_time: Array | None = None,
    command_b: Array | None = None,
    description: dict[str, Any] | None = None,
    start_ns: int | None = None,
    joint_name: str = contract.JOINT,
    namespace: str = "",
) -> None:
    """Write a new rosbag2 folder, which appears whole or not at all; `read_recording` gives the same arrays back,
    times to the nanosecond.

    `time` (n,) [s] increases; its zero is `start_ns` [ns] since the epoch (None: now). Signals (n,):
    position [m], velocity [m/s], effort [N], absolute pressures [Pa] with one variance [Pa2], the force of a load cell
    [N], the wanted position [m], `further` ones by their names in `measured`, and `others` by their topics. The valve
    command is either `voltage` (n,) [V], held from each sample to the next and written when it changes, or
    `command_time` (m,) [s] with `command` (m,) [V]; that of a valve of chamber b is `command_b_time` with `command_b`
    (k,) [V]. Raises UsageError for arrays of other shapes, DataError when `path` exists.
    """
    check_new(Path(path))
    streams = _streams(
        time=time, position=position, velocity=velocity, effort=effort, pressure_a=pressure_a, pressure_b=pressure_b,
        supply_pressure=supply_pressure, pressure_variance=pressure_variance, load_cell=load_cell, reference=reference,
        further=further, others=others, voltage=voltage, command_time=command_time, command=command,
        command_b_time=command_b_time, command_b=command_b, description=description,
        origin=clock.time_ns() if start_ns is None else start_ns, joint_name=joint_name,
    )  # fmt: skip
    with whole_folder(path) as folder:
        _write(folder, {namespace.strip("/"): streams})


def write_axes(
    path: str | Path,
    axes: Mapping[str, Mapping[str, Any]],
    *,
    supply_pressure: Array | None = None,
    description: dict[str, Any] | None = None,
    start_ns: int | None = None,
    namespace: str = "",
) -> None:
    """Write a new rosbag2 folder of several axes, each under its prefix, as `write_recording` writes one.

    axes: prefix -> what `write_recording` takes of it; its joint is named by the prefix. `supply_pressure` (n,) [Pa] of
    the line that they share, at the times of the first axis, and the `description` of all have no prefix.
    """
    check_new(Path(path))
    if not axes:
        raise UsageError("a recording has at least one axis")
    origin, root = clock.time_ns() if start_ns is None else start_ns, namespace.strip("/")
    found = {_below(root, axis): _streams(origin=origin, joint_name=axis, **one) for axis, one in axes.items()}
    time = next(iter(axes.values()))["time"]
    _check(time, {"supply_pressure": supply_pressure})
    shared: dict[str, Stream] = {}
    if description is not None:
        shared[contract.DESCRIPTION] = (_nanoseconds(time[:1], origin), [encoding.text(json.dumps(description))])
    if supply_pressure is not None:
        stamp = _nanoseconds(time, origin)
        shared[contract.SUPPLY_PRESSURE] = (stamp, encoding.pressures(stamp, supply_pressure, 0.0))
    with whole_folder(path) as folder:
        _write(folder, {root: shared, **found})


def _streams(
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
    further: Mapping[str, Array] | None = None,
    others: Mapping[str, Array] | None = None,
    voltage: Array | None = None,
    command_time: Array | None = None,
    command: Array | None = None,
    command_b_time: Array | None = None,
    command_b: Array | None = None,
    description: dict[str, Any] | None = None,
    origin: int,
    joint_name: str = contract.JOINT,
) -> dict[str, Stream]:
    """The messages of one axis by their names in the contract; `time` zero is `origin` [ns] since the epoch."""
    others = {**{PLAIN[name].topic: values for name, values in (further or {}).items()}, **(others or {})}
    signals = {
        "position": position, "velocity": velocity, "effort": effort, "pressure_a": pressure_a,
        "pressure_b": pressure_b, "supply_pressure": supply_pressure, "load_cell": load_cell, "reference": reference,
        "voltage": voltage, **others,
    }  # fmt: skip
    _check(time, signals)
    if (command_time is None) != (command is None) or (voltage is not None and command is not None):
        raise UsageError("give the valve command as voltage, or as command_time and command together")
    if voltage is not None:
        changed = np.flatnonzero(np.diff(voltage, prepend=np.nan) != 0)
        command_time, command = time[changed], voltage[changed]
    stamp = _nanoseconds(time, origin)
    streams: dict[str, Stream] = {}
    if description is not None:
        streams[contract.DESCRIPTION] = (stamp[:1], [encoding.text(json.dumps(description))])
    if command_time is not None and command is not None:
        streams[contract.COMMAND] = (_nanoseconds(command_time, origin), encoding.numbers(np.asarray(command)))
    if command_b_time is not None and command_b is not None:
        streams[contract.COMMAND_B] = (_nanoseconds(command_b_time, origin), encoding.numbers(np.asarray(command_b)))
    joint = {"position": position, "velocity": velocity, "effort": effort}
    streams[contract.JOINT_STATES] = (stamp, encoding.joint_states(stamp, joint_name, joint))
    gas = {contract.PRESSURE_A: pressure_a, contract.PRESSURE_B: pressure_b, contract.SUPPLY_PRESSURE: supply_pressure}
    for name, values in gas.items():
        if values is not None:
            streams[name] = (stamp, encoding.pressures(stamp, values, pressure_variance))
    if load_cell is not None:
        measured = {"position": None, "velocity": None, "effort": load_cell}
        streams[contract.LOAD_CELL] = (stamp, encoding.joint_states(stamp, joint_name, measured))
    plain = {**({} if reference is None else {contract.REFERENCE: reference}), **others}
    return streams | {name: (stamp, encoding.numbers(values)) for name, values in plain.items()}


def _write(folder: Path, axes: Mapping[str, dict[str, Stream]]) -> None:
    """The messages of each namespace in the order of time; at equal times in the order of the streams."""
    names = {(axis, name): f"/{_below(axis, name)}" for axis, streams in axes.items() for name in streams}
    usual = contract.TYPES[contract.COMMAND]
    topics = [
        BagTopic(topic, contract.TYPES.get(name, usual), name in contract.LATCHED) for (_, name), topic in names.items()
    ]
    every = {names[axis, name]: stream for axis, streams in axes.items() for name, stream in streams.items()}
    messages = [(topic, payload) for topic, (_, payloads) in every.items() for payload in payloads]
    times = np.concatenate([stamp for stamp, _ in every.values()])
    with BagWriter(folder, topics) as writer:
        for index in np.argsort(times, kind="stable").tolist():
            topic, payload = messages[index]
            writer.write(topic, int(times[index]), payload)


def _below(namespace: str, name: str) -> str:
    return f"{namespace}/{name}" if namespace else name


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
