"""Layout of a serialized message, learnt from one message, so that many are decoded at once.

Two messages share a layout when they have the same length and agree in every byte that is neither a number nor padding:
lengths of sequences, lengths and characters of strings. The numbers are then columns of a numpy structured array.

CDR: OMG Common Data Representation, formal/02-06-51, section 9.3: numbers are aligned to their own size, counted from
the end of the four bytes of encapsulation; a sequence is its length (uint32) and its elements; a string is its length
with the terminating zero, and its characters.
"""

import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from pneumo_ros.errors import DataError
from pneumo_ros.records.message_types import ENCAPSULATION

NUMBERS = {
    "bool": "?", "byte": "i1", "char": "u1", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4",
    "uint32": "u4", "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip


class Leaf(NamedTuple):
    """One field of a message type, nested names joined by dots."""

    path: str
    base: str  # a key of NUMBERS, "string", or "message" for everything that cannot be decoded in bulk
    size: int | None  # elements of a fixed array; None for a single value
    sequence: bool

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of one value; for a sequence, the shape of an empty one."""
        return (0,) if self.sequence else () if self.size is None else (self.size,)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the column, in native byte order."""
        return np.dtype(NUMBERS.get(self.base, "O"))


def leaves(store: Typestore, message_type: str, prefix: str = "") -> list[Leaf]:
    """Fields of `message_type` in the order of the definition, those of nested messages in place.

    Raises DataError when the definition names a type that is not defined.
    """
    if message_type not in store.fielddefs:
        raise DataError(f"A message definition uses the type {message_type} and does not define it.")
    found: list[Leaf] = []
    definition: list[tuple[str, tuple[Nodetype, Any]]] = store.fielddefs[message_type][1]  # type: ignore[assignment]
    for name, (node, content) in definition:  # rosbags' type of a definition is too general to check
        if node == Nodetype.NAME:
            found += leaves(store, content, f"{prefix}{name}.")
        elif node == Nodetype.BASE:
            found.append(_leaf(prefix + name, content[0], None, False))
        else:
            (inner, base), count = content
            kind = base[0] if inner == Nodetype.BASE else "message"
            found.append(_leaf(prefix + name, kind, count, node == Nodetype.SEQUENCE))
    return found


def _leaf(path: str, base: str, size: int | None, sequence: bool) -> Leaf:
    known = base in NUMBERS or base == "string"
    return Leaf(path, base if known else "message", None if sequence else size, sequence)


class Layout:
    """Offsets of the numbers, and the bytes every message of this layout has in common."""

    def __init__(self, payload: bytes, fields: list[Leaf]) -> None:
        """Learn from one message; `fields` hold no arrays of messages. Raises ValueError when it does not fit them.

        Extra bytes at its end, which ROS's own serialisation may leave, are ignored.
        """
        self.length = len(payload)
        self.texts: dict[str, Any] = {}
        self._payload = payload
        self._order = _byte_order(payload)
        self._fixed = bytearray(self.length)
        self._fixed[:2] = b"\1\1"
        self._position = ENCAPSULATION
        names: list[tuple[str, str, tuple[int, ...], int]] = []
        for field in fields:
            names += self._text(field) if field.base == "string" else self._number(field)
        self.dtype = np.dtype(
            {
                "names": [name for name, _, _, _ in names],
                "formats": [(self._order + kind, shape) for _, kind, shape, _ in names],
                "offsets": [offset for _, _, _, offset in names],
                "itemsize": self.length,
            }
        )
        self._words = _words(self._fixed, payload)

    def matches(self, rows: NDArray[np.void]) -> NDArray[np.bool_]:
        """Which of `rows`, void items of this length, have this layout."""
        same = np.ones(len(rows), dtype=bool)
        octets = rows.view(np.uint8).reshape(len(rows), self.length)
        for offset, size, value in self._words:
            same &= octets[:, offset : offset + size].view(f"<u{size}")[:, 0] == value
        return same

    def _number(self, field: Leaf) -> list[tuple[str, str, tuple[int, ...], int]]:
        """Step over the numbers of a field: name, type, shape and offset of its column."""
        kind = NUMBERS[field.base]
        size = np.dtype(kind).itemsize
        count = self._count() if field.sequence else field.size
        if count != 0:
            self._align(size)
        offset = self._position
        self._position += size * (1 if count is None else count)
        self._check()
        return [(field.path, kind, () if count is None else (count,), offset)]

    def _text(self, field: Leaf) -> list[tuple[str, str, tuple[int, ...], int]]:
        """Step over the strings of a field, whose characters are part of the layout; it has no column of numbers."""
        count = self._count() if field.sequence else field.size
        if count is None:
            self.texts[field.path] = self._string()
        else:
            self._check(5 * count)  # a string takes at least 5 bytes: a damaged count must not make a long loop
            self.texts[field.path] = tuple(self._string() for _ in range(count))
        return []

    def _string(self) -> str:
        size = self._count()
        start = self._position
        self._take(size)
        if size < 1 or self._payload[self._position - 1]:
            raise ValueError("a string does not end with zero")
        return self._payload[start : self._position - 1].decode()

    def _count(self) -> int:
        """A length, which belongs to the layout."""
        self._align(4)
        start = self._position
        self._take(4)
        (value,) = struct.unpack_from(self._order + "I", self._payload, start)
        return int(value)

    def _take(self, size: int) -> None:
        """Mark the next `size` bytes as common to all messages of the layout."""
        self._check(size)
        self._fixed[self._position : self._position + size] = b"\1" * size
        self._position += size

    def _align(self, size: int) -> None:
        self._position += -(self._position - ENCAPSULATION) % size

    def _check(self, size: int = 0) -> None:
        if self._position + size > self.length:
            raise ValueError(f"{self.length} bytes are too few")


def _byte_order(payload: bytes) -> str:
    """Byte order of the numbers, from the encapsulation: plain CDR, big or little endian."""
    if len(payload) < ENCAPSULATION or payload[0] or payload[1] > 1:
        raise ValueError("not plain CDR")
    return "<" if payload[1] else ">"


def _words(fixed: bytearray, payload: bytes) -> list[tuple[int, int, int]]:
    """Offset, size and value of words that cover the fixed bytes: a few comparisons per message, not one per byte."""
    words: list[tuple[int, int, int]] = []
    offset = 0
    while offset < len(fixed):
        size = next((size for size in (8, 4, 2, 1) if fixed[offset : offset + size] == b"\1" * size), 0)
        if size:
            words.append((offset, size, int.from_bytes(payload[offset : offset + size], "little")))
        offset += size or 1
    return words
