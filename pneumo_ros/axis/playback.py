"""Messages of a recording in their original timing: which come first, and when each is due. No ROS."""

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain, islice

from pneumo_ros.axis.ahead import ahead
from pneumo_ros.records.bag import Bag, Message, Overview

CLOCK_PERIOD = 10_000_000  # ns of wall time between two messages on /clock


@dataclass
class Schedule:
    """Recorded time against wall time: `rate` seconds of the recording pass in one second."""

    begin: int  # recorded time that is played first [ns]
    rate: float
    origin: int = field(default_factory=time.monotonic_ns)  # when it is played

    def due(self, log_time: int) -> int:
        """When a message is due, in ns of the steady clock."""
        return self.origin + round((log_time - self.begin) / self.rate)

    def recorded(self, now: int) -> int:
        """The recorded time that is played at `now`."""
        return self.begin + round((now - self.origin) * self.rate)


class Playback:
    """Plays the recording once per call of `play`, until `stop` is set."""

    def __init__(self, bag: Bag, overview: Overview, wanted: Callable[[str], bool], rate: float, offset: float) -> None:
        """`wanted` chooses the topics by name; `rate` is recorded over real time; `offset` [s] is skipped."""
        self.stop = threading.Event()
        self.sent = 0
        self.behind = 0  # ns, largest delay of a message
        self.position = self.begin = overview.start + round(offset * 1e9)
        self._bag, self._wanted, self._rate = bag, wanted, rate
        self._first = [one for one in standing(overview.latched, self.begin) if wanted(one.channel.topic)]

    def play(self, send: Callable[[Message], None], tick: Callable[[int], None] | None) -> None:
        """Hand every message to `send` when it is due, and the recorded time [ns] to `tick` a hundred times a second.

        The last message of each latched topic before the begin, or the first after it, comes at once.
        """
        rest = self._rest()
        following = list(islice(rest, 1))  # the clock starts after the first message is read
        if tick:
            tick(self.begin)
        for message in self._first:
            self._send(message, send)
        schedule = Schedule(self.begin, self._rate)
        next_tick = schedule.origin + CLOCK_PERIOD
        for message in chain(following, rest):
            due = schedule.due(message.log_time)
            while tick and next_tick <= due and not self._sleep_until(next_tick):
                tick(schedule.recorded(next_tick))
                next_tick += CLOCK_PERIOD
            if self._sleep_until(due):
                return
            self._send(message, send)
            self.position = message.log_time
            self.behind = max(self.behind, time.monotonic_ns() - due)

    def _rest(self) -> Iterator[Message]:
        """Messages after the begin, without those that came at once."""
        early = {(one.channel.topic, one.log_time) for one in self._first}
        for message in ahead(self._bag.messages(self.begin)):
            at_once = message.channel.topic, message.log_time
            if at_once in early:
                early.discard(at_once)
            elif self._wanted(message.channel.topic):
                yield message

    def _send(self, message: Message, send: Callable[[Message], None]) -> None:
        send(message)
        self.sent += 1

    def _sleep_until(self, due: int) -> bool:
        """Wait for the time `due`; true when the playback was stopped."""
        remaining = due - time.monotonic_ns()
        return self.stop.wait(remaining * 1e-9) if remaining > 0 else self.stop.is_set()


def standing(latched: Iterable[Message], begin: int) -> list[Message]:
    """The message of each latched topic that holds at `begin`: its last one until then, else its first one."""
    found: dict[str, Message] = {}
    for message in latched:  # in recorded time
        if message.channel.topic not in found or message.log_time <= begin:
            found[message.channel.topic] = message
    return list(found.values())
