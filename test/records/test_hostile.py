"""Malicious recordings: short files that expand beyond any memory, and endless types."""

import struct
from functools import partial
from pathlib import Path

import lz4.frame
import pytest
import zstandard
from fuzz.recordings import BOMB, START, axis, mcap_file

from pneumo_ros.errors import DataError
from pneumo_ros.records import Bag, read_recording, read_topics
from pneumo_ros.records.compression import decompress
from pneumo_ros.records.contract import DESCRIPTION

ZEROS = 200 << 20  # bytes
PACKERS = {
    "zstd": zstandard.compress,
    "zstd, size not said": zstandard.ZstdCompressor(write_content_size=False).compress,
    "lz4": lz4.frame.compress,
    "lz4, size not said": partial(lz4.frame.compress, store_size=False),
}
PAYLOAD = b"\0\1\0\0" + struct.pack("<16d", *range(16))


@pytest.mark.parametrize("kind", list(PACKERS))
def test_what_would_fill_the_memory_is_read_in_part(kind: str) -> None:
    packed = PACKERS[kind](bytes(ZEROS))
    for size in (1000, ZEROS):  # the size in the chunk's header
        found = decompress(memoryview(packed), kind.partition(",")[0], size, Path("x"))
        limit = max(1 << 26, 200 * len(packed))
        assert limit <= len(found) < min(1.1 * limit, ZEROS) + (1 << 26)


@pytest.mark.parametrize("kind", list(PACKERS))
def test_what_a_recording_holds_is_read_whole(kind: str) -> None:
    content = bytes(range(256)) * 4000
    assert decompress(memoryview(PACKERS[kind](content)), kind.partition(",")[0], len(content), Path("x")) == content


@pytest.mark.parametrize(
    ("definition", "said"),
    [
        (BOMB, "too many fields"),
        ("string[99999999] a", "too many fields"),
        ("B a", "holds a/msg/B within itself"),
        ("B[] a", "holds a/msg/B within itself"),
        ("float64[99999999999] a", "does not fit its type"),
        ("float64 a\nfloat64 a", "cannot be understood"),
        ("nonsense", "cannot be understood"),
    ],
)
def test_types_without_an_end_are_refused(definition: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(mcap_file([("x", START, PAYLOAD)], definitions={"a/msg/B": ("ros2msg", definition)}))
    with pytest.raises(DataError, match=said) as refused:
        print(*(data[field] for data in read_topics(path).values() for field in data.fields))
    assert len(str(refused.value)) < 500


@pytest.mark.parametrize("qos", ["7", "a", "[1, a]", "{durability: 1}", "[" * 5000, "a: 2001-99-99"])
def test_an_invalid_quality_of_service(qos: str, tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(mcap_file(axis(), qos=qos))
    assert not any(
        channel.latched for name, channel in Bag(path).overview().channels.items() if DESCRIPTION not in name
    )


@pytest.mark.parametrize("text", ["[" * 100_000, '{"a":' * 100_000, "9" * 10_000])
def test_a_description_that_no_parser_bears(text: str, tmp_path: Path) -> None:
    payload = b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text.encode() + b"\0"
    path = tmp_path / "x.mcap"
    path.write_bytes(mcap_file([(t, at, payload if t == DESCRIPTION else data) for t, at, data in axis()]))
    run = read_recording(path)
    assert run.description is None
    assert any("no JSON object" in warning for warning in run.warnings)


def test_a_sensor_that_spoke_once(tmp_path: Path) -> None:
    """A single message has no gaps, and little usable data."""
    spoke = [at for topic, at, _ in axis() if topic == "chamber_b/pressure"][30]
    path = tmp_path / "x.mcap"
    path.write_bytes(mcap_file([one for one in axis() if one[0] != "chamber_b/pressure" or one[1] == spoke]))
    assert len(read_recording(path).time) == 3
