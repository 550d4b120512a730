"""The player as a process, recorded again: the messages are the same."""

import signal
import time
from pathlib import Path

import numpy as np
import pytest
from ros.processes import Running, node, running, wait_recorded

from pneumo_ros.records import Bag, BagTopic, BagWriter, encoding, read_recording, read_topics, write_recording

N = 1500
TIME = np.arange(N) / 1000
RNG = np.random.default_rng(4)
SIGNALS = {name: RNG.normal(size=N) for name in ("position", "velocity", "effort", "pressure_a", "pressure_b")}
VOLTAGE = np.repeat(RNG.normal(size=N // 30), 30)
DESCRIPTION = {"schema_version": 1, "seed": 7}


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """1.5 s of an axis at 1 kHz, with a description at its start."""
    write_recording(
        tmp_path / "source", time=TIME, voltage=VOLTAGE, description=DESCRIPTION, namespace="/axis", **SIGNALS
    )
    return tmp_path / "source"


def payloads(path: Path) -> dict[str, list[bytes]]:
    """Bytes of every message, per topic: padded to whole words, as by the middleware."""
    found: dict[str, list[bytes]] = {}
    for message in Bag(path).messages():
        filled = message.payload + bytes(-len(message.payload) % 4)
        found.setdefault(message.channel.topic, []).append(filled)
    return found


def replay(folder: Path, player: list[str], topics: list[str], end: int | None = None, count: int = 0) -> Running:
    """Run a player and a recorder of `topics` into folder/copy; the player ends by itself, or by signal `end` when
    `count` messages of the first topic have come.
    """
    recorder = node("recorder", output=folder / "copy", topics=topics)
    with running(*recorder, cwd=folder) as copying:
        copying.wait_for("recording to")
        with running(*player, cwd=folder) as playing:
            if end is not None:
                wait_recorded(folder / "copy", topics[0], count)
            assert playing.end(end) == 0, playing.said
        time.sleep(0.3)
        assert copying.end() == 0
        assert "nothing lost" in copying.said, copying.said
    return playing


def test_what_was_recorded_comes_again(tmp_path: Path, recording: Path) -> None:
    playing = replay(tmp_path, node("player", input=recording), ["/axis/*"])
    assert payloads(tmp_path / "copy") == payloads(recording)
    assert f"played {sum(Bag(recording).overview().counts.values())} messages" in playing.said
    copy = read_recording(tmp_path / "copy")
    assert len(copy) > N // 2
    np.testing.assert_array_equal(copy.position, SIGNALS["position"][-len(copy) :])
    assert copy.description == DESCRIPTION
    assert Bag(tmp_path / "copy").overview().channels["/axis/description"].latched


def test_a_recording_without_slashes_in_another_namespace(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "source", [BagTopic("valve/command", "std_msgs/msg/Float64")]) as writer:
        for number, payload in enumerate(encoding.numbers(np.arange(50.0))):
            writer.write("valve/command", number * 1_000_000, payload)
    remap = ["-r", "__ns:=/replay", "-r", "valve/command:=voltage"]
    replay(tmp_path, node("player", *remap, input=tmp_path / "source"), ["/replay/*"])
    assert payloads(tmp_path / "copy") == {"/replay/voltage": encoding.numbers(np.arange(50.0))}


def test_descriptions_come_in_spite_of_an_offset(tmp_path: Path, recording: Path) -> None:
    replay(tmp_path, node("player", input=recording, start_offset=1.0), ["/axis/description", "/axis/joint_states"])
    copy = payloads(tmp_path / "copy")
    assert copy["/axis/joint_states"] == payloads(recording)["/axis/joint_states"][1000:]
    assert copy["/axis/description"] == payloads(recording)["/axis/description"]


def test_late_subscribers_get_the_description(tmp_path: Path, recording: Path) -> None:
    with running(*node("player", input=recording, wait=0.0, rate=0.1), cwd=tmp_path) as playing:
        playing.wait_for("playing")
        time.sleep(1.0)
        with running(
            *node("recorder", output=tmp_path / "copy", topics=["/axis/description"]), cwd=tmp_path
        ) as copying:
            wait_recorded(tmp_path / "copy", "/axis/description", 1)
            assert copying.end() == 0
        assert playing.end(signal.SIGTERM) == 0
    assert payloads(tmp_path / "copy") == {"/axis/description": payloads(recording)["/axis/description"]}


def test_a_loop_goes_on_until_it_is_asked_to_end(tmp_path: Path, recording: Path) -> None:
    player = node("player", input=recording, loop=True, rate=5, topics=["/axis/joint_states"], wait=10)
    once = payloads(recording)["/axis/joint_states"]
    playing = replay(tmp_path, player, ["/axis/joint_states"], end=signal.SIGINT, count=2 * len(once) + 1)
    copy = payloads(tmp_path / "copy")["/axis/joint_states"]
    assert len(copy) > 2 * len(once)
    assert copy == (once * 50)[: len(copy)]
    assert f"played {len(copy)} messages" in playing.said


def test_the_recorded_time_on_clock(tmp_path: Path, recording: Path) -> None:
    replay(tmp_path, node("player", input=recording, publish_clock=True), ["/clock", "/axis/*"])
    clock = read_topics(tmp_path / "copy")["/clock"]
    ticks = clock["clock.sec"].astype(np.int64) * 10**9 + clock["clock.nanosec"]
    overview = Bag(recording).overview()
    assert ticks[0] == overview.start
    assert np.all(np.diff(ticks) == 10_000_000)
    assert overview.end - ticks[-1] <= 10_000_000


@pytest.mark.parametrize(
    ("parameters", "code", "words"),
    [
        ({}, 2, "no recording given"),
        ({"input": "sourse"}, 3, "did you mean source"),
        ({"input": "source", "start_offset": 2.0}, 2, "the recording lasts 1.499 s"),
        ({"input": "source", "topics": ["/axis/joint_state"]}, 3, "did you mean /axis/joint_states"),
        ({"input": "source", "rate": 0.0}, 2, "rate is 0.0; allowed is 0.001 to 1000"),
        ({"input": "source", "speed": 2.0}, 2, "unknown parameter 'speed'"),
    ],
)
def test_wrong_parameters(
    tmp_path: Path, recording: Path, parameters: dict[str, object], code: int, words: str
) -> None:
    assert recording.exists()
    with running(*node("player", **parameters), cwd=tmp_path) as playing:
        assert playing.end(None) == code
    assert words in playing.said


def test_types_that_are_not_installed_are_left_out(tmp_path: Path) -> None:
    types = ["std_msgs/msg/Float64", "nav_msgs/msg/OccupancyGrid"]
    with BagWriter(tmp_path / "source", [BagTopic(f"/{kind[:3]}", kind) for kind in types]) as writer:
        writer.write("/std", 0, encoding.numbers(np.ones(1))[0])
        writer.write("/nav", 1, b"\0\1\0\0")
    replay_said = replay(tmp_path, node("player", input=tmp_path / "source"), ["/std", "/nav"]).said
    assert "/nav is not played: nav_msgs/msg/OccupancyGrid is not installed" in replay_said
    assert payloads(tmp_path / "copy") == {"/std": encoding.numbers(np.ones(1))}
