"""The Kalman filter: exact where its model is exact, Butterworth poles, noise as stated."""

import numpy as np
import pytest

from pneumo_ros.control.estimator import StateEstimator, tracking_gains

DT = 1e-3


def test_the_poles_are_where_they_are_placed() -> None:
    """Of the error of prediction, (1 - gains) times the transition; also Kalata's relation of alpha-beta-gamma."""
    bandwidth = 250.0
    alpha, beta, gamma = tracking_gains(bandwidth, DT)
    transition = np.array([[1.0, DT, 0.5 * DT**2], [0.0, 1.0, DT], [0.0, 0.0, 1.0]])
    left = np.eye(3) - np.outer([alpha, beta, gamma], [1.0, 0.0, 0.0])
    found = np.sort_complex(np.linalg.eigvals(left @ transition))
    butterworth = bandwidth * np.exp(1j * np.pi * np.array([2.0 / 3.0, 1.0, 4.0 / 3.0]))
    assert found == pytest.approx(np.sort_complex(np.exp(butterworth * DT)), abs=1e-6)


def test_it_is_the_steady_kalman_filter_of_its_bandwidth() -> None:
    """The Riccati equation of a random walk of f with q / r = bandwidth^6, iterated, gives nearly the same gains."""
    bandwidth, r = 200.0, 1.0
    q = bandwidth**6 * r * DT  # density of the noise of a measurement every DT is r DT
    A = np.array([[1.0, DT, 0.5 * DT**2], [0.0, 1.0, DT], [0.0, 0.0, 1.0]])
    column = np.array([DT**3 / 6.0, DT**2 / 2.0, DT])
    Q = q * np.outer(column, column) / DT
    P, K = np.eye(3), np.zeros(3)
    for _ in range(3000):
        P = A @ P @ A.T + Q
        K = P[:, 0] / (P[0, 0] + r)
        P = P - np.outer(K, P[0])
    assert np.array(tracking_gains(bandwidth, DT)) == pytest.approx(K, rel=0.06)


def test_motion_under_known_and_constant_unknown_force_is_estimated_without_error() -> None:
    estimator = StateEstimator(200.0)
    time = DT * np.arange(600)
    known = 3.0 * time  # rises in a straight line, as a chamber's force does
    position = 0.1 + 0.5 * time**3 - 0.5 * 0.7 * time**2
    for y, u in zip(position, known, strict=True):
        estimator.update(float(y), float(u), DT)
    assert estimator.position == pytest.approx(position[-1], abs=1e-7)
    assert estimator.velocity == pytest.approx(1.5 * time[-1] ** 2 - 0.7 * time[-1], abs=1e-5)
    assert estimator.acceleration == pytest.approx(known[-1] - 0.7, abs=2e-3)


def test_known_force_takes_the_lag_out_of_the_acceleration() -> None:
    """Without the input, the filter follows a rising acceleration late."""
    time = DT * np.arange(600)
    late, early = StateEstimator(100.0), StateEstimator(100.0)
    for t in time:
        late.update(float(t**3), 0.0, DT)
        early.update(float(t**3), float(6.0 * t), DT)
    truth = 6.0 * time[-1]
    assert abs(early.acceleration - truth) < 0.1 * abs(late.acceleration - truth)


@pytest.mark.parametrize("bandwidth", [100.0, 300.0])
def test_noise_of_the_velocity_is_that_of_its_transfer_function(bandwidth: float) -> None:
    estimator, sigma = StateEstimator(bandwidth), 1e-5
    noise = sigma * np.random.default_rng(3).standard_normal(60_000)
    seen = np.empty(len(noise))
    for k, y in enumerate(noise):
        estimator.update(float(y), 0.0, DT)
        seen[k] = estimator.velocity
    A = np.array([[1.0, DT, 0.5 * DT**2], [0.0, 1.0, DT], [0.0, 0.0, 1.0]])
    K = np.array(tracking_gains(bandwidth, DT))
    F = (np.eye(3) - np.outer(K, [1.0, 0.0, 0.0])) @ A
    P = np.zeros((3, 3))
    for _ in range(2000):
        P = F @ P @ F.T + np.outer(K, K)
    assert seen[1000:].std() == pytest.approx(sigma * np.sqrt(P[1, 1]), rel=0.05)


def test_it_starts_at_rest_and_again_after_a_reset() -> None:
    estimator = StateEstimator(200.0)
    estimator.update(0.5, 20.0, 0.0)
    assert (estimator.position, estimator.velocity, estimator.acceleration) == (0.5, 0.0, 0.0)
    estimator.update(0.6, 20.0, DT)
    estimator.reset()
    estimator.update(-0.3, 1.0, DT)
    assert (estimator.position, estimator.velocity, estimator.acceleration) == (-0.3, 0.0, 0.0)
