"""Recordings for the tests: random messages of any type, written by rosbags, by mcap, or by this package."""

from functools import reduce
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Nodetype
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.LATEST)
START = 1_700_000_000_000_000_000
LETTERS = list("abcxyz_/0189 äµ€")
Messages = list[tuple[str, str, int, bytes]]  # topic, type, recorded time [ns], CDR


def random_message(kind: str, rng: np.random.Generator) -> Any:
    """A message of type `kind` with random content: lengths too, NaN and infinities among the numbers."""
    fields = {name: _value(node, rng) for name, node in STORE.fielddefs[kind][1]}
    return STORE.types[kind](**fields)


def _value(node: Any, rng: np.random.Generator) -> Any:
    tag, content = node
    if tag == Nodetype.NAME:
        return random_message(content, rng)
    if tag == Nodetype.BASE:
        return _text(rng) if content[0] == "string" else _numbers(content[0], 1, rng)[0].item()
    inner, size = content
    count = size if tag == Nodetype.ARRAY else int(rng.integers(0, min(size or 4, 4)))
    if inner[0] == Nodetype.BASE and inner[1][0] != "string":
        return _numbers(inner[1][0], count, rng)
    return [_value(inner, rng) for _ in range(count)]


def _text(rng: np.random.Generator) -> str:
    return "".join(rng.choice(LETTERS, size=rng.integers(0, 6)))


def _numbers(base: str, count: int, rng: np.random.Generator) -> np.ndarray:
    if base == "bool":
        return rng.integers(0, 2, count).astype(bool)
    if base in ("float32", "float64"):
        values = rng.normal(size=count)
        values[rng.random(count) < 0.1] = rng.choice([np.nan, np.inf, -np.inf, 0.0])
        return values.astype(base)
    kind = np.dtype({"byte": "int8", "char": "uint8"}.get(base, base))
    return rng.integers(np.iinfo(kind).min, np.iinfo(kind).max, count, dtype=kind, endpoint=True)


def serialized(message: Any, little_endian: bool = True) -> bytes:
    """CDR of a message."""
    return bytes(STORE.serialize_cdr(message, message.__msgtype__, little_endian=little_endian))


def interleaved(kinds: dict[str, str], count: int, seed: int = 0, repeat: bool = False) -> Messages:
    """`count` random messages on each topic of `kinds` (topic -> type); with `repeat` only their numbers differ."""
    rng = np.random.default_rng(seed)
    messages: Messages = []
    for index in range(count):
        for lane, (topic, kind) in enumerate(kinds.items()):
            content = random_message(kind, np.random.default_rng(seed) if repeat else rng)
            messages.append((topic, kind, START + index * 1_000_000 + lane * 1000, serialized(content)))
    return messages


def write_rosbags(path: Path, messages: Messages, storage: str = "mcap", compression: str = "none") -> Path:
    """A folder written by rosbags; compression is none, storage, message or file."""
    writer = Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
    writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=STORE)
            for topic, kind in {message[0]: message[1] for message in messages}.items()
        }
        for topic, _, time, data in messages:
            writer.write(connections[topic], time, data)
    return path


def by_rosbags(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Recorded time and message object of every message, per topic, as rosbags' AnyReader gives them."""
    found: dict[str, list[tuple[int, Any]]] = {}
    with AnyReader([path]) as reader:
        for connection, time, raw in reader.messages():
            found.setdefault(connection.topic, []).append((time, reader.deserialize(raw, connection.msgtype)))
    return found


def assert_same(topics: dict[str, Any], expected: dict[str, list[tuple[int, Any]]]) -> None:
    """Every value of every field of every message of `topics` (TopicData by name) equals rosbags' value."""
    assert set(topics) == set(expected)
    for topic, messages in expected.items():
        data = topics[topic]
        assert data.log_time.tolist() == [time for time, _ in messages], topic
        for field in data.fields:
            column = data[field]
            assert len(column) == len(messages)
            for value, (_, message) in zip(column, messages, strict=True):
                assert_equal(value, reduce(getattr, field.split("."), message), f"{topic} {field}")


def assert_equal(value: Any, expected: Any, where: str) -> None:
    """Equal to rosbags' value; NaN equals NaN, a tuple of strings equals their list."""
    if isinstance(expected, list):
        assert len(value) == len(expected), where
        for left, right in zip(value, expected, strict=True):
            assert_equal(left, right, where)
    elif hasattr(expected, "__msgtype__"):
        for field in expected.__dataclass_fields__:
            if field != "__msgtype__":
                assert_equal(getattr(value, field), getattr(expected, field), where)
    elif isinstance(expected, str):
        assert value == expected, where
    else:
        np.testing.assert_array_equal(value, expected, err_msg=where)
