"""One MCAP file as blocks of messages, as far as it can be read: a recorder may have been killed while writing.

Format: https://mcap.dev/spec. The records are parsed here: `mcap.reader` needs a complete file, and
`mcap.stream_reader` makes an object of every message.
"""

import struct
import zlib
from collections.abc import Iterator
from mmap import ACCESS_READ, mmap
from pathlib import Path

import numpy as np
from mcap.opcode import Opcode

from pneumo_ros.errors import DataError
from pneumo_ros.records.block import Block, Buffer, Channel, Integers, gather
from pneumo_ros.records.compression import decompress
from pneumo_ros.records.mcap_registry import Registry

MAGIC = b"\x89MCAP0\r\n"
LOOSE_MESSAGES = 65536  # messages outside chunks that make one block

_PREFIX = struct.Struct("<BQ")  # of every record: opcode, length
_LENGTH = struct.Struct("<Q")
_CHUNK = struct.Struct("<QQQII")  # start and end time, size and CRC of the content, length of the compression's name
_MESSAGE = np.dtype(
    [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4"), ("log", "<i8"), ("publish", "<i8")]
)
_LEAST = _MESSAGE.itemsize - _PREFIX.size  # length of a message record without payload


class McapFile:
    """Reads one MCAP file once, from front to back; `channels` and `warnings` are filled while `blocks` is consumed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.warnings: list[str] = []
        self._registry = Registry()
        self._damaged = 0  # chunks
        self._data = _open(path)

    @property
    def channels(self) -> dict[int, Channel]:
        """Channels found so far, by their number in messages."""
        return self._registry.channels

    def blocks(self) -> Iterator[Block]:
        """Messages of every readable chunk, and those outside chunks, in the order of the file."""
        loose: list[int] = []
        end, closed = len(MAGIC), False
        for opcode, start, end in self._records():
            if opcode == Opcode.CHUNK:
                yield from self._chunk(start, min(end, len(self._data)))
            elif opcode == Opcode.MESSAGE:
                loose.append(start - _PREFIX.size)
            else:
                self._registry.take(opcode, self._data[start:end])
                closed = opcode == Opcode.FOOTER
            if len(loose) >= LOOSE_MESSAGES:
                yield self._block(self._data, np.array(loose))
                loose.clear()
        if loose:
            yield self._block(self._data, np.array(loose))
        self._report(closed, min(end, len(self._data)))

    def _records(self) -> Iterator[tuple[int, int, int]]:
        """Opcode, start and end of the body of each record up to the footer or a break; a chunk may be cut."""
        position, size = len(MAGIC), len(self._data)
        opcode = -1
        while opcode != Opcode.FOOTER and position + _PREFIX.size <= size:
            opcode, length = _PREFIX.unpack_from(self._data, position)
            start = position + _PREFIX.size
            position = start + length
            if opcode == 0 or (position > size and opcode != Opcode.CHUNK):
                return
            yield opcode, start, position

    def _report(self, closed: bool, read: int) -> None:
        """Add warnings about the parts that could not be read."""
        if not closed:
            self.warnings.append(
                f"{self.path.name} breaks off after {read} bytes without its end record: its recorder was killed "
                "or the file was cut. Everything up to the break is read."
            )
        if self._registry.unfinished:
            self.warnings.append(
                f"{self.path.name}: its recorder was killed before it could close the file; "
                "up to the last second may be missing."
            )
        if damaged := self._damaged + self._registry.unreadable:
            parts = "1 part is" if damaged == 1 else f"{damaged} parts are"
            self.warnings.append(f"{self.path.name}: {parts} damaged; only their intact messages are read.")

    def _chunk(self, start: int, stop: int) -> Iterator[Block]:
        """The messages of the chunk record whose body is at `start`; `stop` is where the record or the file ends."""
        if start + _CHUNK.size > stop:
            return
        _, _, size, checksum, letters = _CHUNK.unpack_from(self._data, start)
        name = start + _CHUNK.size
        content = name + letters + _LENGTH.size
        if content > stop:
            return
        compression = bytes(self._data[name : name + letters]).decode(errors="replace")
        (packed,) = _LENGTH.unpack_from(self._data, name + letters)
        with memoryview(self._data) as view, view[content : min(content + packed, stop)] as given:
            data = decompress(given, compression, size, self.path)
        whole = len(data) == size
        if content + packed <= stop and not (whole and (not checksum or zlib.crc32(data) == checksum)):
            self._damaged += 1
            if whole:  # the place of the damage is unknown
                return
        yield self._block(data, self._walk(data))

    def _walk(self, data: bytes) -> Integers:
        """Positions of the complete message records of a chunk; its other records go to the registry."""
        positions: list[int] = []
        found, length_at = positions.append, _LENGTH.unpack_from
        position, last = 0, len(data) - _PREFIX.size
        while position <= last:
            found(position)
            position += _PREFIX.size + length_at(data, position + 1)[0]
        if position > len(data):  # the last record is cut
            positions.pop()
        starts = np.array(positions, dtype=np.int64)
        is_message = gather(data, starts, 1).view(np.uint8) == Opcode.MESSAGE
        for start in starts[~is_message].tolist():
            opcode, length = _PREFIX.unpack_from(data, start)
            self._registry.take(opcode, data[start + _PREFIX.size : start + _PREFIX.size + length])
        messages: Integers = starts[is_message]
        return messages

    def _block(self, data: Buffer, positions: Integers) -> Block:
        """Block of the message records at `positions`."""
        positions = positions[positions + _MESSAGE.itemsize <= len(data)]  # a damaged length may have any value
        heads = gather(data, positions, _MESSAGE.itemsize).view(_MESSAGE)
        # A message whose channel record was lost with a damaged chunk cannot be decoded.
        known = np.isin(heads["channel"], np.fromiter(self.channels, dtype=np.uint16)) & (heads["length"] >= _LEAST)
        if not known.all():
            positions, heads = positions[known], heads[known]
        return Block(
            data,
            self.channels,
            heads["channel"].astype(np.int64),
            heads["log"].astype(np.int64),
            positions + _MESSAGE.itemsize,
            heads["length"].astype(np.int64) - _LEAST,
        )


def _open(path: Path) -> mmap:
    """The file mapped into memory, after a check of its first bytes."""
    try:
        with path.open("rb") as stream:
            magic = stream.read(len(MAGIC))
            if magic == MAGIC:
                return mmap(stream.fileno(), 0, access=ACCESS_READ)
    except OSError as error:
        raise DataError(f"Cannot read {path}: {error.strerror}.") from error
    if not magic:
        raise DataError(f"{path} is empty: its recorder was killed before anything reached the disk.")
    raise DataError(f"{path} is not an MCAP file: it does not start with the MCAP signature.")
