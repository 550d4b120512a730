"""Errors that count squared up to a tail and linearly beyond (P. J. Huber, Annals of Math. Statistics 35, 1964)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def huber_loss(errors: Array, tail: float | Array) -> Array:
    """Half the square of errors in deviations, up to the tail; linear beyond. `tail` may be infinite."""
    size = np.abs(errors)
    square = np.minimum(size, tail)
    return np.asarray(square * (size - 0.5 * square))


def huber_weight(errors: Array, tail: float | Array) -> Array:
    """Weight of each squared error in iterated least squares that minimise `huber_loss`."""
    return np.asarray(np.minimum(1.0, tail / np.maximum(np.abs(errors), 1e-300)))
