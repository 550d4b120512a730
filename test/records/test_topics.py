"""Bulk decoding gives what rosbags gives message by message, for every type and every storage."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.writer import CompressionType, Writer
from records.making import START, STORE, assert_same, by_rosbags, interleaved, random_message, serialized, write_rosbags

from pneumo_ros.errors import DataError
from pneumo_ros.records import read_topics, topic_data
from pneumo_ros.records.contract import GLOBAL_TYPES, TYPES
from pneumo_ros.records.message_types import trimmed
from pneumo_ros.records.metadata import BagTopic, as_yaml
from pneumo_ros.records.topics import MOST_LAYOUTS

CONTRACT = {f"/axis/{name}": kind for name, kind in TYPES.items()} | GLOBAL_TYPES
# Fixed arrays, arrays of messages, byte sequences, booleans, an empty message
OTHERS = [
    "std_msgs/msg/Empty", "std_msgs/msg/Float64MultiArray", "std_msgs/msg/UInt8MultiArray", "std_msgs/msg/Bool",
    "std_msgs/msg/Byte", "std_msgs/msg/Char", "sensor_msgs/msg/Imu", "sensor_msgs/msg/BatteryState",
    "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/MultiDOFJointState",
    "geometry_msgs/msg/PoseWithCovarianceStamped", "nav_msgs/msg/OccupancyGrid", "shape_msgs/msg/SolidPrimitive",
    "tf2_msgs/msg/TFMessage", "rcl_interfaces/msg/ParameterEvent", "rcl_interfaces/msg/Log",
]  # fmt: skip
SOME = {f"/{kind}": kind for kind in OTHERS if kind in STORE.fielddefs}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kinds", [CONTRACT, SOME], ids=["contract", "others"])
def test_every_type_equals_rosbags(tmp_path: Path, kinds: dict[str, str], seed: int) -> None:
    path = write_rosbags(tmp_path / "bag", interleaved(kinds, 12, seed))
    assert_same(read_topics(path), by_rosbags(path))


def test_others_reach_types_the_contract_does_not_have() -> None:
    assert len(SOME) >= 15


@pytest.mark.parametrize(
    ("storage", "compression"),
    [(storage, mode) for storage in ("mcap", "sqlite3") for mode in ("none", "message", "file")]
    + [("mcap", "storage")],
)
def test_every_storage_equals_rosbags(tmp_path: Path, storage: str, compression: str) -> None:
    path = write_rosbags(tmp_path / "bag", interleaved(CONTRACT, 40), storage, compression)
    assert_same(read_topics(path), by_rosbags(path))


@pytest.mark.parametrize("compression", ["none", "message", "file"])
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_metadata_whose_quality_of_service_differs_from_the_file(
    tmp_path: Path, storage: str, compression: str
) -> None:
    """As after an edit for `ros2 bag play`; rosbags alone then finds no message."""
    path = write_rosbags(tmp_path / "bag", interleaved(CONTRACT, 4), storage, compression)
    before = by_rosbags(path)
    text = (path / "metadata.yaml").read_text()
    changed = yaml.safe_load(text)
    for one in changed["rosbag2_bagfile_information"]["topics_with_message_count"]:
        one["topic_metadata"]["offered_qos_profiles"] = [*BagTopic("t", "k", latched=True).profiles()]
        one["topic_metadata"]["type_description_hash"] = "RIHS01_" + 64 * "0"
    (path / "metadata.yaml").write_text(as_yaml(changed))
    assert_same(read_topics(path), before)


@pytest.mark.check
def test_many_chunks_of_one_layout(tmp_path: Path) -> None:
    path = write_rosbags(tmp_path / "bag", interleaved(CONTRACT, 1500, repeat=True), compression="storage")
    assert_same(read_topics(path), by_rosbags(path))


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("chunking", [True, False])
def test_files_of_the_mcap_library(tmp_path: Path, compression: CompressionType, chunking: bool) -> None:
    messages = interleaved(CONTRACT, 300, repeat=True)
    path = tmp_path / "alone.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=20_000, compression=compression, use_chunking=chunking)
        writer.start(profile="ros2")
        channels: dict[str, int] = {}
        for topic, kind, time, data in messages:
            if topic not in channels:
                text, _ = STORE.generate_msgdef(kind, ros_version=2)
                schema = writer.register_schema(kind, "ros2msg", text.encode())
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channels[topic], time, data, time)
        writer.finish()
    assert_same(read_topics(path), by_rosbags(path))


def test_messages_that_differ_in_numbers_only_are_decoded_in_bulk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_rosbags(tmp_path / "bag", interleaved(CONTRACT, 50, repeat=True))
    expected = by_rosbags(path)
    one_by_one: list[str] = []
    monkeypatch.setattr(topic_data, "deserialize", lambda store, payload, kind: one_by_one.append(kind))
    bulk = {name: data for name, data in read_topics(path).items() if "Trajectory" not in data.type}
    bulk = {name: data for name, data in bulk.items() if "Diagnostic" not in data.type}
    assert_same(bulk, {name: expected[name] for name in bulk})
    assert len(bulk) == len(CONTRACT) - 2
    assert one_by_one == []


def test_big_endian_messages(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    messages = [
        (topic, kind, START + index, serialized(random_message(kind, rng), little_endian=False))
        for index, (topic, kind) in enumerate(list(CONTRACT.items()) * 6)
    ]
    path = write_rosbags(tmp_path / "bag", messages)
    assert_same(read_topics(path), by_rosbags(path))


def test_more_layouts_than_are_kept(tmp_path: Path) -> None:
    words = ["x" * (index % 90) for index in range(5 * MOST_LAYOUTS)]
    text = STORE.types["std_msgs/msg/String"]
    messages = [("/words", "std_msgs/msg/String", START + i, serialized(text(data=w))) for i, w in enumerate(words)]
    path = write_rosbags(tmp_path / "bag", messages)
    assert read_topics(path)["/words"]["data"].tolist() == words


def test_messages_come_in_recorded_time(tmp_path: Path) -> None:
    number = STORE.types["std_msgs/msg/Float64"]
    times = np.random.default_rng(2).permutation(500)
    messages = [("/n", "std_msgs/msg/Float64", START + int(t), serialized(number(data=float(t)))) for t in times]
    data = read_topics(write_rosbags(tmp_path / "bag", messages))["/n"]
    assert data["data"].tolist() == sorted(times.tolist())
    assert (data.log_time - START).tolist() == sorted(times.tolist())


def test_topics_can_be_chosen_and_misspelt(tmp_path: Path) -> None:
    path = write_rosbags(tmp_path / "bag", interleaved(CONTRACT, 3))
    assert set(read_topics(path, ["/axis/valve/command"])) == {"/axis/valve/command"}
    with pytest.raises(DataError, match="did you mean /axis/valve/command"):
        read_topics(path, ["/axis/valve/comand"])
    with pytest.raises(DataError, match="did you mean position"):
        read_topics(path)["/axis/joint_states"]["positon"]


@pytest.mark.parametrize("kind", ["sensor_msgs/msg/JointState", "trajectory_msgs/msg/JointTrajectory"])
def test_stray_bytes_at_the_end_of_messages(tmp_path: Path, kind: str) -> None:
    messages = interleaved({"/x": kind}, 50)
    stray = [(topic, kind, time, data + b"stray bytes") for topic, kind, time, data in messages]
    expected = by_rosbags(write_rosbags(tmp_path / "clean", messages))
    assert_same(read_topics(write_rosbags(tmp_path / "stray", stray)), expected)
    assert [trimmed(data, kind) for _, _, _, data in stray] == [data for _, _, _, data in messages]


def test_a_message_that_does_not_fit_its_type(tmp_path: Path) -> None:
    good = serialized(STORE.types["std_msgs/msg/Float64"](data=1.0))
    messages = [("/n", "std_msgs/msg/Float64", START + i, data) for i, data in enumerate([good, good[:9], good])]
    data = read_topics(write_rosbags(tmp_path / "bag", messages))["/n"]
    with pytest.raises(DataError, match=r"does not fit its type std_msgs/msg/Float64"):
        data["data"]
