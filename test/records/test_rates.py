"""Signals at a lower rate: what is too fast for it is filtered out; uneven clocks are said."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from identify.making import recording
from records.axis_bag import STAMP, START, streams, write

from pneumo_ros.records import encoding, read_recording
from pneumo_ros.records.contract import PRESSURE_A
from pneumo_ros.records.rates import thinned


def test_pressures_faster_than_the_joint_states_do_not_fold(tmp_path: Path) -> None:
    """A whine of 1.9 kHz at 8 kHz would be one of 100 Hz at 1 kHz."""
    stamp = START + np.arange(8 * len(STAMP)) * 125_000
    seconds = (stamp - START) * 1e-9
    slow, whine = 3e5 + 1e5 * np.sin(2 * np.pi * 5 * seconds), 2e4 * np.sin(2 * np.pi * 1900 * seconds)
    content = streams()
    content[PRESSURE_A] = (stamp, encoding.pressures(stamp, slow + whine, 0.0))
    found = read_recording(write(tmp_path / "run", content))
    expected = 3e5 + 1e5 * np.sin(2 * np.pi * 5 * found.time)
    assert np.abs(found.pressure_a - expected)[20:-20].max() < 200.0


@pytest.mark.parametrize(("rate", "kept"), [(4000.0, 4000.0), (10_000.0, 10_000.0 / 3), (20_000.0, 4000.0)])
def test_fast_recordings_are_thinned(rate: float, kept: float) -> None:
    time = np.arange(round(2.0 * rate)) / rate
    slow = 0.1 * np.sin(2 * np.pi * 3 * time)
    whine = 1e-3 * np.sin(2 * np.pi * 0.45 * rate * time)
    whole = recording(time=time, position=slow + whine, effort=slow)
    found, said = thinned(whole)
    assert 1.0 / found.sample_time == pytest.approx(kept)
    assert len(said) == (rate > 4400.0)
    if said:
        assert np.abs(found.position - np.interp(found.time, time, slow))[50:-50].max() < 2e-5
        assert f"thinned to {kept:.4g} Hz" in said[0]


def test_gaps_stay_gaps() -> None:
    time = np.delete(np.arange(40_000) / 2e4, slice(8000, 16_000))
    found, _ = thinned(recording(time=time, position=time, effort=time))
    assert not ((found.time > 0.401) & (found.time < 0.799)).any()


def test_an_uneven_clock_is_said() -> None:
    random = np.random.default_rng(1)
    even = recording(time=np.arange(500) * 5e-3, position=np.zeros(500), effort=np.zeros(500))
    assert thinned(even) == (even, [])
    (said,) = thinned(replace(even, time=np.sort(even.time + random.uniform(0.0, 2e-3, 500))))[1]
    assert said.startswith("uneven clock: median 5")
