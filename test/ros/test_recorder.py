"""The recorder as a process with a real publisher: its files, its messages, its end."""

import re
import signal
import time
from pathlib import Path

import pytest
from records.making import assert_same, by_rosbags
from ros.processes import Running, node, publisher, running, wait_recorded

from pneumo_ros.records import Bag, read_recording, read_topics

TOPICS = ["/joint_states", "/chamber_a/pressure", "/chamber_b/pressure", "/supply/pressure"]
VALUES = {"/joint_states": "position"}  # of the other topics: fluid_pressure


def recorder(folder: Path, *ros_args: str, **parameters: object) -> list[str]:
    """Command of a recorder that writes to folder/bag."""
    return node("recorder", *ros_args, output=folder / "bag", **parameters)


def numbers(path: Path, topic: str) -> list[float]:
    """Numbers of the messages recorded on `topic`."""
    return read_topics(path)[topic][VALUES.get(topic, "fluid_pressure")].ravel().tolist()


def warnings(path: Path) -> str:
    """The warnings of reading the whole recording."""
    bag = Bag(path)
    bag.overview()
    return " ".join(bag.warnings)


def closing(process: Running) -> str:
    """The recorder's output at its end."""
    return next(line for _, line in process.lines if "recorded" in line)


def test_four_topics_at_1_khz_are_recorded_whole(tmp_path: Path) -> None:
    with running(*recorder(tmp_path), cwd=tmp_path) as recording, running(*publisher(2000), cwd=tmp_path) as source:
        source.wait_for("2000 published")
        time.sleep(0.2)
        assert recording.end(signal.SIGINT) == 0
    assert "nothing lost" in closing(recording)
    for topic in TOPICS:
        assert numbers(tmp_path / "bag", topic) == list(range(2000))
    assert warnings(tmp_path / "bag") == ""
    assert_same(read_topics(tmp_path / "bag"), by_rosbags(tmp_path / "bag"))


def test_a_simulator_without_velocity_is_recorded_for_every_reader(tmp_path: Path) -> None:
    """rosbags refuses messages with extra bytes after an empty sequence."""
    simulator = node("simulator", publish_velocity=False)
    with running(*recorder(tmp_path), cwd=tmp_path) as recording, running(*simulator, cwd=tmp_path) as source:
        wait_recorded(tmp_path / "bag", "/joint_states", 100)
        assert source.end(signal.SIGINT) == 0
        assert recording.end(signal.SIGINT) == 0
    heard = by_rosbags(tmp_path / "bag")["/joint_states"]
    assert len(heard) >= 100
    assert all(len(message.position) == 1 and not len(message.velocity) for _, message in heard)


def test_a_recorder_that_cannot_keep_up_counts_what_it_lost(tmp_path: Path) -> None:
    """Stopped, as by a debugger, during 4 x 1500 messages: more than the system's queues can store."""
    with running(*recorder(tmp_path), cwd=tmp_path) as recording, running(*publisher(3000), cwd=tmp_path) as source:
        source.wait_for("1000")
        recording.process.send_signal(signal.SIGSTOP)
        source.wait_for("2500")
        recording.process.send_signal(signal.SIGCONT)
        source.wait_for("3000 published")
        time.sleep(1.5)  # until /diagnostics has reported it
        assert recording.end(signal.SIGTERM) == 0
    for topic in TOPICS:
        lost = re.search(rf"(\d+) on {topic}", closing(recording))
        assert lost, closing(recording)
        found = numbers(tmp_path / "bag", topic)
        assert len(found) + int(lost[1]) == 3000
        assert found == sorted(set(found))
    told = [status for array in read_topics(tmp_path / "bag")["/diagnostics"]["status"] for status in array]
    last = [one for one in told if one.name == "recorder"][-1]
    assert {value.key: value.value for value in last.values}[f"lost_on {TOPICS[0]}"] in closing(recording)
    assert "lost" in last.message


def test_a_killed_recorder_costs_no_more_than_a_second(tmp_path: Path) -> None:
    with running(*recorder(tmp_path), cwd=tmp_path) as recording, running(*publisher(20000), cwd=tmp_path) as source:
        source.wait_for("2500")
        assert recording.end(signal.SIGKILL) == -signal.SIGKILL
        killed = time.monotonic()
    safe = max(int(line) for at, line in source.lines if line.isdigit() and at < killed - 1.0)
    for topic in TOPICS:
        found = numbers(tmp_path / "bag", topic)
        assert len(found) >= safe
        assert found == list(range(len(found)))
    assert "killed" in warnings(tmp_path / "bag")
    assert_same(read_topics(tmp_path / "bag"), by_rosbags(tmp_path / "bag"))


