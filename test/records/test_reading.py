"""From a recording to signals: required topics, left-out messages, and their reports."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from records.axis_bag import SIGNALS, STAMP, START, TIME, VOLTAGE, N, streams, write

from pneumo_ros.errors import DataError
from pneumo_ros.records import encoding, read_recording, write_recording
from pneumo_ros.records.contract import COMMAND, DESCRIPTION, JOINT_STATES, PRESSURE_A, PRESSURE_B, TYPES


def test_arrays_come_back_as_they_were_written(tmp_path: Path) -> None:
    description = {"schema_version": 1, "model": {"effects": ["dead_zone"]}}
    write_recording(
        tmp_path / "run", time=TIME, voltage=VOLTAGE, description=description, start_ns=START, namespace="/axis_1",
        joint_name="rod", **SIGNALS,
    )  # fmt: skip
    recording = read_recording(tmp_path / "run")
    for name, values in {"time": TIME, "voltage": VOLTAGE, **SIGNALS}.items():
        np.testing.assert_array_equal(getattr(recording, name), values, err_msg=name)
    assert (recording.name, recording.namespace, recording.joint_name) == ("run", "axis_1", "rod")
    assert (recording.start_ns, recording.description, recording.warnings) == (START, description, ())
    assert recording.sample_time == pytest.approx(1e-3)
    assert recording.duration == TIME[-1]
    assert not recording.force_driven


def test_commands_come_back_as_they_were_written(tmp_path: Path) -> None:
    times, values = np.array([0.0, 0.0105, 0.2]), np.array([1.0, -2.0, 3.0])
    signals = {name: SIGNALS[name] for name in ("position", "pressure_a", "pressure_b")}
    write_recording(tmp_path / "run", time=TIME, command_time=times, command=values, **signals)
    recording = read_recording(tmp_path / "run")
    np.testing.assert_allclose(recording.command_time, times, atol=1e-9)
    np.testing.assert_array_equal(recording.command, values)
    # held: the second one, between samples 10 and 11, counts from sample 11
    np.testing.assert_array_equal(recording.voltage, np.select([TIME < 0.0105, TIME < 0.2], [1.0, -2.0], 3.0))


def test_commands_of_two_valves_come_back(tmp_path: Path) -> None:
    signals = {name: SIGNALS[name] for name in ("position", "pressure_a", "pressure_b")}
    second = {"command_b_time": np.array([0.0, 0.0305]), "command_b": np.array([5.0, 7.0])}
    write_recording(tmp_path / "run", time=TIME, voltage=VOLTAGE, **second, **signals)
    recording = read_recording(tmp_path / "run")
    np.testing.assert_allclose(recording.command_b_time, second["command_b_time"], atol=1e-9)
    np.testing.assert_array_equal(recording.command_b, second["command_b"])
    np.testing.assert_array_equal(recording.voltage, VOLTAGE)


def test_a_rig_without_velocity_and_effort(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "run", streams()))
    assert recording.velocity is None
    assert recording.effort is None
    assert recording.supply_pressure is None
    assert recording.warnings == ()
    np.testing.assert_array_equal(recording.pressure_b, SIGNALS["pressure_b"])


def test_a_force_driven_axis(tmp_path: Path) -> None:
    write_recording(tmp_path / "run", time=TIME, position=SIGNALS["position"], effort=SIGNALS["effort"])
    recording = read_recording(tmp_path / "run")
    assert recording.force_driven
    assert recording.voltage is None
    assert recording.pressure_a is None
    np.testing.assert_array_equal(recording.effort, SIGNALS["effort"])


def test_pressures_alone_tell_the_drive(tmp_path: Path) -> None:
    content = streams()
    del content[COMMAND]
    assert read_recording(write(tmp_path / "run", content)).pressures_drive


@pytest.mark.parametrize(
    ("lost", "said"),
    [
        ((PRESSURE_A, PRESSURE_B), f"lacks {PRESSURE_A} and {PRESSURE_B}"),
        ((COMMAND, PRESSURE_A, PRESSURE_B), "effort in joint_states"),
        ((JOINT_STATES,), "is missing"),
    ],
)
def test_what_is_missing_is_named(tmp_path: Path, lost: tuple[str, ...], said: str) -> None:
    content = {name: stream for name, stream in streams().items() if name not in lost}
    path = write(tmp_path / "run", content, "/axis")
    with pytest.raises(DataError, match=said) as caught:
        read_recording(path)
    assert all(f"/axis/{name}" in str(caught.value) for name in streams() if name not in lost)  # the existing names
    assert "Needed: joint_states, chamber_a/pressure" in str(caught.value)


def test_values_that_are_not_finite_are_named_and_left_out(tmp_path: Path) -> None:
    position, pressure = SIGNALS["position"].copy(), SIGNALS["pressure_a"].copy()
    position[[3, 5]] = np.nan
    pressure[7] = np.inf
    velocity = SIGNALS["velocity"].copy()
    velocity[9] = np.nan
    signals = {**SIGNALS, "position": position, "pressure_a": pressure, "velocity": velocity}
    write_recording(tmp_path / "run", time=TIME, voltage=VOLTAGE, **signals)
    recording = read_recording(tmp_path / "run")
    assert len(recording) == N - 2
    assert np.isfinite(recording.position).all()
    assert np.isfinite(recording.pressure_a).all()
    assert recording.velocity is None
    said = " ".join(recording.warnings)
    assert "2 of 400 values of position are not finite (first at 0.003 s)" in said
    assert "1 of 400 values of fluid_pressure" in said
    assert "1 of 398 values of velocity" in said


@pytest.mark.parametrize("text", ["{", "[1]", "3"])
def test_an_invalid_description(tmp_path: Path, text: str) -> None:
    content = streams()
    content[DESCRIPTION] = (STAMP[:1], [encoding.text(text)])
    recording = read_recording(write(tmp_path / "run", content))
    assert recording.description is None
    assert any("no JSON object" in warning for warning in recording.warnings)


def test_the_last_description_counts(tmp_path: Path) -> None:
    content = streams()
    content[DESCRIPTION] = (STAMP[:2], [encoding.text('{"seed": 1}'), encoding.text('{"seed": 2}')])
    assert read_recording(write(tmp_path / "run", content)).description == {"seed": 2}


def test_a_topic_of_another_type(tmp_path: Path) -> None:
    content = streams()
    content[COMMAND] = (STAMP[:1], [encoding.text("1.0")])
    types: dict[str, Any] = {**TYPES, COMMAND: "std_msgs/msg/String"}
    with pytest.raises(
        DataError, match="valve/command was recorded as std_msgs/msg/String; it must be std_msgs/msg/Float64"
    ):
        read_recording(write(tmp_path / "run", content, types=types))


def test_a_topic_under_another_name_is_pointed_at(tmp_path: Path) -> None:
    content = streams()
    content["rod_side"] = content.pop(PRESSURE_B)
    path = write(tmp_path / "run", content, "/axis", {**TYPES, "rod_side": TYPES[PRESSURE_A]})
    with pytest.raises(DataError, match="lacks chamber_b/pressure") as caught:
        read_recording(path)
    assert "player --ros-args -p input:=" in str(caught.value)
    assert str(caught.value).endswith("-r /axis/rod_side:=/axis/chamber_b/pressure")
