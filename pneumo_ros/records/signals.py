"""The signals of one axis in a recording, cleaned but not resampled."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.measured import PLAIN
from pneumo_ros.records import clocks, contract
from pneumo_ros.records.bag import Bag
from pneumo_ros.records.block import Channel
from pneumo_ros.records.drift import on_rate_of, stamps_at, steady_rate
from pneumo_ros.records.foreign_topics import parse_place, renamed
from pneumo_ros.records.joints import joint_series
from pneumo_ros.records.namespaces import check_types, choose_namespace
from pneumo_ros.records.series import Series, finite, increasing, on_clock_of
from pneumo_ros.records.topic_data import TopicData, set_back
from pneumo_ros.records.topics import collect

FEWEST = 2  # samples that make a time base


class Signals:
    """Topics of the axis in `namespace`; `warnings` lists their faults."""

    def __init__(
        self, path: Path, namespace: str | None, joint_name: str | None, topics: Mapping[str, str] | None = None
    ) -> None:
        """Read the recording; `topics`: of another program, by names in the contract (see `foreign_topics`).

        Raises DataError when it cannot be read, or the axis or the joint is not clear.
        """
        self.path, topics = path, topics or {}
        bag = Bag(path)
        named = {place[0] for text in topics.values() if (place := parse_place(text))}
        found, types = collect(bag, lambda channel: _is_signal(channel) or channel.topic in named)
        self.warnings = list(bag.warnings)
        if not types:
            raise DataError(" ".join([f"{path} holds no messages.", *self.warnings]))
        others = renamed(found, types, topics, str(path))
        self._types = types
        alike = {topic: kind for topic, kind in types.items() if topic not in named}
        if contract.JOINT_STATES in others:
            self.namespace = (namespace or "").strip("/")
        else:
            self.namespace = choose_namespace(path, alike, namespace)
        check_types(alike, self.namespace)
        usual = {topic: data for topic, data in found.items() if topic not in named}
        own = {name: data for topic, data in usual.items() if (name := _name(topic, self.namespace)) is not None}
        self._topics = _shared(usual, self.namespace) | own | others
        self.joint_name, self.joints = self._joint_states(joint_name)

    @property
    def topics(self) -> list[str]:
        """Names of the axis' topics, as recorded."""
        return sorted(data.name for data in self._topics.values())

    def has(self, name: str) -> bool:
        """Whether the axis has the contract's topic `name`."""
        return name in self._topics

    def like(self, name: str) -> list[str]:
        """Recorded topics with unknown names that have the type of the contract's topic `name`."""
        return sorted(t for t, kind in self._types.items() if kind == contract.TYPES[name] and not contract.split(t))

    def pressure(self, name: str) -> Series | None:
        """Pressures of one topic in increasing time; None when there are none."""
        data = self._topics.get(name)
        if data is None:
            return None
        series = Series(data.name, data.stamp, data.log_time, {"fluid_pressure": data["fluid_pressure"]})
        series = clocks.without_strays(finite(series, "fluid_pressure", self.warn), self.warn)
        if not len(series):
            raise DataError(
                f"{self.path}: none of the {len(data)} pressures of {data.name} is a finite number; its sensor or "
                "driver sends no values."
            )
        if self._jumped:
            series = clocks.beside(series, self.joints)
        else:
            series = series.select(clocks.longest(series, self.warn))
        return on_rate_of(increasing(series, self.warn), self.joints, self.warn)

    def load_cell(self) -> Series | None:
        """The measured rod force in increasing time; None where there is none, with a warning if it has no number."""
        data = self._topics.get(contract.LOAD_CELL)
        if data is None:
            return None
        joints = {joint for names in data["name"].tolist() for joint in names}
        _, series = joint_series(data, self.joint_name if self.joint_name in joints else None)
        if not np.isfinite(series.values["effort"]).any():
            self.warn(f"{data.name}: it holds no finite effort; it is not used.")
            return None
        series = clocks.without_strays(finite(series, "effort", self.warn), self.warn)
        series = (
            clocks.beside(series, self.joints) if self._jumped else series.select(clocks.longest(series, self.warn))
        )
        return on_rate_of(increasing(series, self.warn), self.joints, self.warn)

    def further(self) -> dict[str, Series]:
        """Values of the plain signals of `measured`, by name, on the clock of the joint states."""
        found = dict[str, Series]()
        for name, one in PLAIN.items():
            data = self._topics.get(one.topic)
            if data is not None:
                stamp = on_clock_of(self.joints, data.log_time, self.warn)
                series = finite(Series(data.name, stamp, data.log_time, {"data": data["data"]}), "data", self.warn)
                found |= {name: increasing(series, self.warn)} if len(series) else {}
        return found

    def commands(self, topic: str = contract.COMMAND) -> Series | None:
        """Valve commands at their recorded times, on the clock of the joint states; None when there are none."""
        data = self._topics.get(topic)
        if data is None:
            return None
        places, log_time = clocks.after_turns(data.log_time, self._turns, int(self.joints.log_time[0]))
        line = None if self._jumped else steady_rate(self.joints)
        if line is None:
            stamp = on_clock_of(self.joints, log_time, self.warn)
        else:
            stamp = stamps_at(line, log_time)
            moved = 1e-6 * float(np.abs(stamp - log_time).max())
            percent, slow = f"{100.0 * abs(line.slope):.2g} %", line.slope > 0.0
            self.warn(
                f"{self.joints.topic}: its stamps run {percent} {'slower' if slow else 'faster'} than the recorder's "
                f"clock; commands, which have no stamp, are placed on its clock, up to {moved:.3g} ms from where they "
                f"were recorded. If the recorder's is right, speeds are {percent} too {'high' if slow else 'low'}."
            )
        series = finite(Series(data.name, stamp, log_time, {"data": data["data"][places]}), "data", self.warn)
        return series if len(series) else None

    def description(self) -> dict[str, Any] | None:
        """The last description of the plant; None, with a warning, when it is not valid."""
        data = self._topics.get(contract.DESCRIPTION)
        content = None if data is None else _json_object(data["data"][-1])
        if data is not None and content is None:
            self.warn(f"{data.name}: the last message is no JSON object; it is not used.")
        return content

    def warn(self, sentence: str) -> None:
        """Add to the warnings."""
        self.warnings.append(sentence)

    def _joint_states(self, joint_name: str | None) -> tuple[str, Series]:
        """Name of the joint and its states in increasing time, with a position in each."""
        data = self._topics[contract.JOINT_STATES]
        joint, series = joint_series(data, joint_name)
        series = clocks.without_strays(finite(series, "position", self.warn), self.warn)
        part = clocks.longest(series, self.warn)
        self._jumped = part != slice(0, len(series))
        self._turns = int(np.count_nonzero(set_back(series.log_time) <= part.start))
        series = increasing(series.select(part), self.warn)
        if contract.COMMAND not in self._topics and np.isfinite(series.values["effort"]).any():
            series = finite(series, "effort", self.warn)
        if len(series) < FEWEST:
            raise DataError(
                f"{self.path}: {data.name} gives {len(series)} finite positions of '{joint}' in {len(data)} messages; "
                "its sensor or driver sends no values."
            )
        return joint, series


def _json_object(text: str) -> dict[str, Any] | None:
    """The JSON object in `text`; None if there is none."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):  # such as a number of 10 000 digits, or 10 000 brackets
        return None
    return content if isinstance(content, dict) else None


def _is_signal(channel: Channel) -> bool:
    """Whether a channel can be part of a Recording."""
    found = contract.split(channel.topic)
    return found is not None and found[1] in contract.SIGNALS


def _shared(found: Mapping[str, TopicData], namespace: str) -> dict[str, TopicData]:
    """What an axis shares with others: the supply's pressure of the nearest namespace above it that has one."""
    above = namespace
    for _ in range(namespace.count("/") + bool(namespace)):
        above = above.rpartition("/")[0]
        topic = f"/{above}/{contract.SUPPLY_PRESSURE}" if above else f"/{contract.SUPPLY_PRESSURE}"
        if topic in found and found[topic].type == contract.TYPES[contract.SUPPLY_PRESSURE]:
            return {contract.SUPPLY_PRESSURE: found[topic]}
    return {}


def _name(topic: str, namespace: str) -> str | None:
    """Contract name of a topic of the axis in `namespace`; None for one of another axis."""
    found = contract.split(topic)
    return found[1] if found and found[0] == namespace else None
