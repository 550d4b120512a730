"""Stretches of constant velocity: their values and accuracy, and why others are refused."""

from dataclasses import replace

import numpy as np
import pytest
from identify.constant import CLOSED, constant_run, states, truth

from pneumo_ros.identify.static_map import sliding_friction
from pneumo_ros.identify.steady import WINDOW, Window, find_windows
from pneumo_ros.runs.run import PARTS, Run

VOLTAGES = [0.83, -0.83, 1.0, -2.0, 7.0]


def reasons(run: Run) -> set[str]:
    return {window.reason for window in find_windows(truth(), run)}


def used(run: Run) -> list[Window]:
    return [window for window in find_windows(truth(), run) if window.used]


@pytest.mark.parametrize("volts", VOLTAGES)
def test_velocity_and_friction_are_those_of_the_machine(volts: float) -> None:
    """Without noise, windows lie on the curve to 1e-5, though the machine has not settled fully."""
    windows = used(constant_run(volts, noisy=False))
    velocity = np.array([w.velocity for w in windows])
    np.testing.assert_allclose([w.friction for w in windows], sliding_friction(truth(), velocity), rtol=1e-5)
    middles = [round((w.start + w.stop) / 2 / 1e-3) for w in windows]
    np.testing.assert_allclose(velocity, states(volts, 8.0)[middles, 1], rtol=1e-3)


def test_stated_noise_is_the_scatter() -> None:
    gaps: dict[str, list[float]] = {"velocity": [], "friction": [], "slope_a": []}
    for volts in VOLTAGES:
        noisy, exact = (find_windows(truth(), constant_run(volts, noisy=n)) for n in (True, False))
        for one, other in zip(noisy, exact, strict=True):
            if one.used and other.used:
                gaps["velocity"].append((one.velocity - other.velocity) / one.velocity_noise)
                gaps["friction"].append((one.friction - other.friction) / one.friction_noise)
                gaps["slope_a"].append((one.slope_a - other.slope_a) / one.slope_noise)
    for name, found in gaps.items():
        assert len(found) > 80
        assert np.std(found) == pytest.approx(1.0, abs=0.2), name


def test_stated_noise_of_a_poor_position_sensor_is_the_scatter() -> None:
    """A millimetre of noise: then the acceleration dominates the noise of friction, and the pressures do not matter."""
    exact = constant_run(1.0, noisy=False)
    right, gaps = find_windows(truth(), exact), list[float]()
    for seed in range(4):
        poor = exact.position + 1e-3 * np.random.default_rng(seed).standard_normal(len(exact))
        found = find_windows(truth(), replace(exact, position=poor))
        gaps += [(one.friction - other.friction) / one.friction_noise for one, other in zip(found, right, strict=True)]
    assert len(gaps) > 100
    assert np.std(gaps) == pytest.approx(1.0, abs=0.2)


def test_windows_stay_within_an_interval_of_constant_voltage() -> None:
    run = constant_run(1.0)
    windows = find_windows(truth(), run)
    assert len(windows) == int((8.0 - CLOSED) / WINDOW)
    assert all(w.start >= CLOSED - 1e-9 and w.input == 1.0 for w in windows)
    assert windows[-1].stop <= 8.0


def test_steady_stretches_are_used_and_transients_are_not() -> None:
    windows = find_windows(truth(), constant_run(1.0))
    assert [w.used for w in windows[:4]] == [False] * 4
    assert all(w.used for w in windows[10:])
    assert {w.reason for w in windows[:4]} <= {"the piston rests or creeps", "the velocity changes"}
    changing = next(w for w in windows if w.reason == "the velocity changes")
    assert changing.refused.startswith("the velocity changes by ")
    assert changing.refused.endswith(" % in 0.25 s")


def test_a_resting_piston_is_no_point() -> None:
    windows = find_windows(truth(), constant_run(0.5))
    assert len(windows) == 31
    assert {w.reason for w in windows} == {"the piston rests or creeps"}


def test_an_axis_held_against_its_end_is_no_point() -> None:
    run = constant_run(2.0, seconds=12.0)
    late = [w for w in find_windows(truth(), run) if w.start > 11.0]
    assert run.position[-1] > 0.998
    assert {w.reason for w in late} == {"at the end of the stroke"}


def test_a_window_with_a_gap_is_no_point() -> None:
    run = constant_run(1.0)
    measured = run.measured.copy()
    measured[5000:5003] = False
    (cut,) = [w for w in find_windows(truth(), replace(run, measured=measured)) if w.reason == "a gap in the recording"]
    assert cut.start < 5.0 < cut.stop


def test_pressures_that_still_change_the_force_are_refused() -> None:
    """Position straight, pressures rising together by 1 % of the force in a window and a half."""
    run = constant_run(1.0)
    rising = 8e4 * np.maximum(run.time - 4.0, 0.0)
    assert run.pressure_a is not None
    found = find_windows(truth(), replace(run, pressure_a=run.pressure_a + rising))
    assert {w.reason for w in found if w.start > 4.2} == {"the pressures still change the force"}
    assert all(w.refused.endswith("N in 0.25 s") for w in found if w.start > 4.2)


def test_a_voltage_that_never_rests_has_no_windows() -> None:
    run = constant_run(1.0)
    restless = np.repeat(1.0 + 1e-6 * np.arange(len(run) - 1), PARTS)
    assert find_windows(truth(), replace(run, input=restless)) == []
    assert reasons(replace(run, input=np.repeat(np.arange(len(run) - 1) // 200 / 10.0, PARTS))) == set()


@pytest.mark.parametrize("sample_time", [5e-4, 4e-3, 1e-2])
def test_other_rates(sample_time: float) -> None:
    windows = used(constant_run(1.0, sample_time=sample_time))
    assert len(windows) > 20
    velocity = np.array([w.velocity for w in windows])
    errors = np.array([w.friction for w in windows]) - sliding_friction(truth(), velocity)
    assert np.sqrt(np.mean(errors**2)) < 0.1
