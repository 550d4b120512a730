"""Damaged bytes of a file: flipped bits, lost, doubled or swapped pieces, extreme numbers."""

import struct
from collections.abc import Callable, Sequence
from random import Random

from hypothesis import strategies as st

EXTREME = [
    *(struct.pack("<B", n) for n in (0, 1, 0x7F, 0x80, 0xFF)),
    *(struct.pack("<I", n) for n in (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1 << 20)),
    *(struct.pack("<Q", n) for n in (0, 1, (1 << 63) - 1, 1 << 63, (1 << 64) - 1, 1 << 32)),
    *(struct.pack("<d", x) for x in (float("nan"), float("inf"), -0.0, 1e308, 5e-324)),
]  # lengths, counts, times and values at the limits of their type
WORDS = [
    b"nan", b".inf", b"-1", b"1e999", b"9" * 400, b"~", b"[]", b"{}", b"&a [*a]", b"\xff\xfe", b"\0", b"\n", b":",
    b"- ", b"!!python/object/apply:os.system [touch canary]", b"!!python/name:os.system", b"2001-99-99", b"0x",
    b"<<: *a", b"[" * 2000, b'{"a":' * 2000, b"'", b'"', b",", b"\xe2\x80\xae", b"0:0:0:60", b"!!binary x",
    b"!!timestamp x",
]  # fmt: skip
DRAWS = st.integers(0, 2**32 - 1)


def mutated(seeds: Sequence[bytes], most: int = 6) -> st.SearchStrategy[bytes]:
    """One of `seeds` after 1 to `most` random changes; the same draw is always the same bytes."""
    return st.builds(lambda data, *change: mutate(data, *change), one_of(seeds), st.integers(1, most), DRAWS)


def one_of(files: Sequence[bytes]) -> st.SearchStrategy[bytes]:
    """One of `files`, by number: a strategy with the contents would print them after a failure."""
    return st.integers(0, len(files) - 1).map(lambda number: files[number])


def mutate(data: bytes, changes: int, seed: int) -> bytes:
    """`data` after so many changes, drawn by `seed`."""
    random = Random(seed)
    content = bytearray(data)
    for _ in range(changes):
        random.choice(CHANGES)(content, random)
    return bytes(content)


def _place(content: bytearray, random: Random) -> int:
    return random.randrange(len(content) + 1)


def _piece(content: bytearray, random: Random) -> slice:
    start = _place(content, random)
    return slice(start, start + random.choice((1, 2, 4, 8, 40, 400, 4000)))


def _flip(content: bytearray, random: Random) -> None:
    if content:
        content[random.randrange(len(content))] ^= 1 << random.randrange(8)


def _lose(content: bytearray, random: Random) -> None:
    del content[_piece(content, random)]


def _double(content: bytearray, random: Random) -> None:
    piece = content[_piece(content, random)]
    at = _place(content, random)
    content[at:at] = piece


def _move(content: bytearray, random: Random) -> None:
    where = _piece(content, random)
    piece = content[where]
    del content[where]
    at = _place(content, random)
    content[at:at] = piece


def _overwrite(content: bytearray, random: Random) -> None:
    at, value = _place(content, random), random.choice(EXTREME)
    content[at : at + len(value)] = value


def _say(content: bytearray, random: Random) -> None:
    at, word = _place(content, random), random.choice(WORDS)
    content[at : at + random.choice((0, 0, len(word)))] = word


def _cut(content: bytearray, random: Random) -> None:
    del content[_place(content, random) :]


CHANGES: list[Callable[[bytearray, Random], None]] = [
    _flip,
    _flip,
    _lose,
    _double,
    _move,
    _overwrite,
    _overwrite,
    _say,
    _cut,
]
