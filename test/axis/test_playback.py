"""Due times of messages, their order, and which are left out: without ROS."""

import time
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.axis.ahead import BATCH, ahead
from pneumo_ros.axis.playback import Playback, Schedule
from pneumo_ros.records import Bag, BagTopic, BagWriter, encoding
from pneumo_ros.records.bag import Message
from pneumo_ros.ros.outputs import played_name

START = 1_700_000_000_000_000_000
STEP = 10_000_000  # ns


@pytest.fixture
def bag(tmp_path: Path) -> Bag:
    """A hundred numbers, one each 10 ms, and two descriptions, at 0.005 s and at 0.505 s."""
    topics = [BagTopic("/n", "std_msgs/msg/Float64"), BagTopic("/description", "std_msgs/msg/String", latched=True)]
    with BagWriter(tmp_path / "bag", topics) as writer:
        for number, payload in enumerate(encoding.numbers(np.arange(100.0))):
            writer.write("/n", START + number * STEP, payload)
            if number in (0, 50):
                writer.write("/description", START + number * STEP + STEP // 2, encoding.text(f'"{number}"'))
    return Bag(tmp_path / "bag")


def played(bag: Bag, offset: float = 0.0, rate: float = 1000.0) -> list[Message]:
    """Everything a playback sends."""
    sent: list[Message] = []
    Playback(bag, bag.overview(), lambda topic: True, rate, offset).play(sent.append, None)
    return sent


def test_everything_is_played_once_and_descriptions_first(bag: Bag) -> None:
    sent = played(bag)
    assert sent[0].channel.topic == "/description"
    assert sorted(sent, key=lambda one: one.log_time) == list(bag.messages())
    assert [one.log_time for one in sent[1:]] == sorted(one.log_time for one in sent[1:])


@pytest.mark.parametrize(
    ("offset", "said", "first"), [(0.2, '"0"', 20), (0.5049, '"0"', 51), (0.505, '"50"', 51), (0.8, '"50"', 80)]
)
def test_after_an_offset_descriptions_say_what_they_said_then(bag: Bag, offset: float, said: str, first: int) -> None:
    sent = played(bag, offset)
    assert sent[0].payload == encoding.text(said)
    numbers = [one for one in sent if one.channel.topic == "/n"]
    assert [one.log_time for one in numbers] == [START + number * STEP for number in range(first, 100)]
    assert len(sent) - len(numbers) == (2 if offset < 0.505 else 1)


def test_topics_that_are_not_wanted(bag: Bag) -> None:
    sent: list[Message] = []
    Playback(bag, bag.overview(), lambda topic: topic == "/n", 1000.0, 0.0).play(sent.append, None)
    assert {one.channel.topic for one in sent} == {"/n"}


def test_no_message_comes_before_its_time(bag: Bag) -> None:
    arrived: list[tuple[int, Message]] = []
    Playback(bag, bag.overview(), lambda topic: True, 5.0, 0.0).play(
        lambda one: arrived.append((time.monotonic_ns(), one)), None
    )
    begun, _ = arrived[0]  # the description, which is sent at once
    for at, message in arrived[1:]:
        assert at - begun >= (message.log_time - START) / 5.0


def test_a_schedule_and_its_inverse() -> None:
    schedule = Schedule(begin=START, rate=4.0, origin=1000)
    assert schedule.due(START) == 1000
    assert schedule.due(START + 4_000_000) == 1_001_000
    assert schedule.recorded(1_001_000) == START + 4_000_000


def test_the_clock_ticks_through_the_recording(bag: Bag) -> None:
    ticks: list[int] = []
    Playback(bag, bag.overview(), lambda topic: True, 4.0, 0.2).play(lambda message: None, ticks.append)
    assert ticks[0] == START + 200_000_000
    assert ticks == sorted(ticks)
    assert set(np.diff(ticks)) == {40_000_000}  # a hundred times a second, at four times the speed
    assert ticks[-1] >= START + 99 * STEP - 40_000_000


def test_a_playback_can_be_stopped(bag: Bag) -> None:
    playback = Playback(bag, bag.overview(), lambda topic: True, 0.01, 0.0)

    def stop_at_the_third(message: Message) -> None:
        if playback.sent == 2:
            playback.stop.set()

    playback.play(stop_at_the_third, None)
    assert playback.sent == 3


@pytest.mark.parametrize("items", [0, 1, BATCH, 10 * BATCH + 3])
def test_reading_ahead_changes_nothing(items: int) -> None:
    assert list(ahead(range(items), batches=2)) == list(range(items))


def test_reading_ahead_reports_errors() -> None:
    def broken() -> object:
        yield 1
        raise OSError("the disk is gone")

    read = ahead(broken())
    with pytest.raises(OSError, match="the disk is gone"):
        list(read)


def test_reading_ahead_ends_with_its_reader() -> None:
    taken: list[int] = []
    read = ahead((taken.append(number) or number for number in count()), batches=1)
    assert [next(read) for _ in range(3)] == [0, 1, 2]
    read.close()
    time.sleep(0.3)
    seen = len(taken)
    time.sleep(0.3)
    assert len(taken) == seen


@pytest.mark.parametrize(
    ("topic", "namespace", "several", "name"),
    [
        ("/axis/joint_states", "/", False, "/axis/joint_states"),
        ("joint_states", "/", False, "/joint_states"),
        ("/axis/joint_states", "/replay", False, "joint_states"),
        ("joint_states", "/replay", False, "joint_states"),
        ("/left/joint_states", "/replay", True, "left/joint_states"),
        ("/joint_states", "/replay", True, "joint_states"),
        ("/diagnostics", "/replay", False, "/diagnostics"),
        ("/tf", "/replay", False, "/tf"),
        ("extra", "/replay", False, "extra"),
    ],
)
def test_names_under_which_topics_are_played(topic: str, namespace: str, several: bool, name: str) -> None:
    assert played_name(topic, namespace, several) == name
