"""Bags of this writer: read by rosbags and by this package, whole at any time, never overwriting another."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import yaml
from records.making import START, STORE, assert_same, by_rosbags, interleaved
from rosbags.interfaces import QosDurability, QosReliability
from rosbags.rosbag2 import Reader

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import Bag, BagTopic, BagWriter, read_topics
from pneumo_ros.records.contract import GLOBAL_TYPES, TYPES

CONTRACT = {f"/axis/{name}": kind for name, kind in TYPES.items()} | GLOBAL_TYPES
PROGRAM = Path(__file__).parent / "writes_forever.py"


def topics() -> list[BagTopic]:
    """Every topic of the contract, as offered by its publisher."""
    return [BagTopic(name, kind, latched=name.endswith("description")) for name, kind in CONTRACT.items()]


def test_bags_read_the_same_by_rosbags_and_here(tmp_path: Path) -> None:
    messages = interleaved(CONTRACT, 200)
    with BagWriter(tmp_path / "bag", topics()) as writer:
        for topic, _, log_time, data in messages:
            writer.write(topic, log_time, data)
    found = by_rosbags(tmp_path / "bag")
    assert {name: len(rows) for name, rows in found.items()} == dict.fromkeys(CONTRACT, 200)
    assert_same(read_topics(tmp_path / "bag"), found)
    bag = Bag(tmp_path / "bag")
    assert [(m.channel.topic, m.channel.type, m.log_time, m.payload) for m in bag.messages()] == messages
    assert bag.warnings == []


def test_metadata_says_what_rosbag2_wants_to_know(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag", topics()) as writer:
        for topic, _, log_time, data in interleaved(CONTRACT, 5):
            writer.write(topic, log_time, data)
    with Reader(tmp_path / "bag") as reader:
        assert reader.message_count == 5 * len(CONTRACT)
        assert reader.start_time == START
        connections = {one.topic: one for one in reader.connections}
    assert {name: one.digest for name, one in connections.items()} == {
        name: STORE.hash_rihs01(kind) for name, kind in CONTRACT.items()
    }
    (profile,) = connections["/axis/description"].ext.offered_qos_profiles
    assert (profile.durability, profile.reliability) == (QosDurability.TRANSIENT_LOCAL, QosReliability.RELIABLE)
    (profile,) = connections["/axis/joint_states"].ext.offered_qos_profiles
    assert profile.durability == QosDurability.VOLATILE
    information = yaml.safe_load((tmp_path / "bag" / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert information["version"] == 9
    assert information["relative_file_paths"] == ["bag_0.mcap"]
    assert Bag(tmp_path / "bag").overview().channels["/axis/description"].latched


def test_a_bag_is_readable_while_it_is_written(tmp_path: Path) -> None:
    messages = interleaved(CONTRACT, 30)
    writer = BagWriter(tmp_path / "bag", topics())
    for part in range(3):
        for topic, _, log_time, data in messages[part * 100 : part * 100 + 100]:
            writer.write(topic, log_time, data)
        writer.flush()
        expected = [(name, at, data) for name, _, at, data in messages[: part * 100 + 100]]
        bag = Bag(tmp_path / "bag")
        assert [(m.channel.topic, m.log_time, m.payload) for m in bag.messages()] == expected
        with Reader(tmp_path / "bag") as reader:
            assert [(one.topic, at, data) for one, at, data in reader.messages()] == expected
        assert len(bag.warnings) == 1
        assert "killed before it could close" in bag.warnings[0]
    writer.close()


def test_topics_may_come_late(tmp_path: Path) -> None:
    messages = interleaved(CONTRACT, 20)
    with BagWriter(tmp_path / "bag") as writer:
        for topic, kind, log_time, data in messages:
            writer.add_topic(BagTopic(topic, kind))
            writer.write(topic, log_time, data)
            writer.flush()
    assert_same(read_topics(tmp_path / "bag"), by_rosbags(tmp_path / "bag"))


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    BagWriter(tmp_path / "run").close()
    (tmp_path / "run_2").mkdir()
    before = {file: file.read_bytes() for file in (tmp_path / "run").iterdir()}
    with pytest.raises(DataError, match=r"run exists and is not overwritten.*run_3"):
        BagWriter(tmp_path / "run")
    assert {file: file.read_bytes() for file in (tmp_path / "run").iterdir()} == before


def test_misspelt_topics_and_types(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag", topics()) as writer:
        with pytest.raises(UsageError, match="did you mean /axis/joint_states"):
            writer.write("/axis/joint_state", START, b"")
        with pytest.raises(UsageError, match="did you mean sensor_msgs/msg/JointState"):
            writer.add_topic(BagTopic("/other", "sensor_msgs/msg/JointStates"))
        with pytest.raises(UsageError, match="cannot also be"):
            writer.add_topic(BagTopic("/axis/joint_states", "std_msgs/msg/Float64"))


def test_a_full_disk_is_said_in_words(tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.fail("this system has no /dev/full to stand for a full disk")
    writer = BagWriter(tmp_path / "bag", topics())
    full = os.open("/dev/full", os.O_WRONLY)
    os.dup2(full, writer._file._descriptor)  # the disk fills up under the open file
    os.close(full)
    for topic, _, log_time, data in interleaved(CONTRACT, 3):
        writer.write(topic, log_time, data)
    with pytest.raises(DataError, match=r"No space left on device. The last \d+ messages are lost"):
        writer.flush()


def test_a_full_disk_leaves_what_was_there_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The system writes part of the data, over the old end of the file, and then refuses more."""
    path, real = tmp_path / "bag", os.pwrite
    room = [1000]

    def little(descriptor: int, data: bytes, position: int) -> int:
        if len(data) > 100 and not room[0]:
            raise OSError(28, "No space left on device")
        if len(data) > 100:
            data, room[0] = data[: room[0]], 0
        return real(descriptor, data, position)

    writer = BagWriter(path, topics())
    for topic, _, log_time, data in interleaved(CONTRACT, 3):
        writer.write(topic, log_time, data)
    writer.flush()
    before = next(path.glob("*.mcap")).read_bytes()
    for topic, _, log_time, data in interleaved(CONTRACT, 40):
        writer.write(topic, log_time + 10**9, data)
    monkeypatch.setattr(os, "pwrite", little)
    with pytest.raises(DataError, match="No space left"):
        writer.flush()
    assert next(path.glob("*.mcap")).read_bytes() == before
    assert_same(read_topics(path), by_rosbags(path))


def test_a_killed_writer_loses_no_more_than_a_second(tmp_path: Path) -> None:
    path = tmp_path / "bag"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    with subprocess.Popen(
        [sys.executable, str(PROGRAM), str(path)], stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        assert process.stdout is not None
        written: list[tuple[float, int]] = []
        while not written or written[-1][0] - written[0][0] < 2.5:
            written.append((time.monotonic(), int(process.stdout.readline())))
        process.send_signal(signal.SIGKILL)
    safe = max(number for at, number in written if at <= written[-1][0] - 1.0)
    bag = Bag(path)
    values = [message.payload for message in bag.messages()]
    assert len(values) > safe
    assert read_topics(path)["/n"]["data"].tolist() == list(range(len(values)))
    assert "killed" in " ".join(bag.warnings)
    # rosbags, which needs whole files, reads the same
    assert_same(read_topics(path), by_rosbags(path))
