"""The linear steps of a fit: a system without a solution is refused with a message."""

import numpy as np
import pytest

from pneumo_ros.diagnose.hypothesis import solve, solve_within
from pneumo_ros.errors import NumericalError

R, W, RIDGE, OFFSET = np.ones(3), np.ones(3), np.ones(2), np.zeros(2)


@pytest.mark.parametrize("wild", [np.inf, np.nan, 1e200])
def test_slopes_that_are_not_finite_are_a_numerical_error(wild: float) -> None:
    K = np.array([[1.0, 0.0], [0.0, wild], [0.0, 1.0]])
    with pytest.raises(NumericalError, match="a fit of 2 parameters left the finite numbers"):
        solve(K, R, W, RIDGE, OFFSET)
    with pytest.raises(NumericalError, match="a fit of 2 parameters left the finite numbers"):
        solve_within(K, R, W, RIDGE, OFFSET, -np.ones(2), np.ones(2))
