"""One time base: stamps that stumble, gaps, topics that start later or run on another clock."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import RNG, STAMP, START, TIME, VOLTAGE, N, streams, without, write

from pneumo_ros.records import encoding, read_recording
from pneumo_ros.records.contract import COMMAND, PRESSURE_A, PRESSURE_B


def test_a_command_a_little_after_its_sample_counts_from_it(tmp_path: Path) -> None:
    content = streams()
    jitter = RNG.integers(-50_000, 50_000, N)
    content[COMMAND] = (STAMP + jitter, content[COMMAND][1])
    recording = read_recording(write(tmp_path / "run", content))
    np.testing.assert_array_equal(recording.voltage, VOLTAGE)


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
