"""From a recording to signals on one time base: which topics, which times, and words about what is wrong."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pneumo_ros.errors import DataError
from pneumo_ros.records import BagTopic, BagWriter, encoding, read_recording, write_recording
from pneumo_ros.records.contract import COMMAND, DESCRIPTION, JOINT_STATES, PRESSURE_A, PRESSURE_B, TYPES

START = 1_700_000_000_000_000_000
N = 400
TIME = np.arange(N) / 1000
STAMP = START + np.arange(N) * 1_000_000
RNG = np.random.default_rng(7)
SIGNALS = {
    name: RNG.normal(size=N)
    for name in ("position", "velocity", "effort", "pressure_a", "pressure_b", "supply_pressure")
}
VOLTAGE = np.repeat(RNG.normal(size=N // 20), 20)
Streams = dict[str, tuple[np.ndarray, list[bytes]]]  # contract name -> recorded times [ns], messages


def streams(stamp: np.ndarray = STAMP, log: np.ndarray | None = None) -> Streams:
    """A rig that measures position and both pressures, every message recorded at its stamp or at `log`."""
    log = stamp if log is None else log
    position, variance = SIGNALS["position"], 9e4
    return {
        JOINT_STATES: (
            log,
            encoding.joint_states(stamp, "piston", {"position": position, "velocity": None, "effort": None}),
        ),
        PRESSURE_A: (log, encoding.pressures(stamp, SIGNALS["pressure_a"], variance)),
        PRESSURE_B: (log, encoding.pressures(stamp, SIGNALS["pressure_b"], variance)),
        COMMAND: (log, encoding.numbers(VOLTAGE)),
    }


def write(path: Path, content: Streams, namespace: str = "", types: dict[str, str] = TYPES) -> Path:
    """A bag of `content` under `namespace`."""
    messages = [
        (int(t), f"{namespace}/{name}", data)
        for name, (times, rows) in content.items()
        for t, data in zip(times, rows, strict=True)
    ]
    with BagWriter(path, [BagTopic(f"{namespace}/{name}", types[name]) for name in content]) as writer:
        for log_time, topic, data in sorted(messages, key=lambda message: message[0]):
            writer.write(topic, log_time, data)
    return path


def without(series: tuple[np.ndarray, list[bytes]], *missing: int) -> tuple[np.ndarray, list[bytes]]:
    """A stream that lost some of its messages."""
    kept = [index for index in range(len(series[0])) if index not in missing]
    return series[0][kept], [series[1][index] for index in kept]


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


def test_a_rig_without_velocity_and_effort(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "run", streams()))
    assert recording.velocity is None
    assert recording.effort is None
    assert recording.supply_pressure is None
    assert recording.warnings == ()
    np.testing.assert_array_equal(recording.pressure_b, SIGNALS["pressure_b"])


def test_a_command_a_little_after_its_sample_counts_from_it(tmp_path: Path) -> None:
    content = streams()
    jitter = RNG.integers(-50_000, 50_000, N)
    content[COMMAND] = (STAMP + jitter, content[COMMAND][1])
    recording = read_recording(write(tmp_path / "run", content))
    np.testing.assert_array_equal(recording.voltage, VOLTAGE)


def test_a_force_driven_axis(tmp_path: Path) -> None:
    write_recording(tmp_path / "run", time=TIME, position=SIGNALS["position"], effort=SIGNALS["effort"])
    recording = read_recording(tmp_path / "run")
    assert recording.force_driven
    assert recording.voltage is None
    assert recording.pressure_a is None
    np.testing.assert_array_equal(recording.effort, SIGNALS["effort"])


@pytest.mark.parametrize(
    ("lost", "said"),
    [(PRESSURE_A, PRESSURE_A), (COMMAND, "effort in joint_states"), (JOINT_STATES, "joint_states is missing")],
)
def test_what_is_missing_is_named(tmp_path: Path, lost: str, said: str) -> None:
    content = streams()
    del content[lost]
    path = write(tmp_path / "run", content, "/axis")
    with pytest.raises(DataError, match=said) as caught:
        read_recording(path)
    assert "/axis/chamber_b/pressure" in str(caught.value)  # what there is
    assert "Needed: joint_states, chamber_a/pressure" in str(caught.value)


def test_stamps_that_do_not_increase_are_dropped_and_counted(tmp_path: Path) -> None:
    stamp = STAMP.copy()
    stamp[100] = stamp[99]
    stamp[200:202] = stamp[150]
    content = streams(stamp)
    # recorded in order all the same, as a live recorder would
    recording = read_recording(write(tmp_path / "run", {name: (STAMP, rows) for name, (_, rows) in content.items()}))
    assert np.all(np.diff(recording.time) > 0)
    assert len(recording) == N - 3
    assert any("joint_states: 3 of 400" in warning and "2 repeat" in warning for warning in recording.warnings)


def test_gaps_are_named(tmp_path: Path) -> None:
    content = {name: without(series, *range(50, 70)) for name, series in streams().items()}
    warnings = read_recording(write(tmp_path / "run", content)).warnings
    assert any("joint_states: 1 gap" in warning and "0.021 s at 0.049 s" in warning for warning in warnings)


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


def test_pressures_with_other_stamps_are_interpolated(tmp_path: Path) -> None:
    content = streams()
    shifted = STAMP[::4] + 300_000
    ramp = 1e5 + (shifted - START) * 1e-3
    content[PRESSURE_A] = (shifted, encoding.pressures(shifted, ramp, 0.0))
    recording = read_recording(write(tmp_path / "run", content))
    inside = (recording.time > 0.001) & (recording.time < 0.396)
    np.testing.assert_allclose(recording.pressure_a[inside], 1e5 + recording.time[inside] * 1e6, rtol=1e-9)
    assert any("chamber_a/pressure" in warning and "interpolated" in warning for warning in recording.warnings)


def test_what_the_pressures_or_commands_do_not_cover_is_cut(tmp_path: Path) -> None:
    content = streams()
    content[PRESSURE_B] = without(content[PRESSURE_B], *range(30), *range(380, N))
    content[COMMAND] = without(content[COMMAND], *range(50))
    recording = read_recording(write(tmp_path / "run", content))
    assert recording.start_ns == STAMP[50]
    assert len(recording) == 381 - 50  # a pressure holds for one sample
    np.testing.assert_array_equal(recording.voltage, VOLTAGE[50:381])
    assert any("0.050 s at the start" in warning for warning in recording.warnings)


@pytest.mark.parametrize("rate", [1.0, 0.25])
def test_commands_on_another_clock_are_placed_by_the_joint_states(tmp_path: Path, rate: float) -> None:
    """Simulated time starts at zero and runs at a rate of its own; commands have only the recorded time."""
    simulated = (STAMP - START) // 1 + 5_000_000
    recorded = START + ((STAMP - START) / rate).astype(np.int64)
    recording = read_recording(write(tmp_path / "run", streams(simulated, recorded)))
    np.testing.assert_array_equal(recording.voltage, VOLTAGE)
    assert recording.start_ns == 5_000_000
    assert any("different clocks" in warning for warning in recording.warnings)


def test_joint_states_without_stamps_are_timed_by_the_recorder(tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "run", streams(np.zeros(N, dtype=np.int64), STAMP)))
    np.testing.assert_allclose(recording.time, TIME, atol=1e-12)
    assert any("all header stamps are equal" in warning for warning in recording.warnings)


@pytest.mark.parametrize("text", ["{", "[1]", "3"])
def test_a_description_that_is_none(tmp_path: Path, text: str) -> None:
    content = streams()
    content[DESCRIPTION] = (STAMP[:1], [encoding.text(text)])
    recording = read_recording(write(tmp_path / "run", content))
    assert recording.description is None
    assert any("no JSON" in warning for warning in recording.warnings)


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
