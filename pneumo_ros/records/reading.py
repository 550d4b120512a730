"""A recording on disk as one `Recording`: topics chosen, cleaned, and brought to one time base."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.records import checks, contract
from pneumo_ros.records.bag import Bag
from pneumo_ros.records.block import Channel
from pneumo_ros.records.joints import joint_series
from pneumo_ros.records.namespaces import NEEDED, check_types, choose_namespace
from pneumo_ros.records.recording import Array, Recording
from pneumo_ros.records.series import COMMAND_LEAD, Series, finite, held, increasing, on_clock_of, resampled, seconds
from pneumo_ros.records.source import recording_name
from pneumo_ros.records.topics import collect

FEWEST = 2  # samples that make a time base


def read_recording(path: str | Path, namespace: str | None = None, joint_name: str | None = None) -> Recording:
    """The recording at `path`: a rosbag2 folder, one whose recorder was killed, or a bare `.mcap` or `.db3` file.

    `namespace` and `joint_name` choose among several axes in one recording. Raises DataError when the recording cannot
    be read, lacks a required signal, or leaves that choice open.
    """
    return _Reader(Path(path), namespace, joint_name).recording()


class _Reader:
    """Steps from topics to a Recording; what is found on the way is collected in `warnings`."""

    def __init__(self, path: Path, namespace: str | None, joint_name: str | None) -> None:
        self.path = path
        bag = Bag(path)
        found, types = collect(bag, _is_signal)
        self.warnings = list(bag.warnings)
        if not types:
            raise DataError(" ".join([f"{path} holds no messages.", *self.warnings]))
        self.namespace = choose_namespace(path, types, namespace)
        check_types(types, self.namespace)
        self.topics = {topic: data for topic, data in found.items() if _name(topic, self.namespace)}
        self.signals = {_name(topic, self.namespace): data for topic, data in self.topics.items()}
        self.joint_name, self.joints = self._joint_states(joint_name)

    def recording(self) -> Recording:
        """Everything on the time base of the joint states."""
        commands = self._commands()
        pressure_a, pressure_b = self._pressure(contract.PRESSURE_A), self._pressure(contract.PRESSURE_B)
        self._require(commands, pressure_a, pressure_b)
        pressures = [series for series in (pressure_a, pressure_b) if series]
        joints = self._cut(pressures, commands)
        self.warnings += checks.all_of(pressures, joints)
        origin = int(joints.stamp[0])
        time = seconds(joints.stamp, origin)
        command_time, command, voltage = _zero_order_hold(commands, time, origin)
        return Recording(
            name=recording_name(self.path),
            path=self.path,
            namespace=self.namespace,
            joint_name=self.joint_name,
            start_ns=origin,
            time=time,
            position=joints.values["position"],
            velocity=self._optional(joints, "velocity"),
            effort=self._optional(joints, "effort"),
            pressure_a=_sampled(pressure_a, joints),
            pressure_b=_sampled(pressure_b, joints),
            supply_pressure=_sampled(self._pressure(contract.SUPPLY_PRESSURE), joints),
            voltage=voltage,
            command_time=command_time,
            command=command,
            description=self._description(),
            warnings=tuple(self.warnings),
        )

    def _joint_states(self, joint_name: str | None) -> tuple[str, Series]:
        """Name of the joint and its states in increasing time, with a position in each."""
        data = self.signals[contract.JOINT_STATES]
        joint, series = joint_series(data, joint_name)
        series = increasing(finite(series, "position", self._warn), self._warn)
        if contract.COMMAND not in self.signals and np.isfinite(series.values["effort"]).any():
            series = finite(series, "effort", self._warn)
        if len(series) < FEWEST:
            raise DataError(
                f"{self.path}: {data.name} gives {len(series)} positions of '{joint}' out of {len(data)} messages."
            )
        return joint, series

    def _pressure(self, name: str) -> Series | None:
        """Pressures of one topic in increasing time; None when there are none."""
        data = self.signals.get(name)
        if data is None:
            return None
        series = Series(data.name, data.stamp, data.log_time, {"fluid_pressure": data["fluid_pressure"]})
        series = increasing(finite(series, "fluid_pressure", self._warn), self._warn)
        return series if len(series) else None

    def _commands(self) -> Series | None:
        """Valve commands at their recorded times, on the clock of the joint states; None when there are none."""
        data = self.signals.get(contract.COMMAND)
        if data is None:
            return None
        stamp = on_clock_of(self.joints, data.log_time, self._warn)
        series = finite(Series(data.name, stamp, data.log_time, {"data": data["data"]}), "data", self._warn)
        return series if len(series) else None

    def _require(self, commands: Series | None, *pressures: Series | None) -> None:
        """Raises DataError unless this is a valve-driven axis with pressures, or a force-driven one."""
        effort = np.isfinite(self.joints.values["effort"]).all()
        if commands is None and not effort:
            lacking = f"{contract.COMMAND} or the effort in {contract.JOINT_STATES}"
        elif commands is not None and None in pressures:
            names = (contract.PRESSURE_A, contract.PRESSURE_B)
            lacking = " and ".join(name for name, series in zip(names, pressures, strict=True) if series is None)
        else:
            return
        there = ", ".join(sorted(self.topics))
        raise DataError(f"{self.path} lacks {lacking}. There is: {there}. Needed: {NEEDED}.")

    def _cut(self, pressures: list[Series], commands: Series | None) -> Series:
        """Joint states during which the pressures and the command are known."""
        stamp = self.joints.stamp
        step = int(np.median(np.diff(stamp)))
        first = max([int(one.stamp[0]) - step for one in pressures], default=int(stamp[0]))
        last = min([int(one.stamp[-1]) + step for one in pressures], default=int(stamp[-1]))
        if commands is not None:
            first = max(first, int(commands.stamp[0] - COMMAND_LEAD * step))
        inside = self.joints.select((stamp >= first) & (stamp <= last))
        if len(inside) < FEWEST:
            raise DataError(f"{self.path}: joint states, pressures and commands do not overlap in time.")
        self.warnings += checks.trimmed(self.joints, inside, "where pressures or commands are not known")
        return inside

    def _optional(self, joints: Series, name: str) -> Array | None:
        """A value the recording may have; None, with a warning, when only some of its samples are finite."""
        values = joints.values[name]
        good = np.isfinite(values)
        if good.all():
            return values
        if good.any():
            bad = int(np.count_nonzero(~good))
            self._warn(f"{joints.topic}: {bad} of {len(values)} values of {name} are not finite; {name} is not used.")
        return None

    def _description(self) -> dict[str, Any] | None:
        """The last description of the plant."""
        data = self.signals.get(contract.DESCRIPTION)
        if data is None:
            return None
        try:
            content = json.loads(data["data"][-1])
        except json.JSONDecodeError as error:
            self._warn(f"{data.name}: the last one is no JSON ({error}); it is not used.")
            return None
        if isinstance(content, dict):
            return content
        self._warn(f"{data.name}: the last one is no JSON object; it is not used.")
        return None

    def _warn(self, sentence: str) -> None:
        self.warnings.append(sentence)


def _is_signal(channel: Channel) -> bool:
    """Whether a channel can be part of a Recording."""
    found = contract.split(channel.topic)
    return found is not None and found[1] in contract.SIGNALS


def _name(topic: str, namespace: str) -> str:
    """Contract name of a topic of the axis in `namespace`; "" for one of another axis."""
    found = contract.split(topic)
    return found[1] if found and found[0] == namespace else ""


def _sampled(series: Series | None, joints: Series) -> Array | None:
    """Pressure at the times of the joint states."""
    return None if series is None else resampled(series, "fluid_pressure", joints.stamp)


def _zero_order_hold(
    commands: Series | None, time: Array, origin: int
) -> tuple[Array, Array, Array] | tuple[None, None, None]:
    """Times [s] and values [V] of the commands, and the voltage in force at each of `time`."""
    if commands is None:
        return None, None, None
    command_time, command = seconds(commands.stamp, origin), commands.values["data"]
    return command_time, command, held(time, command_time, command)
