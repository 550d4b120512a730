"""The common form of all storage formats: blocks of serialized messages, and their channels."""

from mmap import mmap
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Buffer = bytes | memoryview | mmap
Integers = NDArray[np.int64]


class Channel(NamedTuple):
    """Where a message was published, and how to read its bytes."""

    topic: str
    type: str
    encoding: str  # of the messages: "cdr" in everything ROS 2 writes
    definition_format: str  # "ros2msg", "ros2idl", or "" when the recording has no definition
    definition: str
    latched: bool  # offered as transient local: a late subscriber still got the last message


class Block(NamedTuple):
    """Messages in one buffer, in the order of the file; all arrays have one entry per message."""

    data: Buffer
    channels: dict[int, Channel]
    channel: Integers
    log_time: Integers  # [ns] when the message was recorded
    start: Integers  # where its payload starts in `data`
    length: Integers

    def payload(self, index: int) -> bytes:
        """Bytes of message `index`."""
        first = int(self.start[index])
        return bytes(self.data[first : first + int(self.length[index])])


def gather(data: Buffer, starts: Integers, width: int) -> NDArray[np.void]:
    """Copy of the `width` bytes at each of `starts`, as one void item each: shape (len(starts),)."""
    if not len(starts):
        return np.empty(0, dtype=f"V{width}")
    # One overlapping window per byte of the buffer: numpy then copies whole messages at a time.
    windows: NDArray[np.void] = np.ndarray((len(data) - width + 1,), dtype=f"V{width}", buffer=data, strides=(1,))
    messages: NDArray[np.void] = windows[starts]
    return messages
