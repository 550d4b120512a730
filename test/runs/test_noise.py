"""Sensor noise from the recording itself: within 5 % on every kind of motion."""

import numpy as np
import pytest
from identify.making import POSITION_FLOOR, PRESSURE_NOISE, QUANTUM, own, rig

from pneumo_ros.runs.noise import noise_level, resolution

TIME = np.arange(20_000) * 1e-3
SINE = 0.3 * np.sin(2.0 * np.pi * 0.5 * TIME)


def rounded(signal: np.ndarray, step: float = QUANTUM) -> np.ndarray:
    return np.round(signal / step) * step


@pytest.mark.parametrize("sigma", [1e-6, 5e-6, 1e-4])
def test_white_noise_on_smooth_motion(sigma: float) -> None:
    noise = np.random.default_rng(0).normal(0.0, sigma, len(TIME))
    assert noise_level(SINE + noise) == pytest.approx(sigma, rel=0.05)


@pytest.mark.parametrize("kind", ["steps", "sweep", "slow"])
def test_white_noise_on_what_the_axis_does(kind: str) -> None:
    """Breakaways, reversals and sticking, whose events differences do not remove."""
    noise = own(kind)[2].noise
    assert noise["position_m"] == pytest.approx(POSITION_FLOOR, rel=0.05)
    assert noise["pressure_a_pa"] == pytest.approx(PRESSURE_NOISE, rel=0.05)
    assert noise["pressure_b_pa"] == pytest.approx(PRESSURE_NOISE, rel=0.05)


@pytest.mark.parametrize("name", ["train_steps", "train_creep", "constant_p1100"])
def test_recordings_of_the_rig_have_6_micrometres_and_300_pascals(name: str) -> None:
    """Its clock jitters, and laying the samples on a grid averages neighbours a little."""
    noise = rig(name)[2].noise
    assert noise["position_m"] == pytest.approx(POSITION_FLOOR, rel=0.06)
    assert noise["pressure_a_pa"] == pytest.approx(PRESSURE_NOISE, rel=0.06)
    assert noise["pressure_b_pa"] == pytest.approx(PRESSURE_NOISE, rel=0.06)


def test_ten_impacts_do_not_count() -> None:
    noise = np.random.default_rng(0).normal(0.0, 5e-6, len(TIME))
    jumps = np.cumsum(np.where(np.arange(len(TIME)) % 2000 == 1000, 1e-3, 0.0))
    assert noise_level(SINE + jumps + noise) == pytest.approx(5e-6, rel=0.05)


def test_a_moving_signal_that_is_only_quantised_has_a_uniform_error() -> None:
    assert noise_level(rounded(SINE)) == pytest.approx(QUANTUM / np.sqrt(12.0), rel=0.05)


def test_rest_within_a_step_counts_as_the_step_allows() -> None:
    """One count of flicker in 20 s: the sensor has not become exact."""
    signal = np.full(20_000, 0.25)
    signal[700] += QUANTUM
    assert noise_level(signal) == pytest.approx(QUANTUM / np.sqrt(12.0), rel=1e-6)


def test_rest_with_noise() -> None:
    noise = np.random.default_rng(0).normal(0.0, 5e-6, len(TIME))
    assert noise_level(rounded(0.1 + noise)) == pytest.approx(POSITION_FLOOR, rel=0.05)


@pytest.mark.parametrize("samples", [50, 99, 100, 101, 250])
def test_short_signals(samples: int) -> None:
    found = [noise_level(SINE[:samples] + np.random.default_rng(k).normal(0.0, 5e-6, samples)) for k in range(40)]
    assert np.median(found) == pytest.approx(5e-6, rel=0.1)


@pytest.mark.parametrize("signal", [np.zeros(1), np.zeros(4), np.array([0.0, 1.0, 0.0, 1.0]), np.full(1000, 3e5)])
def test_nothing_to_see_is_a_small_positive_number(signal: np.ndarray) -> None:
    assert 0.0 < noise_level(signal) < 1.0


def test_a_simulation_without_noise_has_ten_nanometres_and_a_pascal_at_most() -> None:
    noise = own("steps", noisy=False, seconds=5.0)[2].noise
    assert 1e-8 <= noise["position_m"] < 1e-6
    assert 1.0 <= noise["pressure_a_pa"] < 10.0


def test_resolution() -> None:
    assert resolution(rounded(0.001 * SINE)) == pytest.approx(QUANTUM)
    assert resolution(SINE) == 0.0
    assert resolution(np.zeros(100)) == 0.0
