"""The velocity estimate: exact for constant velocity, with noise and lag as stated."""

import numpy as np
import pytest

from pneumo_ros.control.velocity import VelocityEstimator


def run(estimator: VelocityEstimator, times: np.ndarray, positions: np.ndarray) -> np.ndarray:
    return np.array([estimator.update(float(t), float(y)) for t, y in zip(times, positions, strict=True)])


@pytest.mark.parametrize("sample_time", [1e-3, 2e-3])
@pytest.mark.parametrize("bandwidth", [50.0, 200.0, 600.0])
def test_noise_is_what_noise_gain_says(bandwidth: float, sample_time: float) -> None:
    estimator, sigma = VelocityEstimator(bandwidth), 1e-5
    noise = sigma * np.random.default_rng(1).standard_normal(100_000)
    velocity = run(estimator, sample_time * np.arange(len(noise)), noise)[2000:]
    assert velocity.std() == pytest.approx(sigma * estimator.noise_gain(sample_time), rel=0.03)


def test_a_constant_velocity_is_found_at_uneven_times() -> None:
    times = np.cumsum(np.random.default_rng(2).uniform(0.5e-3, 2e-3, 2000))
    velocity = run(VelocityEstimator(100.0), times, 0.3 + 0.17 * times)
    assert velocity[-1] == pytest.approx(0.17, rel=1e-9)


def test_an_acceleration_lags_as_stated() -> None:
    bandwidth, acceleration = 200.0, 0.5
    times = 1e-4 * np.arange(5000)
    velocity = run(VelocityEstimator(bandwidth), times, 0.5 * acceleration * times**2)
    assert acceleration * times[-1] - velocity[-1] == pytest.approx(2.0 * acceleration / bandwidth, rel=0.02)


def test_repeated_and_older_samples_change_nothing() -> None:
    estimator = VelocityEstimator(100.0)
    run(estimator, np.array([0.0, 1e-3, 2e-3]), np.array([0.0, 1e-4, 2e-4]))
    before = estimator.velocity
    assert estimator.update(2e-3, 9.0) == before
    assert estimator.update(1e-3, 9.0) == before
    estimator.reset()
    assert estimator.update(0.0, 5.0) == 0.0