@pytest.mark.parametrize(("option", "seed"), [([], 5), (["--volatile-description"], 6)])
def test_descriptions_sent_before_the_start_or_not_latched(tmp_path: Path, option: list[str], seed: int) -> None:
    with running(*publisher(200, *option), cwd=tmp_path) as source:
        time.sleep(1.0)
        with running(*recorder(tmp_path), cwd=tmp_path) as recording:
            source.wait_for("200 published")
            time.sleep(0.2)
            assert recording.end() == 0
    assert f'{{"seed": {seed}}}' in read_topics(tmp_path / "bag")["/description"]["data"].tolist()
    assert Bag(tmp_path / "bag").overview().channels["/description"].latched == (not option)


def test_an_axis_in_a_namespace(tmp_path: Path) -> None:
    with (
        running(*recorder(tmp_path, "-r", "__ns:=/axis_1"), cwd=tmp_path) as recording,
        running(*publisher(200, "--namespace", "/axis_1"), cwd=tmp_path) as source,
    ):
        source.wait_for("200 published")
        time.sleep(0.2)
        assert recording.end() == 0
    assert numbers(tmp_path / "bag", "/axis_1/supply/pressure") == list(range(200))


def test_topics_the_contract_does_not_know_are_found(tmp_path: Path) -> None:
    with (
        running(*recorder(tmp_path, topics=["/extra/*", "lonely"]), cwd=tmp_path) as recording,
        running(*publisher(100, "--topics", "/extra/one", "/extra/joint", "/lonely"), cwd=tmp_path) as source,
    ):
        source.wait_for("100 published")
        time.sleep(0.2)
        assert recording.end() == 0
    found = read_topics(tmp_path / "bag")
    assert set(found) == {"/extra/one", "/extra/joint", "/lonely"}
    assert found["/extra/joint"].type == "sensor_msgs/msg/JointState"
    assert found["/extra/joint"]["position"].ravel().tolist() == list(range(100))
    assert_same(found, by_rosbags(tmp_path / "bag"))


def test_a_recording_of_an_axis_reads_as_one(tmp_path: Path) -> None:
    with running(*recorder(tmp_path), cwd=tmp_path) as recording, running(*publisher(300), cwd=tmp_path) as source:
        source.wait_for("300 published")
        time.sleep(0.2)
        assert recording.end() == 0
    topics = read_topics(tmp_path / "bag")
    assert topics["/joint_states"].stamp.tolist() == [number * 1_000_000 for number in range(300)]
    read = read_recording(tmp_path / "bag")
    assert read.pressures_drive  # nothing published a command
    assert len(read.time) == 300


def test_nothing_is_overwritten_and_the_way_out_is_named(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    with running(*recorder(tmp_path), cwd=tmp_path) as recording:
        assert recording.end(None) == 3
    assert "bag exists and is not overwritten" in recording.said
    assert f"{tmp_path}/bag_2" in recording.said


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"topics": ["joint states"]}, "'joint states' cannot be the name of a topic"),
        ({"outputs": "x"}, "did you mean output"),
        ({"topics": 3}, "topics is 3; it takes a list"),
    ],
)
def test_wrong_parameters_end_with_2_and_leave_no_folder(
    tmp_path: Path, parameters: dict[str, object], words: str
) -> None:
    with running(*recorder(tmp_path, **parameters), cwd=tmp_path) as recording:
        assert recording.end(None) == 2
    assert words in recording.said
    assert not (tmp_path / "bag").exists()


def test_without_output_the_name_is_the_time(tmp_path: Path) -> None:
    with running(*node("recorder"), cwd=tmp_path) as recording:
        recording.wait_for("recording to recording_")
        assert recording.end(signal.SIGTERM) == 0
    (folder,) = tmp_path.iterdir()
    assert re.fullmatch(r"recording_\d{4}_\d\d_\d\d-\d\d_\d\d_\d\d", folder.name)
    assert "nothing lost" in closing(recording)
