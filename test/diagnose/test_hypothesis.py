"""The linear steps of a fit: a system without a solution is refused with a message."""

import numpy as np
import pytest
from scipy.signal import lfilter

from pneumo_ros.diagnose.hypothesis import ROWS, along, block_sums, gathered, jackknife, solve, solve_within, spread
from pneumo_ros.errors import NumericalError

R, W, RIDGE, OFFSET = np.ones(3), np.ones(3), np.ones(2), np.zeros(2)


@pytest.mark.parametrize("wild", [np.inf, np.nan, 1e200])
def test_slopes_that_are_not_finite_are_a_numerical_error(wild: float) -> None:
    K = np.array([[1.0, 0.0], [0.0, wild], [0.0, 1.0]])
    with pytest.raises(NumericalError, match="a fit of 2 parameters left the finite numbers"):
        solve((K,), R, W, RIDGE, OFFSET)
    with pytest.raises(NumericalError, match="a fit of 2 parameters left the finite numbers"):
        solve_within((K,), R, W, RIDGE, OFFSET, -np.ones(2), np.ones(2))


def test_slopes_side_by_side_in_parts_are_one_matrix() -> None:
    """Of more residuals than are taken at a time."""
    rng = np.random.default_rng(4)
    n = 2 * ROWS + 17
    parts, w, r = (rng.normal(size=(n, 3)), rng.normal(size=(n, 2))), rng.uniform(0.5, 2.0, n), rng.normal(size=n)
    whole, block = np.concatenate(parts, axis=1) * w[:, None], np.arange(n) // 40
    normal, gradient = gathered(parts, w, r)
    np.testing.assert_allclose(normal, whole.T @ whole, rtol=1e-10, atol=1e-8)
    np.testing.assert_allclose(gradient, whole.T @ (w * r), rtol=1e-10, atol=1e-8)
    sums = np.stack([np.bincount(block, column * r) for column in whole.T], axis=1)
    np.testing.assert_allclose(block_sums(parts, w, r, block), sums, rtol=1e-9, atol=1e-9)
    x = np.arange(5.0)
    np.testing.assert_allclose(along(parts, x), np.concatenate(parts, axis=1) @ x)


@pytest.mark.parametrize(("time", "holds"), [(0.02, True), (2.0, False)])
def test_long_blocks_hold_errors_that_are_correlated_for_seconds(time: float, holds: bool) -> None:
    """A line fitted 200 times to 100 s of errors of a correlation time: 95 % intervals hold its slope, or should."""
    rng, step = np.random.default_rng(8), 0.1
    n = round(100.0 / step)
    A = np.column_stack([np.ones(n), np.sin(0.4 * np.arange(n) * step)])
    short, long = (np.floor(np.arange(n) * step / length + 1e-9).astype(np.int64) for length in (0.4, 6.4))
    rho = np.exp(-step / time)
    held = np.zeros(2)
    for _ in range(200):
        e = lfilter([np.sqrt(1.0 - rho * rho)], [1.0, -rho], rng.normal(size=n + 200))[200:]
        x = np.linalg.lstsq(A, e, rcond=None)[0]
        r = e - A @ x
        held += [abs(x[1]) < 1.96 * std[1] for std in (spread(A, r, short), jackknife(A, r, long))]
    share = held / 200.0
    assert (share[0] > 0.9) == holds
    assert 0.88 < share[1] < 0.99


def test_leaving_out_blocks_is_refitting_without_them() -> None:
    rng = np.random.default_rng(3)
    A, b, block = rng.normal(size=(60, 2)), rng.normal(size=60), np.arange(60) // 12
    ridge = np.eye(2)

    def fit(rows: np.ndarray) -> np.ndarray:
        return np.linalg.solve(A[rows].T @ A[rows] + ridge, A[rows].T @ b[rows])

    whole = fit(np.ones(60, dtype=bool))
    apart = np.array([fit(block != k) - whole for k in range(5)])
    of_prior = np.linalg.inv(A.T @ A + ridge)
    expected = np.sqrt(np.sum(apart**2, axis=0) + np.diag(of_prior @ of_prior))
    np.testing.assert_allclose(jackknife(A, b - A @ whole, block), expected, rtol=0.02)
