"""One MCAP file as blocks of messages, as far as it can be read: a recorder may have been killed while it wrote.

Format: https://mcap.dev/spec. The records are walked here and not by `mcap.reader`, which needs a whole file, nor by
`mcap.stream_reader`, which makes an object of every message.
"""

import struct
import zlib
from collections.abc import Iterator
from io import BytesIO
from mmap import ACCESS_READ, mmap
from pathlib import Path

import numpy as np
import yaml
from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode

from pneumo_ros.errors import DataError
from pneumo_ros.records.block import Block, Buffer, Channel, Integers, gather
from pneumo_ros.records.compression import decompress

MAGIC = b"\x89MCAP0\r\n"
LIBRARY = "pneumo_ros"  # how files written here name their writer
LOOSE_MESSAGES = 65536  # messages outside chunks that make one block

_PREFIX = struct.Struct("<BQ")  # of every record: opcode, length
_LENGTH = struct.Struct("<Q")
_CHUNK = struct.Struct("<QQQII")  # start and end time, size and CRC of the content, length of the compression's name
_MESSAGE = np.dtype(
    [("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4"), ("log", "<i8"), ("publish", "<i8")]
)
_LEAST = _MESSAGE.itemsize - _PREFIX.size  # length of a message record without payload


class McapFile:
    """Reads one MCAP file once, from front to back; `channels` and `warnings` fill while `blocks` is consumed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.channels: dict[int, Channel] = {}
        self.warnings: list[str] = []
        self._schemas: dict[int, records.Schema] = {}
        self._damaged = 0
        self._library = ""
        self._data = _open(path)

    def blocks(self) -> Iterator[Block]:
        """Messages of every readable chunk, and those outside chunks, in the order of the file."""
        size = len(self._data)
        loose: list[int] = []
        position, closed = len(MAGIC), False
        while position + _PREFIX.size <= size and not closed:
            opcode, length = _PREFIX.unpack_from(self._data, position)
            body, following = position + _PREFIX.size, position + _PREFIX.size + length
            if opcode == 0 or (following > size and opcode != Opcode.CHUNK):
                break
            if opcode == Opcode.CHUNK:
                yield from self._chunk(body, min(following, size))
            elif opcode == Opcode.MESSAGE:
                loose.append(position)
            else:
                self._register(opcode, self._data[body:following])
                closed = opcode == Opcode.FOOTER
            if len(loose) >= LOOSE_MESSAGES:
                yield self._block(self._data, np.array(loose))
                loose.clear()
            position = following
        if loose:
            yield self._block(self._data, np.array(loose))
        self._report(closed, position)

    def _report(self, closed: bool, position: int) -> None:
        """Say in words what could not be read."""
        if not closed:
            at = min(position, len(self._data))
            self.warnings.append(
                f"{self.path.name} breaks off after {at} bytes without its end record: its recorder was killed "
                "or the file was cut. Everything up to the break is read."
            )
        if self._damaged:
            parts = "1 part is" if self._damaged == 1 else f"{self._damaged} parts are"
            self.warnings.append(f"{self.path.name}: {parts} damaged; only what is intact there is read.")

    def _chunk(self, start: int, stop: int) -> Iterator[Block]:
        """The messages of the chunk record whose body is at `start`; `stop` is where the record or the file ends."""
        if start + _CHUNK.size > stop:
            return
        _, _, size, checksum, letters = _CHUNK.unpack_from(self._data, start)
        packed_at = start + _CHUNK.size + letters + _LENGTH.size
        if packed_at > stop:
            return
        compression = bytes(self._data[start + _CHUNK.size : packed_at - _LENGTH.size]).decode(errors="replace")
        (packed,) = _LENGTH.unpack_from(self._data, packed_at - _LENGTH.size)
        complete = packed_at + packed <= stop
        with memoryview(self._data) as view, view[packed_at : min(packed_at + packed, stop)] as content:
            data = decompress(content, compression, size, self.path)
        if complete and (len(data) != size or (checksum and zlib.crc32(data) != checksum)):
            self._damaged += 1
            if len(data) == size:  # something in it is wrong and nothing tells what
                return
        yield self._block(data, self._walk(data))

    def _walk(self, data: bytes) -> Integers:
        """Positions of the whole message records of a chunk; its schemas and channels are registered."""
        positions: list[int] = []
        found, length_at = positions.append, _LENGTH.unpack_from
        position, last = 0, len(data) - _PREFIX.size
        while position <= last:
            found(position)
            position += _PREFIX.size + length_at(data, position + 1)[0]
        if position > len(data):  # the last record is cut
            positions.pop()
        starts = np.array(positions, dtype=np.int64)
        opcodes = np.frombuffer(data, dtype=np.uint8)[starts]
        for start in starts[opcodes != Opcode.MESSAGE].tolist():
            opcode, length = _PREFIX.unpack_from(data, start)
            self._register(opcode, data[start + _PREFIX.size : start + _PREFIX.size + length])
        messages: Integers = starts[opcodes == Opcode.MESSAGE]
        return messages

    def _block(self, data: Buffer, positions: Integers) -> Block:
        """Block of the message records at `positions`."""
        positions = positions[positions + _MESSAGE.itemsize <= len(data)]  # a damaged length may say anything
        heads = gather(data, positions, _MESSAGE.itemsize).view(_MESSAGE)
        # Without its channel record, lost with a damaged chunk, nobody knows what a message is.
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

    def _register(self, opcode: int, body: bytes) -> None:
        """Take note of what a record says about the messages; the other kinds are not needed."""
        stream = ReadDataStream(BytesIO(body))
        try:
            if opcode == Opcode.SCHEMA:
                schema = records.Schema.read(stream)
                self._schemas[schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = records.Channel.read(stream)
                self.channels[channel.id] = self._describe(channel)
            elif opcode == Opcode.HEADER:
                self._library = records.Header.read(stream).library
            elif opcode == Opcode.FOOTER:
                self._note_end(records.Footer.read(stream))
        except (McapError, struct.error, UnicodeDecodeError):
            self._damaged += 1

    def _note_end(self, footer: records.Footer) -> None:
        """A recorder of ours that was killed leaves a valid file, but one without a summary."""
        if self._library.startswith(LIBRARY) and footer.summary_start == 0:
            self.warnings.append(
                f"{self.path.name}: its recorder was killed before it could close the file; "
                "up to the last second may be missing."
            )

    def _describe(self, channel: records.Channel) -> Channel:
        """The channel with the words of its schema."""
        schema = self._schemas.get(channel.schema_id, records.Schema(0, b"", "", ""))
        return Channel(
            channel.topic,
            schema.name,
            channel.message_encoding,
            schema.encoding,
            schema.data.decode(errors="replace"),
            is_latched(channel.metadata.get("offered_qos_profiles", "")),
        )


def is_latched(profiles: str) -> bool:
    """Whether one of the YAML quality-of-service `profiles` is transient local (rosbag2 writes the name or a 1)."""
    try:
        offered = yaml.safe_load(profiles) or []
    except yaml.YAMLError:
        return False
    return any(isinstance(one, dict) and one.get("durability") in (1, "transient_local") for one in offered)


def _open(path: Path) -> mmap:
    """The file in memory, after a look at its first bytes."""
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
