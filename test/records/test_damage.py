"""Broken recordings: cut anywhere, damaged inside, without metadata, or with a killed recorder."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer
from records.making import START, STORE, interleaved, write_rosbags

from pneumo_ros.errors import DataError
from pneumo_ros.records import Bag, BagTopic, BagWriter, read_topics

KINDS = {"/n": "std_msgs/msg/Float64", "/p": "sensor_msgs/msg/FluidPressure"}
MESSAGES = interleaved(KINDS, 3000)


def written_by_mcap(path: Path, compression: CompressionType = CompressionType.ZSTD, chunking: bool = True) -> Path:
    """A bare file in chunks of 40 kB."""
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=40_000, compression=compression, use_chunking=chunking)
        writer.start(profile="ros2")
        channels = {}
        for topic, kind in KINDS.items():
            schema = writer.register_schema(kind, "ros2msg", STORE.generate_msgdef(kind, ros_version=2)[0].encode())
            channels[topic] = writer.register_channel(topic, "cdr", schema)
        for topic, _, time, data in MESSAGES:
            writer.add_message(channels[topic], time, data, time)
        writer.finish()
    return path


def payloads(path: Path) -> tuple[list[tuple[str, int, bytes]], list[str]]:
    """All messages of a bag, and its warnings."""
    bag = Bag(path)
    found = [(message.channel.topic, message.log_time, message.payload) for message in bag.messages()]
    return found, bag.warnings


EXPECTED = [(topic, time, data) for topic, _, time, data in MESSAGES]


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("chunking", [True, False])
def test_cut_anywhere_yields_everything_before_the_cut(
    tmp_path: Path, compression: CompressionType, chunking: bool
) -> None:
    whole = written_by_mcap(tmp_path / "whole.mcap", compression, chunking).read_bytes()
    cut = tmp_path / "cut.mcap"
    places = np.unique(np.linspace(9, len(whole) - 9, 40).astype(int))
    counts = []
    for place in places:
        cut.write_bytes(whole[:place])
        found, warnings = payloads(cut)
        assert found == EXPECTED[: len(found)]
        assert len(warnings) == 1
        assert "breaks off" in warnings[0]
        counts.append(len(found))
    assert counts == sorted(counts)
    # Messages make up nearly all of the file, so what is read grows with it: within a chunk or two
    share = np.array(counts) / len(EXPECTED)
    assert np.all(share >= places / len(whole) - 0.35)


def test_part_of_a_cut_chunk_is_read(tmp_path: Path) -> None:
    """One chunk that holds everything: what decompresses before the cut counts."""
    path = write_rosbags(tmp_path / "bag", MESSAGES, compression="storage")
    file = next(path.glob("*.mcap"))
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    found, _ = payloads(file)
    assert found == EXPECTED[: len(found)]
    assert len(found) > 500


def test_a_damaged_chunk_costs_itself_only(tmp_path: Path) -> None:
    data = bytearray(written_by_mcap(tmp_path / "bag.mcap", CompressionType.NONE).read_bytes())
    at = len(data) // 2
    data[at : at + 8] = bytes(byte ^ 0xFF for byte in data[at : at + 8])
    (tmp_path / "bag.mcap").write_bytes(data)
    found, warnings = payloads(tmp_path / "bag.mcap")
    assert set(found) < set(EXPECTED)
    assert len(found) > 0.7 * len(EXPECTED)
    assert found[-1] == EXPECTED[-1]
    assert len(warnings) == 1
    assert "1 part is damaged" in warnings[0]


def test_random_damage_never_surprises(tmp_path: Path) -> None:
    """For any damage of a file, the answer is messages or a DataError."""
    whole = written_by_mcap(tmp_path / "bag.mcap").read_bytes()
    rng = np.random.default_rng(3)
    for _ in range(60):
        data = bytearray(whole)
        for at in rng.integers(0, len(data), 20):
            data[at] = rng.integers(0, 256)
        (tmp_path / "bag.mcap").write_bytes(data)
        try:
            found, warnings = payloads(tmp_path / "bag.mcap")
        except DataError:
            continue
        assert found == EXPECTED or warnings


@pytest.mark.parametrize("content", [b"", b"no recording", b"\x89MCAP"])
def test_files_that_are_no_mcap(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x.mcap").write_bytes(content)
    with pytest.raises(DataError, match=r"empty|not an MCAP file"):
        read_topics(tmp_path / "x.mcap")


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_missing_metadata(tmp_path: Path, storage: str) -> None:
    path = write_rosbags(tmp_path / "bag", MESSAGES[:600], storage)
    (path / "metadata.yaml").unlink()
    found, warnings = payloads(path)
    assert found == EXPECTED[:600]
    assert len(warnings) == 1
    assert "no metadata.yaml" in warnings[0]


LISTS = [f"rosbag2_bagfile_information: {{relative_file_paths: {value}}}" for value in ("a.mcap", "[[a]]", "[1]", "{}")]


@pytest.mark.parametrize(
    "content",
    ["", "rosbag2_bagfile_information:\n  version: 9\n", ":\n\t-", "\0\0\0", "a: 2001-99-99", "[" * 9000, *LISTS],
)
def test_damaged_metadata(tmp_path: Path, content: str) -> None:
    path = write_rosbags(tmp_path / "bag", MESSAGES[:600])
    (path / "metadata.yaml").write_text(content)
    found, warnings = payloads(path)
    assert found == EXPECTED[:600]
    assert "damaged" in warnings[0]


def test_split_recordings_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    for number in range(11):
        part = BagWriter(tmp_path / f"part{number}", [BagTopic("/n", "std_msgs/msg/Float64")])
        with part:
            part.write("/n", START + number, MESSAGES[2 * number][3])
        folder.mkdir(exist_ok=True)
        shutil.copy(next(part.path.glob("*.mcap")), folder / f"bag_{number}.mcap")
    found, _ = payloads(folder)
    assert [time - START for _, time, _ in found] == list(range(11))


def test_overlapping_parts_are_merged_by_time(tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    folder.mkdir()
    for number in range(2):
        with BagWriter(tmp_path / f"part{number}", [BagTopic("/n", "std_msgs/msg/Float64")]) as part:
            for step in range(50):
                part.write("/n", START + 2 * step + number, MESSAGES[0][3])
        shutil.copy(next(part.path.glob("*.mcap")), folder / f"bag_{number}.mcap")
    found, _ = payloads(folder)
    assert [time - START for _, time, _ in found] == list(range(100))
    assert (read_topics(folder)["/n"].log_time - START).tolist() == list(range(100))


def test_times_before_1970_are_times(tmp_path: Path) -> None:
    """A recorder whose clock was not set."""
    with BagWriter(tmp_path / "bag", [BagTopic("/n", "std_msgs/msg/Float64")]) as writer:
        for time in (0, 1, 2):
            writer.write("/n", time, MESSAGES[0][3])
    file = next((tmp_path / "bag").glob("*.mcap"))
    bag = Bag(written_with_times(file, tmp_path / "early.mcap", [-2, -1, 3]))
    assert [message.log_time for message in bag.messages()] == [-2, -1, 3]
    assert [message.log_time for message in bag.messages(since=0)] == [3]


def written_with_times(source: Path, target: Path, times: list[int]) -> Path:
    """The messages of `source` at other times; negative ones as the file's unsigned numbers."""
    with target.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="ros2")
        schema = writer.register_schema(KINDS["/n"], "ros2msg", b"float64 data")
        channel = writer.register_channel("/n", "cdr", schema)
        for message, time in zip(Bag(source).messages(), times, strict=True):
            writer.add_message(channel, time % 2**64, message.payload, 0)
        writer.finish()
    return target
