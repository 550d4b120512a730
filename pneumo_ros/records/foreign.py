"""Storage formats read by rosbags: sqlite3, and folders whose files or messages are compressed one by one."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinitionFormat, QosDurability
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.reader import DirectoryReader

from pneumo_ros.errors import DataError
from pneumo_ros.records.block import Block, Channel

BATCH = 16384  # messages per block

_FORMATS = {
    MessageDefinitionFormat.MSG: "ros2msg",
    MessageDefinitionFormat.IDL: "ros2idl",
    MessageDefinitionFormat.NONE: "",
}


class ForeignBag:
    """Reads a folder or a `.db3` file through rosbags; the same interface as `McapFile`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.channels: dict[int, Channel] = {}
        self.warnings: list[str] = []

    def blocks(self) -> Iterator[Block]:
        """Messages in the order of their recorded time. Raises DataError when rosbags cannot read the storage."""
        try:
            with Reader(self.path) as reader:
                _agree(reader)
                self.channels.update({one.id: _describe(one) for one in reader.connections})
                messages = reader.messages()
                while batch := list(islice(messages, BATCH)):
                    yield self._block(batch)
        except DataError:
            raise
        except Exception as error:  # rosbags passes on the exceptions of the database library
            raise DataError(f"Cannot read {self.path}: {error}") from error

    def _block(self, batch: list[tuple[Connection, int, bytes]]) -> Block:
        """The messages of one batch, their payloads joined."""
        length = np.array([len(payload) for _, _, payload in batch], dtype=np.int64)
        return Block(
            b"".join(payload for _, _, payload in batch),
            self.channels,
            np.array([connection.id for connection, _, _ in batch], dtype=np.int64),
            np.array([time for _, time, _ in batch], dtype=np.int64),
            np.cumsum(length) - length,
            length,
        )


def _agree(reader: Reader) -> None:
    """Give the topics of every file what the folder's metadata say of them.

    rosbags passes over topics whose quality of service, or hash of the type, is another one in the file. They differ
    after a conversion or an edit, and where a recorder writes the two in other words.
    """
    if not isinstance(folder := reader.storage, DirectoryReader):
        return
    listed = {(one.topic, one.msgtype): one for one in folder.connections}
    for storage in folder.storages:
        for index, one in enumerate(storage.connections):
            if known := listed.get((one.topic, one.msgtype)):
                storage.connections[index] = one._replace(ext=known.ext, digest=known.digest)


def _describe(connection: Connection) -> Channel:
    """What rosbags knows of a connection."""
    extra = connection.ext
    if not isinstance(extra, ConnectionExtRosbag2):
        raise DataError(f"{connection.topic} comes from a ROS 1 recording; convert it with `rosbags-convert` first.")
    return Channel(
        connection.topic,
        connection.msgtype,
        extra.serialization_format,
        _FORMATS[connection.msgdef.format],
        connection.msgdef.data,
        any(one.durability == QosDurability.TRANSIENT_LOCAL for one in extra.offered_qos_profiles),
    )
