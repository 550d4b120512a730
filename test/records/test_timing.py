"""One time base: irregular stamps, gaps, topics that start later or run on another clock."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import RNG, SIGNALS, STAMP, START, TIME, VOLTAGE, N, streams, without, write, write_in_order

from pneumo_ros.errors import DataError
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
    # still recorded in order, as by a live recorder
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


SECOND = 1_000_000_000
HALF = np.where(np.arange(N) < 150, 0, SECOND)  # added from message 150 on, times a number of seconds


@pytest.mark.parametrize(
    ("stamps", "recorded", "words"),
    [
        (-3600, 0, "stamps jump by -3599.999 s while recorded times go on by 0.001 s at message 150 of 400"),
        (3, 0, "stamps jump by +3.001 s while recorded times go on by 0.001 s"),
        (-5, -5, "stamps and recorded times jump by -4.999 s together"),
        (7200, 7200, "nothing is recorded for 7200.001 s (recording paused, or clock set forward)"),
        (0, -20, "recorded times jump by -19.999 s while the stamps go on"),
        (-0.2, -0.2, "stamps and recorded times jump by -0.199 s together"),
        (-0.2, 0, "stamps jump by -0.199 s while recorded times go on by 0.001 s"),
    ],
)
def test_clocks_that_were_set(tmp_path: Path, stamps: float, recorded: float, words: str) -> None:
    """The longest part without a jump is used, with the commands of that part, and this is reported."""
    stamp, log = ((STAMP + HALF * shift).astype(np.int64) for shift in (stamps, recorded))
    recording = read_recording(write_in_order(tmp_path / "run", streams(stamp, log)))
    assert len(recording) == N - 150
    assert recording.start_ns == stamp[150]
    np.testing.assert_array_equal(recording.position, SIGNALS["position"][150:])
    np.testing.assert_array_equal(recording.pressure_a, SIGNALS["pressure_a"][150:])
    np.testing.assert_array_equal(recording.voltage, VOLTAGE[150:])
    assert [words in warning for warning in recording.warnings].count(True) == 1, recording.warnings
    assert any("250 messages, 0.249 s" in warning for warning in recording.warnings)


def test_the_command_before_the_clock_was_set_back_stays_in_force(tmp_path: Path) -> None:
    log = STAMP - 5 * HALF
    content = streams(log, log)
    content[COMMAND] = without(content[COMMAND], *range(100, 200))
    recording = read_recording(write_in_order(tmp_path / "run", content))
    np.testing.assert_array_equal(recording.voltage, np.where(np.arange(150, N) < 200, VOLTAGE[99], VOLTAGE[150:]))


def test_recorded_times_that_jump_forward_do_not_matter(tmp_path: Path) -> None:
    recording = read_recording(write_in_order(tmp_path / "run", streams(STAMP, STAMP + 60 * HALF)))
    assert len(recording) == N
    np.testing.assert_array_equal(recording.voltage, VOLTAGE)
    assert any("+0.000 s to +60.000 s apart" in warning for warning in recording.warnings)


def test_a_stray_stamp_costs_its_message_only(tmp_path: Path) -> None:
    stamp = STAMP.copy()
    stamp[200] += 3600 * SECOND
    content = streams(STAMP)
    content |= {name: (STAMP, rows) for name, (_, rows) in streams(stamp).items()}
    recording = read_recording(write_in_order(tmp_path / "run", content))
    assert len(recording) == N - 1
    assert any("joint_states: 1 of 400 messages have a stamp far from" in warning for warning in recording.warnings)


def test_pressures_stamped_by_another_clock(tmp_path: Path) -> None:
    content = streams()
    content[PRESSURE_B] = (STAMP, streams(STAMP + SECOND // 5)[PRESSURE_B][1])
    said = " ".join(read_recording(write_in_order(tmp_path / "near", content)).warnings)
    assert "chamber_b/pressure: its stamps are +0.200 s off from those of /joint_states" in said
    content[PRESSURE_B] = (STAMP, streams(STAMP + 3600 * SECOND)[PRESSURE_B][1])
    with pytest.raises(DataError, match=r"do not overlap.*chamber_b/pressure 3600.000 to 3600.399 s.*synchronise"):
        read_recording(write_in_order(tmp_path / "far", content))


def test_what_lies_in_a_gap_of_the_pressures_is_not_made_up(tmp_path: Path) -> None:
    content = streams()
    content[PRESSURE_A] = without(content[PRESSURE_A], *range(50, 70))
    recording = read_recording(write(tmp_path / "run", content))
    np.testing.assert_array_equal(recording.time, np.delete(TIME, range(50, 70)))
    np.testing.assert_array_equal(recording.pressure_a, np.delete(SIGNALS["pressure_a"], range(50, 70)))
    said = " ".join(recording.warnings)
    assert "/chamber_a/pressure: 1 gap of more than 5 sample times (5 ms), the longest 0.021 s at 0.049 s" in said
    assert "interpolated" not in said
