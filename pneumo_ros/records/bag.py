"""A recording on disk, of any storage format: its messages in blocks, or one by one in recorded time."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.records.block import Block, Channel, Integers
from pneumo_ros.records.contract import LATCHED, split
from pneumo_ros.records.source import find_sources

EVER = int(np.iinfo(np.int64).min)  # ns; recorders with a broken clock have written times before 1970


class Message(NamedTuple):
    """One serialized message as it was recorded."""

    channel: Channel
    log_time: int  # [ns]
    payload: bytes


class Overview(NamedTuple):
    """Contents of a recording: times in ns; `counts`: messages per topic; `latched`: messages of latched topics."""

    start: int
    end: int
    channels: dict[str, Channel]
    counts: dict[str, int]
    latched: list[Message]


class Bag:
    """Reads the recording at `path`. Raises DataError when there is none.

    `warnings` are sentences about what could not be read; they are complete once the blocks have been consumed.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._sources, self.warnings = find_sources(self.path)
        self._earliest: list[int] = []  # time of each block, once known

    def blocks(self) -> Iterator[Block]:
        """Blocks with at least one message, in the order of the files; can be called again."""
        self._sources, self.warnings = find_sources(self.path)
        for source in self._sources:
            yield from (block for block in source.blocks() if len(block.channel))
            self.warnings += source.warnings

    def overview(self) -> Overview:
        """Topics, counts and times; reads everything once. Raises DataError when there is no message."""
        seen = Overview(0, 0, {}, {}, [])
        first, last = [], []
        for block in self.blocks():
            first.append(int(block.log_time.min()))
            last.append(int(block.log_time.max()))
            _survey(block, seen)
        if not first:
            raise DataError(" ".join([f"{self.path} holds no messages.", *self.warnings]))
        self._earliest = first
        seen.latched.sort(key=lambda message: message.log_time)
        return seen._replace(start=min(first), end=max(last))

    def messages(self, since: int = EVER) -> Iterator[Message]:
        """Every message in the order of recorded time, then of the file; only a few blocks are in memory.

        Messages recorded before `since` [ns] are left out.
        """
        earliest = self._earliest or [int(block.log_time.min()) for block in self.blocks()]
        # No message after block k is earlier than this; files and chunks may overlap.
        horizons = np.minimum.accumulate(np.array([*earliest, np.iinfo(np.int64).max])[::-1])[::-1][1:]
        waiting: list[tuple[int, Block, int]] = []
        for block, horizon in zip(self.blocks(), horizons.tolist(), strict=False):  # the file may have grown since
            order: Integers = np.argsort(block.log_time, kind="stable")
            order = order[block.log_time[order] >= since]
            times = block.log_time[order].tolist()
            waiting += zip(times, [block] * len(times), order.tolist(), strict=True)
            waiting.sort(key=lambda entry: entry[0])
            ready = 0
            for time, origin, index in waiting:
                if time > horizon:
                    break
                yield Message(origin.channels[int(origin.channel[index])], time, origin.payload(index))
                ready += 1
            del waiting[:ready]


def _survey(block: Block, seen: Overview) -> None:
    """Add a block's channels, counts and latched messages to `seen`."""
    numbers, amounts = np.unique(block.channel, return_counts=True)
    for number, amount in zip(numbers.tolist(), amounts.tolist(), strict=True):
        channel = block.channels[number]
        seen.channels.setdefault(channel.topic, channel)
        seen.counts[channel.topic] = seen.counts.get(channel.topic, 0) + amount
        if is_latched(channel):
            chosen = np.flatnonzero(block.channel == number).tolist()
            seen.latched.extend(Message(channel, int(block.log_time[i]), block.payload(i)) for i in chosen)


def is_latched(channel: Channel) -> bool:
    """Whether a topic was latched, or should have been by the contract."""
    found = split(channel.topic)
    return channel.latched or (found is not None and found[1] in LATCHED)
