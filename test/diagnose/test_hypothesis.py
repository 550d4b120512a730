"""The linear steps of a fit: a system without a solution is refused with a message."""

import numpy as np
import pytest

from pneumo_ros.diagnose.hypothesis import ROWS, along, block_sums, gathered, solve, solve_within
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
