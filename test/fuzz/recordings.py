"""Small recordings to damage: a simulated axis in every format that is read, and arbitrary messages."""

import json
import sqlite3
import struct
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as FolderWriter

from fuzz import texts
from fuzz.mutation import mutated, one_of
from pneumo_ros.records import Bag, write_recording
from pneumo_ros.records.contract import LATCHED, TYPES
from pneumo_ros.records.message_types import definition_of, standard_types

Messages = list[tuple[str, int, bytes]]  # contract name, recorded time [ns], CDR
SAMPLES = 60
START = 1_700_000_000_000_000_000
QOS = [{"history": 1, "durability": "transient_local", "depth": 1}]


@cache
def axis() -> Messages:
    """A short run of every message that a simulator sends."""
    time = np.arange(SAMPLES) / 1000.0
    wave, gas = 0.1 * np.sin(40.0 * time), 4e5 + 1e4 * np.cos(40.0 * time)
    with TemporaryDirectory() as folder:
        write_recording(
            Path(folder) / "run", time=time, position=wave, velocity=wave, effort=wave, pressure_a=gas, pressure_b=gas,
            supply_pressure=gas, voltage=np.repeat(wave[::10], 10), start_ns=START, description=description(),
        )  # fmt: skip
        return [(m.channel.topic[1:], m.log_time, m.payload) for m in Bag(Path(folder) / "run").messages()]


def description() -> dict[str, Any]:
    """A recording's description of its machine."""
    return {"schema_version": 1, "model": {"piston": {"mass": 5.0}, "effects": []}, "package_version": "0", "seed": 1}


def mcap_file(
    messages: Messages,
    compression: CompressionType = CompressionType.NONE,
    chunking: bool = True,
    definitions: dict[str, tuple[str, str]] | None = None,
    qos: str = "",
) -> bytes:
    """A bare file without checksums, so that damage reaches the parsers; `definitions`: format and text by type."""
    stream = BytesIO()
    writer = Writer(stream, 4000, compression, use_chunking=chunking, enable_crcs=False, enable_data_crcs=False)
    writer.start(profile="ros2")
    channels: dict[str, int] = {}
    for topic, time, payload in messages:
        if topic not in channels:
            kind = TYPES.get(topic, "a/msg/B")
            form, text = (definitions or {}).get(kind) or ("ros2msg", _standard(kind))
            schema = writer.register_schema(kind, form, text.encode("utf-8", "surrogatepass"))
            channels[topic] = writer.register_channel(f"/{topic}", "cdr", schema, {"offered_qos_profiles": qos})
        writer.add_message(channels[topic], time, payload, time)
    writer.finish()
    return stream.getvalue()


def _standard(kind: str) -> str:
    return definition_of(kind)[0] if kind in TYPES.values() else "float64[] a"


@cache
def mcap_seeds() -> tuple[bytes, ...]:
    """The axis in every form of MCAP."""
    return tuple(mcap_file(axis(), one, chunked) for one in CompressionType for chunked in (True, False))


@cache
def folder_seeds() -> tuple[bytes, bytes]:
    """A database of the axis, and the metadata.yaml of a folder with `mcap_seeds()[0]` in it."""
    found = []
    for plugin in StoragePlugin:
        with TemporaryDirectory() as around:
            folder, store = Path(around) / "bag", standard_types()
            with FolderWriter(folder, version=9, storage_plugin=plugin) as writer:
                kinds = {topic: TYPES[topic] for topic, _, _ in axis()}
                open_ = {t: writer.add_connection(f"/{t}", kind, typestore=store) for t, kind in kinds.items()}
                for topic, time, payload in axis():
                    writer.write(open_[topic], time, payload)
            wanted = "*.db3" if plugin == StoragePlugin.SQLITE3 else "metadata.yaml"
            found.append((wanted, next(folder.glob(wanted)).read_bytes()))
    return dict(found)["*.db3"], dict(found)["metadata.yaml"]


def _spoilt(messages: Messages, spoil: dict[int, bytes]) -> Messages:
    return [(topic, time, spoil.get(k, payload)) for k, (topic, time, payload) in enumerate(messages)]


