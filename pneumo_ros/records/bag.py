"""A recording on disk, whatever its storage: its messages in blocks, or one after another in recorded time."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.records.block import Block, Channel, Integers
from pneumo_ros.records.source import find_sources


class Message(NamedTuple):
    """One serialized message as it was recorded."""

    channel: Channel
    log_time: int  # [ns]
    payload: bytes


class Overview(NamedTuple):
    """What a recording holds: times in ns; `counts` are messages per topic."""

    start: int
    end: int
    channels: dict[str, Channel]
    counts: dict[str, int]


class Bag:
    """Reads the recording at `path`. Raises DataError when there is none.

    `warnings` are sentences about what could not be read; they are complete once the blocks have been consumed.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._sources, self.warnings = find_sources(self.path)

    def blocks(self) -> Iterator[Block]:
        """Blocks with at least one message, in the order of the files; may be asked for more than once."""
        self._sources, self.warnings = find_sources(self.path)
        for source in self._sources:
            yield from (block for block in source.blocks() if len(block.channel))
            self.warnings += source.warnings

    def overview(self) -> Overview:
        """Topics, counts and times; reads everything once. Raises DataError when there is no message."""
        channels: dict[str, Channel] = {}
        counts: dict[str, int] = {}
        first, last = [], []
        for block in self.blocks():
            first.append(int(block.log_time.min()))
            last.append(int(block.log_time.max()))
            numbers, amounts = np.unique(block.channel, return_counts=True)
            for number, amount in zip(numbers.tolist(), amounts.tolist(), strict=True):
                channel = block.channels[number]
                channels.setdefault(channel.topic, channel)
                counts[channel.topic] = counts.get(channel.topic, 0) + amount
        if not first:
            raise DataError(" ".join([f"{self.path} holds no messages.", *self.warnings]))
        return Overview(min(first), max(last), channels, counts)

    def messages(self) -> Iterator[Message]:
        """Every message in recorded time, those of equal times in the order of the file; a few blocks in memory."""
        earliest = [int(block.log_time.min()) for block in self.blocks()]
        # After block k nothing earlier than this can follow: files and chunks may overlap.
        horizons = np.minimum.accumulate(np.array([*earliest, np.iinfo(np.int64).max])[::-1])[::-1][1:]
        waiting: list[tuple[int, Block, int]] = []
        for block, horizon in zip(self.blocks(), horizons.tolist(), strict=True):
            order: Integers = np.argsort(block.log_time, kind="stable")
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
