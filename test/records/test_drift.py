"""Clocks that run at other rates than the joint states' or the recorder's: found, corrected and said."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import START, streams, write

from pneumo_ros.records import encoding, read_recording
from pneumo_ros.records.contract import COMMAND, JOINT_STATES, PRESSURE_A, PRESSURE_B
from pneumo_ros.records.drift import least_delays
from pneumo_ros.records.recording import Recording
from pneumo_ros.records.series import Series

M = 8000
SECONDS = np.arange(M) * 1e-3
RAMP = 2e5 + 1e4 * SECONDS  # Pa: shows the time at which it was measured
EVERY = slice(None, None, 40)


def recorded(path: Path, joints: float = 1.0, pressures: float = 1.0) -> Recording:
    """Eight seconds in which the clocks of joint states and pressures run faster by a factor than the recorder's.

    What is sent arrives 0.3 to about 2 ms later.
    """
    random = np.random.default_rng(11)
    true = START + np.rint(SECONDS * 1e9).astype(np.int64)

    def log() -> np.ndarray:
        return np.maximum.accumulate(true + 300_000 + np.rint(4e5 * random.exponential(size=M)).astype(np.int64))

    by_joints, by_pressures = (START + np.rint(SECONDS * rate * 1e9).astype(np.int64) for rate in (joints, pressures))
    position = {"position": 0.01 * SECONDS, "velocity": None, "effort": None}
    content = {
        JOINT_STATES: (log(), encoding.joint_states(by_joints, "piston", position)),
        PRESSURE_A: (log(), encoding.pressures(by_pressures, RAMP, 0.0)),
        PRESSURE_B: (log(), encoding.pressures(by_pressures, RAMP, 0.0)),
        COMMAND: (true[EVERY] + 300_000, encoding.numbers(SECONDS[EVERY])),
    }
    return read_recording(write(path / "run", content))


def test_clocks_of_one_rate_are_left_alone(tmp_path: Path) -> None:
    found = recorded(tmp_path)
    assert not [w for w in found.warnings if "clock runs" in w or "stamps run" in w]
    np.testing.assert_array_equal(found.pressure_a, RAMP[-len(found) :])
    assert read_recording(write(tmp_path / "short", streams())).warnings == ()


@pytest.mark.parametrize("rate", [1.002, 0.998, 1.0005])
def test_the_pressures_clock_is_brought_to_the_joint_states(tmp_path: Path, rate: float) -> None:
    found = recorded(tmp_path, pressures=rate)
    word = "faster" if rate > 1.0 else "slower"
    said = [w for w in found.warnings if f"{100 * abs(rate - 1):.2g} % {word} than that of /joint_states" in w]
    assert len(said) == 2, found.warnings
    off = (found.pressure_a - RAMP.min()) / 1e4 - found.position / 0.01  # s
    assert np.abs(off[10:-10]).max() < 3e-4


@pytest.mark.parametrize("rate", [1.002, 0.998])
def test_commands_are_placed_on_the_joint_states_clock(tmp_path: Path, rate: float) -> None:
    found = recorded(tmp_path, joints=rate, pressures=rate)
    assert [w for w in found.warnings if "/joint_states: its stamps run 0.2 %" in w]
    assert found.command is not None
    assert found.command_time is not None
    late = found.command_time - rate * found.command + (SECONDS[0] - found.time[0])
    assert np.abs(late - late.mean()).max() < 3e-4
    assert abs(late.mean()) < 2e-3


def test_a_slope_has_an_error() -> None:
    random = np.random.default_rng(2)
    stamp = START + np.arange(M) * 1_000_000
    delay = np.rint(1e6 * random.exponential(size=M)).astype(np.int64)
    line = least_delays(Series("x", stamp, stamp + delay, {}))
    assert line is not None
    assert abs(line.slope) < 5.0 * line.error
    drifting = least_delays(Series("x", stamp, stamp + delay + np.arange(M) * 500, {}))
    assert drifting is not None
    assert drifting.slope == pytest.approx(5e-4, abs=5.0 * drifting.error)
    assert least_delays(Series("x", stamp[:50], stamp[:50], {})) is None