def spoilt_messages() -> st.SearchStrategy[bytes]:
    """Whole MCAP files with broken messages in them."""
    some = axis()[: 8 * SAMPLES]
    places = st.integers(0, len(some) - 1)
    broken = places.flatmap(lambda k: mutated([some[k][2]]).map(lambda payload: (k, payload)))
    return st.lists(broken, min_size=1, max_size=4).map(lambda pairs: mcap_file(_spoilt(some, dict(pairs))))


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


FIELDS = st.builds(
    lambda kind, array, name: f"{kind}{array} {name}",
    st.sampled_from(
        ["float64", "string", "uint8", "wstring", "B", "C", "a/B", "std_msgs/Header", "string<=3", "byte", "x"]
    ),
    st.sampled_from(["", "", "[]", "[2]", "[<=3]", "[0]", "[99999999999]", "[-1]"]),
    st.sampled_from(
        ["a", "b", "class", "__init__", "self", "np", "dataclass", "T", "A", "a b", "deserialize", "x=1", "1"]
    ),
)
NESTED = "\n".join(f"{'=' * 80}\nMSG: a/L{k}\n" + "".join(f"L{k + 1} x{i}\n" for i in range(9)) for k in range(12))
BOMB = "L0 x\n" + NESTED + f"\n{'=' * 80}\nMSG: a/L12\nfloat64 x\n"  # 9^12 numbers in each message
MSG = st.lists(FIELDS, max_size=5).map("\n".join) | one_of([BOMB.encode(), b"B x\n", b"C x\n"]).map(_text)
IDL = [
    "module a { module msg { struct B { double x; }; }; };",
    "module a { module msg { typedef double T[9]; struct B { T x; sequence<B> y; }; }; };",
    "module a { module msg { const string N = \"open('canary', 'w')\"; struct B { octet x[N]; }; }; };",
]


def spoilt_definitions() -> st.SearchStrategy[bytes]:
    """Whole MCAP files with wrong types, in both languages of definitions."""
    known = [definition_of(kind)[0].encode() for kind in TYPES.values()]
    forms = st.one_of(
        st.tuples(st.just("ros2msg"), mutated(known).map(_text)),
        st.tuples(st.just("ros2msg"), MSG),
        st.tuples(st.just("ros2idl"), mutated([text.encode() for text in IDL]).map(_text)),
        st.tuples(st.text(max_size=8), st.text(max_size=40)),
    )
    kinds, qos = st.sampled_from([*TYPES.values(), "a/msg/B"]), texts.yaml_files(QOS).map(_text)
    own = [*axis()[:60], ("x", START, b"\0\1\0\0" + struct.pack("<16d", *range(16)))]
    return st.builds(lambda kind, form, how: mcap_file(own, definitions={kind: form}, qos=how), kinds, forms, qos)


def described() -> st.SearchStrategy[bytes]:
    """Recordings with a nearly valid description."""
    topic = next(iter(LATCHED))

    def with_text(text: bytes) -> bytes:
        payload = b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text + b"\0"
        return mcap_file([(t, time, payload if t == topic else data) for t, time, data in axis()])

    words = json.dumps(description()).encode()
    return st.one_of(texts.json_files(description()), mutated([words])).map(with_text)


def sql_spoilt(statement: str) -> bytes:
    """The database after an SQL statement."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "bag.db3"
        path.write_bytes(folder_seeds()[0])
        base = sqlite3.connect(path)
        base.executescript(statement)
        base.commit()
        base.close()
        return path.read_bytes()


SQL = [
    "DELETE FROM topics", "DROP TABLE messages", "UPDATE messages SET data = 5", "UPDATE messages SET data = 'x'",
    "UPDATE messages SET timestamp = 'x'", "UPDATE topics SET type = 'a/b'", "UPDATE topics SET type = ''",
    "UPDATE topics SET offered_qos_profiles = '[[['", "UPDATE topics SET name = ''",
    "UPDATE messages SET topic_id = 99",
    "UPDATE messages SET timestamp = -1", "UPDATE messages SET timestamp = 9223372036854775807",
    "UPDATE topics SET serialization_format = 'x'", "UPDATE messages SET data = zeroblob(4)", "DELETE FROM messages",
    "UPDATE message_definitions SET encoded_message_definition = 'x y z'", "UPDATE topics SET id = id + 7",
    "DROP TABLE schema",
]  # fmt: skip
