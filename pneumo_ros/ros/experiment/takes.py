"""Records the trials of an experiment, each into a bag of its own, in a thread that never delays a command."""

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

from pneumo_ros.axis.experiment.take import Entry, Take
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.records import BagTopic, contract
from pneumo_ros.records.contract import COMMAND, DESCRIPTION, JOINT_STATES, PRESSURE_A, PRESSURE_B, SUPPLY_PRESSURE
from pneumo_ros.ros import readers
from pneumo_ros.ros.intake import Intake, Taken
from pneumo_ros.ros.message_classes import definition
from pneumo_ros.ros.node import AxisNode

LOOK = 0.01  # s between two looks into the queues
HOLD = 0.2  # s a message waits, until the limits of the trial are known and messages can be sorted by time

STAMPED = (JOINT_STATES, PRESSURE_A, PRESSURE_B, SUPPLY_PRESSURE)


class Takes:
    """Subscribes to the plant's topics; between `begin` and `end` they go into a bag, with the conductor's commands.

    `heard`: when the last message of each topic was taken [s, monotonic]. Messages are queued, so that no sender
    waits for a disk.
    """

    def __init__(self, node: AxisNode, folder: Path, failed: Callable[[PneumoError], None]) -> None:
        """`failed` is called, in the thread, when a pressure is not finite or the disk fails."""
        self.folder, self.heard = folder, dict[str, float]()
        self.simulated = False  # whether stamps are simulated time; recordings then use it
        self._failed = failed
        self._names = {str(node.resolve_topic_name(name)): name for name in (*STAMPED, COMMAND, DESCRIPTION)}
        self._topics = {topic: _topic(topic, name) for topic, name in self._names.items()}
        self._command = str(node.resolve_topic_name(COMMAND))
        self._intake = Intake(node)
        for topic, name in self._names.items():
            if name != COMMAND:
                self._intake.subscribe(topic, contract.TYPES[name], name == DESCRIPTION)
        self._marks: deque[tuple[str, int]] = deque()  # name of a trial and its first stamp; no name and its end
        self._sent: deque[Entry] = deque()
        self._takes: list[Take] = []
        self._held: list[Entry] = []
        self._description: list[Entry] = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._work, name="takes", daemon=True)
        self._thread.start()

    # --- calls of the conductor ---------------------------------------------------------------------------------------

    def begin(self, name: str, stamp: int) -> None:
        """A trial begins with the sample of this stamp [ns]."""
        self._marks.append((name, stamp))

    def end(self, stamp: int) -> None:
        """The trial under way, if any, ends before the sample of this stamp [ns]."""
        self._marks.append(("", stamp))

    def command(self, stamp: int, payload: bytes) -> None:
        """A command was sent just now, in answer to the sample of this stamp [ns]."""
        now = time.time_ns()
        self._sent.append(Entry(stamp, stamp if self.simulated else now, now, self._command, payload))

    @property
    def lost(self) -> int:
        """How many messages never arrived."""
        return sum(self._intake.lost.values())

    def close(self) -> None:
        """Write what has arrived, close every bag, end the thread. Raises DataError when the disk fails."""
        self._stop.set()
        self._thread.join()
        try:
            self._hear()
            self._write(self._held)
            for take in self._takes:
                take.close()
        finally:
            self._intake.close()

    # --- the thread ---------------------------------------------------------------------------------------------------

    def _work(self) -> None:
        try:
            while not self._stop.wait(LOOK):
                self._look()
        except PneumoError as error:
            self._held.clear()
            self._failed(error)

    def _look(self) -> None:
        self._hear()
        horizon = time.time_ns() - int(HOLD * 1e9)
        ready = [one for one in self._held if one.received <= horizon]
        self._held = [one for one in self._held if one.received > horizon]
        self._write(ready)
        for take in [one for one in self._takes if one.over(2.0 * HOLD)]:
            take.close()
            self._takes.remove(take)

    def _hear(self) -> None:
        """Take over the calls of the conductor and the messages that have arrived."""
        while self._marks:
            name, stamp = self._marks.popleft()
            if name:
                self._takes.append(Take(self.folder / name, stamp))
            else:
                for take in self._takes:
                    take.finish(stamp)
        while self._sent:
            self._held.append(self._sent.popleft())
        self._sort_in(self._intake.take())

    def _sort_in(self, taken: list[Taken]) -> None:
        """Keep arrived messages; a pressure that is not finite is recorded, too, but ends the experiment."""
        for one in taken:
            name = self._names[one.topic]
            self.heard[name] = time.monotonic()
            if name == DESCRIPTION:
                self._description = [Entry(0, 0, one.received, one.topic, one.payload)]
                continue
            if name != JOINT_STATES and not math.isfinite(pressure := readers.pressure(one.payload)):
                self._failed(DataError(f"{one.topic} is {pressure}; check the sensor"))
            stamp = readers.stamp_of(one.payload, contract.TYPES[name]) or one.received
            log_time = stamp if self.simulated else one.received
            self._held.append(Entry(stamp, log_time, one.received, one.topic, one.payload))

    def _write(self, entries: list[Entry]) -> None:
        for entry in sorted(entries, key=lambda one: one.log_time):
            for take in self._takes:
                if take.wants(entry):
                    take.write(entry, self._topics[entry.topic], self._description, self._topics)


def _topic(topic: str, name: str) -> BagTopic:
    """How a topic of the contract is recorded."""
    kind = contract.TYPES[name]
    return BagTopic(topic, kind, name == DESCRIPTION, True, definition(kind))
