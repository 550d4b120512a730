"""The least-squares step within bounds, used by every Gauss-Newton descent with bounds.

There are four separate descents, as their problems differ; each says how it stops. `diagnose.basefit` and
`experiment.imitation` fit one model by dense slopes and take the best of a few shares of this step.
`diagnose.refining` moves many candidates at once, each with its own step control. `shooting` eliminates the starts and
damps the step, and `shooting.start` solves many small problems without bounds at once.
"""

import contextlib
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from pneumo_ros.errors import NumericalError

Array = NDArray[np.float64]


def bounded_minimum(normal: Array, gradient: Array, low: Array, high: Array) -> Array:
    """x (p,) within low and high (p,) that minimises x normal x / 2 + gradient x; normal (p, p) positive definite.

    Clipping the free minimum at a bound would leave correlated entries at wrong values. Raises NumericalError where the
    matrix is not finite, or its entries differ too much in magnitude.
    """
    root = finite(np.linalg.cholesky, normal).T
    wanted = -np.linalg.solve(root.T, gradient)
    return np.asarray(np.clip(lsq_linear(root, wanted, (low, high), method="bvls").x, low, high))


def finite(function: Callable[..., Array], normal: Array) -> Array:
    """`function` of a normal matrix (p, p); NumericalError where matrix or result are not finite."""
    with np.errstate(invalid="ignore", over="ignore"), contextlib.suppress(np.linalg.LinAlgError):
        result = np.asarray(function(normal))
        if np.isfinite(normal).all() and np.isfinite(result).all():
            return result
    raise NumericalError(
        f"a fit of {len(normal)} parameters left the finite numbers: a small change of one of them changes the "
        "simulation without bound; check the values of the machine file, and the equations of your own effects"
    )
