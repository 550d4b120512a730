"""Recordings of other programs: topics with other names and types take the place of the contract's."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import SIGNALS, STAMP, TIME, VOLTAGE, streams
from rosbags.typesys import Stores, get_typestore

from pneumo_ros.command.main import main
from pneumo_ros.errors import DataError
from pneumo_ros.records import BagTopic, BagWriter, encoding, read_recording

STORE = get_typestore(Stores.ROS2_JAZZY)
NUMBER, ARRAY, JOINT = "std_msgs/msg/Float64", "std_msgs/msg/Float64MultiArray", "sensor_msgs/msg/JointState"
TOPICS = {
    "joint_states": "/plc/encoder", "chamber_a/pressure": "/plc/values:data[1]",
    "chamber_b/pressure": "plc/values:data[0]", "valve/command": "/plc/valve",
}  # fmt: skip


@pytest.fixture
def foreign(tmp_path: Path) -> Path:
    """A bag of numbers without stamps: position, both pressures in one array, command."""
    kind, layout = STORE.types[ARRAY], STORE.types["std_msgs/msg/MultiArrayLayout"]
    rows = np.stack([SIGNALS["pressure_b"], SIGNALS["pressure_a"]], axis=1)
    arrays = [bytes(STORE.serialize_cdr(kind(layout(dim=[], data_offset=0), row), ARRAY)) for row in rows]
    content = {
        "/plc/encoder": (NUMBER, encoding.numbers(SIGNALS["position"])), "/plc/values": (ARRAY, arrays),
        "/plc/valve": (NUMBER, encoding.numbers(VOLTAGE)),
    }  # fmt: skip
    path = tmp_path / "plc"
    with BagWriter(path, [BagTopic(topic, kind) for topic, (kind, _) in content.items()]) as writer:
        for k, stamp in enumerate(STAMP.tolist()):
            for topic, (_, messages) in content.items():
                writer.write(topic, stamp, messages[k])
    return path


def test_numbers_of_other_types_become_the_signals_at_their_recorded_times(foreign: Path) -> None:
    found = read_recording(foreign, topics=TOPICS)
    np.testing.assert_array_equal(found.position, SIGNALS["position"])
    np.testing.assert_array_equal(found.pressure_a, SIGNALS["pressure_a"])
    np.testing.assert_array_equal(found.pressure_b, SIGNALS["pressure_b"])
    np.testing.assert_array_equal(found.voltage, VOLTAGE)
    np.testing.assert_allclose(found.time, TIME, atol=1e-9)
    assert found.velocity is None
    assert found.effort is None


def test_a_topic_of_the_contract_s_type_keeps_its_stamps(tmp_path: Path) -> None:
    usual = streams(log=STAMP + 3_000_000)
    with BagWriter(tmp_path / "renamed", []) as writer:
        for name, (times, rows) in usual.items():
            topic = "/arm/encoder" if name == "joint_states" else f"/axis/{name}"
            kinds = {"joint_states": JOINT, "valve/command": NUMBER}
            writer.add_topic(BagTopic(topic, kinds.get(name, "sensor_msgs/msg/FluidPressure")))
            times = STAMP if name == "valve/command" else times
            for time, row in zip(times.tolist(), rows, strict=True):
                writer.write(topic, time, row)
    found = read_recording(tmp_path / "renamed", "axis", topics={"joint_states": "/arm/encoder"})
    assert found.start_ns == STAMP[0]
    np.testing.assert_array_equal(found.pressure_b, SIGNALS["pressure_b"])


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"joint_states": "/plc/encodr"}, "did you mean /plc/encoder"),
        ({"joint_states": "/plc/encoder:dta"}, "did you mean data"),
        ({"chamber_a/pressure": "/plc/values"}, "say which of its fields is the chamber_a/pressure"),
        ({"chamber_a/pressure": "/plc/values:data"}, r"holds 2 numbers; say which, such as /plc/values:data\[0\]"),
        ({"chamber_a/pressure": "/plc/values:data[2]"}, "holds 2 numbers"),
    ],
)
def test_what_a_recording_does_not_hold_is_named(foreign: Path, change: dict[str, str], sentence: str) -> None:
    with pytest.raises(DataError, match=sentence):
        read_recording(foreign, topics=TOPICS | change)


def test_a_rig_file_gives_the_topics_to_a_verb(
    foreign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [f'    {name}: "{topic}"' for name, topic in TOPICS.items()]
    Path("rig.yaml").write_text("\n".join(["rig:", "  topics:", *lines]) + "\n")
    assert main(["view", str(foreign), "--rig", "rig.yaml"]) in (0, 1)
    assert "position" in capsys.readouterr().out
    assert main(["view", str(foreign)]) == 3
