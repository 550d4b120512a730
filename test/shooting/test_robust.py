"""Huber's loss: squared up to the tail, linear beyond, and minimised by its weights."""

import numpy as np
import pytest

from pneumo_ros.shooting.robust import huber_loss, huber_weight

ERRORS = np.array([-7.0, -3.0, -1.0, 0.0, 0.5, 2.9, 3.1, 12.0])


def test_it_is_squared_up_to_the_tail_and_linear_beyond() -> None:
    np.testing.assert_allclose(huber_loss(np.array([-1.0, 3.0, 5.0]), 3.0), [0.5, 4.5, 10.5])


@pytest.mark.parametrize("tail", [0.7, 3.0, np.inf])
def test_a_weighted_square_has_the_slope_of_the_loss(tail: float) -> None:
    """Iterated least squares end at the minimum of the loss: d loss / d e = weight e."""
    step = 1e-6
    slope = (huber_loss(ERRORS + step, tail) - huber_loss(ERRORS - step, tail)) / (2.0 * step)
    np.testing.assert_allclose(huber_weight(ERRORS, tail) * ERRORS, slope, atol=1e-6)
