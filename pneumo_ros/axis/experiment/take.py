"""One recorded trial: the bag it goes to, and which messages belong to it."""

import time
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from pneumo_ros.records import BagTopic, BagWriter


class Entry(NamedTuple):
    """A message to be recorded; times in ns."""

    stamp: int  # by which it belongs to a trial
    log_time: int
    received: int  # on the system clock
    topic: str
    payload: bytes


@dataclass
class Take:
    """Messages stamped from `begin` on and before `end`, once that is known [ns], go into the bag `path`."""

    path: Path
    begin: int
    end: int | None = None
    writer: BagWriter | None = None
    _ended: float = 0.0  # when `end` became known, on the monotonic clock [s]

    def finish(self, stamp: int) -> None:
        """End it before this stamp [ns], unless its end is known already."""
        if self.end is None:
            self.end, self._ended = stamp, time.monotonic()

    def over(self, seconds: float) -> bool:
        """Whether its end has been known for longer than `seconds`."""
        return self.end is not None and time.monotonic() - self._ended > seconds

    def wants(self, entry: Entry) -> bool:
        """Whether the message belongs to this trial."""
        return entry.stamp >= self.begin and (self.end is None or entry.stamp < self.end)

    def write(self, entry: Entry, topic: BagTopic, first: list[Entry], known: dict[str, BagTopic]) -> None:
        """Record a message; the bag is made for the first one, and begins with `first`, whose topics are `known`.

        Raises DataError when the disk fails or the bag exists.
        """
        if self.writer is None:
            self.writer = BagWriter(self.path)
            for one in first:
                self._put(one._replace(log_time=entry.log_time), known[one.topic])
        self._put(entry, topic)

    def _put(self, entry: Entry, topic: BagTopic) -> None:
        assert self.writer is not None
        self.writer.add_topic(topic)
        self.writer.write(entry.topic, entry.log_time, entry.payload)

    def close(self) -> None:
        """End the bag. Raises DataError when the disk fails."""
        if self.writer is not None:
            self.writer.close()
