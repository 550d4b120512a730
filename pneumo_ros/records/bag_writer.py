"""Writes serialized messages into a rosbag2 folder that is valid at any time."""

import time
from collections.abc import Iterable
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import IO, Any, cast

from mcap.writer import Writer

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.growing_file import GrowingFile
from pneumo_ros.records.mcap_registry import LIBRARY
from pneumo_ros.records.message_types import definition_of
from pneumo_ros.records.metadata import BagTopic, Contents, as_yaml, information, write_metadata

FLUSH = 0.5  # [s] between chunks: a killed recorder loses no more
DESCRIBE = 1.0  # [s] between two updates of metadata.yaml


class BagWriter:
    """Writes a new rosbag2 folder with one MCAP file, zstd compressed. A context manager.

    Messages reach the disk twice a second if `write` or `flush_if_due` is called at least that often; other readers
    accept the file at any time. `kill -9` then costs the last half second at most.
    """

    def __init__(self, path: str | Path, topics: Iterable[BagTopic] = ()) -> None:
        """Create the folder. Raises DataError when `path` exists or cannot be written, UsageError for unknown types."""
        self.path = Path(path)
        self.counts: dict[str, int] = {}  # messages per topic
        self._topics: dict[str, tuple[BagTopic, str, int]] = {}  # by name, with the hash of the type and the channel
        self._schemas: dict[str, int] = {}
        self._span: tuple[int, int] | None = None
        self._due = self._describe_due = 0.0
        self._waiting = 0  # messages since the last flush
        self._closed = False
        check_new(self.path)
        self._name = f"{self.path.resolve().name}_0.mcap"
        self._file = self._create()
        self._writer = Writer(cast("IO[bytes]", self._file))
        self._writer.start(profile="ros2", library=LIBRARY)
        for topic in topics:
            self.add_topic(topic)
        self.flush()

    def add_topic(self, topic: BagTopic) -> None:
        """Register `topic`. Raises UsageError for a type without definition, or a topic of another type."""
        if topic.name in self._topics:
            known = self._topics[topic.name][0].type
            if known != topic.type:
                raise UsageError(f"{topic.name} is recorded as {known}; it cannot also be {topic.type}.")
            return
        definition, type_hash = definition_of(topic.type, topic.definition)
        if topic.type not in self._schemas:
            self._schemas[topic.type] = self._writer.register_schema(topic.type, "ros2msg", definition.encode())
        channel = self._writer.register_channel(
            topic.name,
            "cdr",
            self._schemas[topic.type],
            {"offered_qos_profiles": as_yaml(topic.profiles()), "topic_type_hash": type_hash},
        )
        self._topics[topic.name] = (topic, type_hash, channel)
        self.counts[topic.name] = 0

    def write(self, topic: str, log_time: int, payload: bytes, publish_time: int | None = None) -> None:
        """Add CDR bytes, times in ns. Raises UsageError for an unknown topic, DataError when the disk fails."""
        if topic not in self._topics:
            raise UsageError(unknown_name("topic", topic, self._topics))
        channel = self._topics[topic][2]
        self._writer.add_message(channel, log_time, payload, log_time if publish_time is None else publish_time)
        self.counts[topic] += 1
        self._waiting += 1
        first, last = self._span or (log_time, log_time)
        self._span = (min(first, log_time), max(last, log_time))
        self.flush_if_due()

    def flush_if_due(self) -> None:
        """Flush when the last flush was half a second ago. Raises DataError when the disk is full."""
        if time.monotonic() >= self._due:
            self.flush()

    def flush(self) -> None:
        """Write everything to the disk now. Raises DataError when the disk is full."""
        self._due = time.monotonic() + FLUSH
        try:
            self._writer.flush()  # type: ignore[no-untyped-call]  # mcap annotates only some of its methods
            self._waiting = 0
            self._describe()
        except OSError as error:
            raise self._failed(error) from error

    def close(self) -> None:
        """Write the index and the end of the file. Raises DataError when the disk is full. Further calls do nothing."""
        if self._closed:
            return
        self._closed = True
        try:
            self._writer.add_metadata("rosbag2", {"serialized_metadata": as_yaml(self._information())})
            self._writer.finish()  # type: ignore[no-untyped-call]  # likewise
            self._file.close()
            write_metadata(self.path, self._information())
        except OSError as error:
            raise self._failed(error) from error

    def __enter__(self) -> "BagWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _create(self) -> GrowingFile:
        try:
            self.path.mkdir(parents=True)
            return GrowingFile(self.path / self._name)
        except OSError as error:
            raise self._failed(error) from error

    def _describe(self) -> None:
        """Rewrite metadata.yaml when it is a second old."""
        if time.monotonic() >= self._describe_due:
            self._describe_due = time.monotonic() + DESCRIBE
            write_metadata(self.path, self._information())

    def _information(self) -> dict[str, Any]:
        topics = [(topic, type_hash, self.counts[name]) for name, (topic, type_hash, _) in self._topics.items()]
        first, last = self._span or (None, None)
        return information(Contents(self._name, topics, first, last))

    def _failed(self, error: OSError) -> DataError:
        lost = f" The last {self._waiting} messages are lost; earlier ones are saved." if self._waiting else ""
        return DataError(f"Cannot write {self.path}: {error.strerror}.{lost}")


def check_new(path: Path) -> None:
    """Raises DataError when `path` exists: no recording is ever overwritten."""
    if path.exists():
        free = next(other for number in count(2) if not (other := path.with_name(f"{path.name}_{number}")).exists())
        raise DataError(f"{path} exists and is not overwritten. Choose another name, for example {free}")
