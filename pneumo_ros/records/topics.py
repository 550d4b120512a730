"""The messages of a recording as columns: one array per topic and field, decoded in bulk."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.bag import Bag
from pneumo_ros.records.block import Block, Channel, Integers, gather
from pneumo_ros.records.layout import Layout, leaves
from pneumo_ros.records.message_types import channel_types
from pneumo_ros.records.topic_data import Part, TopicData

MOST_LAYOUTS = 64  # of one topic; further messages are deserialized one by one


class Collector:
    """Takes the blocks of a recording and sorts the messages of one topic by layout."""

    def __init__(self, channel: Channel) -> None:
        self.channel = channel
        self._leaves = leaves(channel_types(channel), channel.type)
        self._bulk = all(leaf.base != "message" for leaf in self._leaves)
        self._log_times: list[Integers] = []
        self._taken = 0
        self._layouts: dict[Layout, list[tuple[NDArray[np.void], Integers]]] = {}
        self._odd: dict[int, bytes] = {}

    def take(self, block: Block, chosen: Integers) -> None:
        """Add the messages of `block` at the indices `chosen`."""
        self._log_times.append(block.log_time[chosen])
        places = np.arange(self._taken, self._taken + len(chosen))
        self._taken += len(chosen)
        length = block.length[chosen]
        for size in np.unique(length).tolist():
            same = length == size
            self._sort(gather(block.data, block.start[chosen][same], size), places[same])

    def data(self) -> TopicData:
        """Everything taken so far."""
        parts = []
        for layout, pieces in self._layouts.items():
            rows, places = zip(*pieces, strict=True)
            parts.append(Part(layout, np.concatenate(rows).view(layout.dtype), np.concatenate(places)))
        none = np.empty(0, dtype=np.int64)
        return TopicData(self.channel, np.concatenate([none, *self._log_times]), parts, self._odd)

    def _sort(self, rows: NDArray[np.void], places: Integers) -> None:
        """Sort `rows`, all of one length, into their layouts; new layouts are learnt."""
        for layout in [one for one in self._layouts if one.length == rows.itemsize]:
            rows, places = self._give(layout, rows, places)
        while len(rows):
            layout_or_none = self._learn(rows[0].tobytes())
            if layout_or_none is None:
                self._odd[int(places[0])] = rows[0].tobytes()
                rows, places = rows[1:], places[1:]
            else:
                rows, places = self._give(layout_or_none, rows, places)

    def _learn(self, payload: bytes) -> Layout | None:
        """Layout of a message; None when it must be deserialized by itself."""
        if not self._bulk or len(self._layouts) >= MOST_LAYOUTS:
            return None
        try:
            layout = Layout(payload, self._leaves)
        except ValueError:  # rosbags reports the fault when the message is used
            return None
        self._layouts[layout] = []
        return layout

    def _give(self, layout: Layout, rows: NDArray[np.void], places: Integers) -> tuple[NDArray[np.void], Integers]:
        """Give `layout` the rows that match it; the others are returned."""
        same = layout.matches(rows)
        if same.all():
            self._layouts[layout].append((rows, places))
            return rows[:0], places[:0]
        if same.any():
            self._layouts[layout].append((rows[same], places[same]))
        return rows[~same], places[~same]


def read_topics(path: str | Path, topics: Iterable[str] | None = None) -> dict[str, TopicData]:
    """Columns of every topic of the recording at `path`, or of `topics` only (as spelt in the recording).

    Raises DataError when there is no recording, a topic is not in it, or its messages cannot be decoded.
    """
    if topics is None:
        return collect(Bag(path))[0]
    wanted = set(topics)
    found, types = collect(Bag(path), lambda channel: channel.topic in wanted)
    if absent := sorted(wanted - set(found)):
        raise DataError(f"{path}: {unknown_name('topic', absent[0], types)}")
    return found


def collect(
    bag: Bag, wanted: Callable[[Channel], bool] = lambda channel: True
) -> tuple[dict[str, TopicData], dict[str, str]]:
    """Columns of the topics of `bag` that are `wanted`, and the types of all topics that have messages."""
    collectors: dict[str, Collector] = {}
    types: dict[str, str] = {}
    for block in bag.blocks():
        for channel, chosen in _by_channel(block):
            types.setdefault(channel.topic, channel.type)
            if not wanted(channel):
                continue
            if channel.topic not in collectors:
                collectors[channel.topic] = Collector(channel)
            if channel.type == types[channel.topic]:
                collectors[channel.topic].take(block, chosen)
            else:
                raise DataError(f"{channel.topic} has messages of two types: {types[channel.topic]}, {channel.type}.")
    return {topic: collector.data() for topic, collector in collectors.items()}, types


def _by_channel(block: Block) -> Iterable[tuple[Channel, Integers]]:
    """The channels of a block and the indices of their messages."""
    for number in np.unique(block.channel).tolist():
        yield block.channels[number], np.flatnonzero(block.channel == number)
