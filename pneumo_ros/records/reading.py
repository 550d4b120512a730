"""A recording on disk as one `Recording`: its signals brought to one time base."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.measured import PLAIN
from pneumo_ros.records import checks, contract
from pneumo_ros.records.namespaces import NEEDED
from pneumo_ros.records.recording import Array, Recording, imposed, with_imposed
from pneumo_ros.records.series import COMMAND_LEAD, Series, held, resampled, seconds
from pneumo_ros.records.signals import FEWEST, Signals
from pneumo_ros.records.source import recording_name


def read_recording(
    path: str | Path,
    namespace: str | None = None,
    joint_name: str | None = None,
    motion_imposed: bool = False,
    topics: Mapping[str, str] | None = None,
) -> Recording:
    """The recording at `path`: a rosbag2 folder, one whose recorder was killed, or a bare `.mcap` or `.db3` file.

    `namespace` and `joint_name` choose among several axes in one recording; `motion_imposed`: a test machine imposed
    the motion, though no map in the recording says so. `topics`: those of another program, by names in the contract, as
    /plc/values:data[3] where a field of another type is meant. Raises DataError when the recording cannot be read,
    lacks a required signal, or needs one of them.
    """
    signals = Signals(Path(path), namespace, joint_name, topics)
    commands = signals.commands()
    pressure_a, pressure_b = signals.pressure(contract.PRESSURE_A), signals.pressure(contract.PRESSURE_B)
    description, load_cell = signals.description(), signals.load_cell()
    description = with_imposed(description) if motion_imposed else description
    pressures = [series for series in (pressure_a, pressure_b) if series]
    if not (imposed(description) and commands is None and (pressures or load_cell)):
        _require(signals, commands, pressure_a, pressure_b)
    joints = _cut(signals, pressures, commands)
    signals.warnings += checks.all_of(pressures, joints)
    signals.warnings += checks.pauses(commands, joints) if commands is not None else []
    joints = checks.outside_gaps(joints, pressures)
    time = seconds(joints.stamp, int(joints.stamp[0]))
    command_time, command, voltage = _zero_order_hold(commands, time, int(joints.stamp[0]))
    command_b_time, command_b, _ = _zero_order_hold(signals.commands(contract.COMMAND_B), time, int(joints.stamp[0]))
    return Recording(
        name=recording_name(signals.path),
        path=signals.path,
        namespace=signals.namespace,
        joint_name=signals.joint_name,
        start_ns=int(joints.stamp[0]),
        time=time,
        position=joints.values["position"],
        velocity=_optional(signals, joints, "velocity"),
        effort=_optional(signals, joints, "effort"),
        pressure_a=_sampled(pressure_a, joints, "fluid_pressure"),
        pressure_b=_sampled(pressure_b, joints, "fluid_pressure"),
        supply_pressure=_sampled(signals.pressure(contract.SUPPLY_PRESSURE), joints, "fluid_pressure"),
        voltage=voltage,
        command_time=command_time,
        command=command,
        description=description,
        warnings=tuple(signals.warnings),
        load_cell=_sampled(load_cell, joints, "effort"),
        further={name: _further(name, one, joints) for name, one in signals.further().items()},
        command_b_time=command_b_time,
        command_b=command_b,
    )


def _require(signals: Signals, commands: Series | None, *pressures: Series | None) -> None:
    """Raises DataError where neither a pressure nor a force was measured, or one may have another name."""
    driven = bool(np.isfinite(signals.joints.values["effort"]).all())
    names = (contract.PRESSURE_A, contract.PRESSURE_B)
    absent = [name for name, series in zip(names, pressures, strict=True) if series is None]
    renamed = bool(signals.like(contract.COMMAND if commands is None else contract.PRESSURE_A))
    if commands is None and not renamed and signals.has(contract.REFERENCE):
        return  # whether the machine file has the loop that the goal drives is asked later
    if commands is None and not driven and (len(absent) == 2 or renamed):
        absent, lacking = [contract.COMMAND], f"{contract.COMMAND} or the effort in {contract.JOINT_STATES}"
    elif commands is not None and (len(absent) == 2 or (absent and renamed)):
        lacking = " and ".join(absent)
    else:
        return
    there = ", ".join(signals.topics)
    raise DataError(f"{signals.path} lacks {lacking}. There is: {there}. Needed: {NEEDED}.{_renamed(signals, absent)}")


def _renamed(signals: Signals, absent: list[str]) -> str:
    """Sentence that says how to use a topic that was recorded under another name; empty when there is none."""
    others = signals.like(absent[0])
    if not others:
        return ""
    target = f"/{signals.namespace}/{absent[0]}" if signals.namespace else f"/{absent[0]}"
    return (
        f" If it is {' or '.join(others)}, start what publishes it with --ros-args -r {others[0]}:={target}; to rename "
        f"it in this recording, record again what comes from: player --ros-args -p input:={signals.path} "
        f"-r {others[0]}:={target}"
    )


def _cut(signals: Signals, pressures: list[Series], commands: Series | None) -> Series:
    """Joint states during which the pressures and the command are known. Raises DataError when there are none."""
    stamp = signals.joints.stamp
    step = int(np.median(np.diff(stamp)))
    first = max([int(one.stamp[0]) - step for one in pressures], default=int(stamp[0]))
    last = min([int(one.stamp[-1]) + step for one in pressures], default=int(stamp[-1]))
    if commands is not None:
        first = max(first, int(commands.stamp[0] - COMMAND_LEAD * step))
    inside = signals.joints.select((stamp >= first) & (stamp <= last))
    if len(inside) < FEWEST:
        raise DataError(_apart(signals, [*pressures, commands] if commands else pressures))
    signals.warnings += checks.trimmed(signals.joints, inside, "where pressures or commands are not known")
    return inside


def _apart(signals: Signals, others: list[Series]) -> str:
    """Sentence for topics that do not overlap in time, with the time span of each."""
    origin = int(signals.joints.stamp[0])
    spans = [
        f"{one.topic} {seconds(one.stamp[[0]], origin)[0]:.3f} to {seconds(one.stamp[[-1]], origin)[0]:.3f} s"
        for one in (signals.joints, *others)
    ]
    return (
        f"{signals.path}: joint states, pressures and commands do not overlap in time: {', '.join(spans)}. If they "
        "were recorded together, the clocks that stamp them differ: synchronise them (NTP, chrony) and record again."
    )


def _optional(signals: Signals, joints: Series, name: str) -> Array | None:
    """An optional value of the recording; None, with a warning, when only some of its samples are finite."""
    values = joints.values[name]
    good = np.isfinite(values)
    if good.all():
        return values
    if good.any():
        bad = int(np.count_nonzero(~good))
        signals.warn(f"{joints.topic}: {bad} of {len(values)} values of {name} are not finite; {name} is not used.")
    return None


def _sampled(series: Series | None, joints: Series, name: str) -> Array | None:
    """Value `name` of a sensor at the times of the joint states."""
    return None if series is None else resampled(series, name, joints.stamp)


def _further(name: str, series: Series, joints: Series) -> Array:
    """A plain signal of `measured` at the times of the joint states, held or linear between its samples."""
    if not PLAIN[name].held:
        return resampled(series, "data", joints.stamp)
    origin = int(joints.stamp[0])
    return held(seconds(joints.stamp, origin), seconds(series.stamp, origin), series.values["data"])


def _zero_order_hold(
    commands: Series | None, time: Array, origin: int
) -> tuple[Array, Array, Array] | tuple[None, None, None]:
    """Times [s] and values [V] of the commands, and the voltage in force at each of `time`."""
    if commands is None:
        return None, None, None
    command_time, command = seconds(commands.stamp, origin), commands.values["data"]
    return command_time, command, held(time, command_time, command)
