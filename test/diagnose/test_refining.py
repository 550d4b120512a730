"""Gauss-Newton steps of candidates within their bounds."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from pneumo_ros.diagnose.coordinates import Coordinate, coordinates, profile
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.refining import NEAR, bounded_step, keeps_slopes
from pneumo_ros.plant import load_model

OWN = coordinates(load_model("axis").library.find("asymmetric_viscous_friction"))
PROFILE = profile(coordinates(load_model("axis").library.find("position_dependent_friction")))
BASE = 3  # parameters of the model itself


def system(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Similar slopes (residuals, base + candidate), and residuals."""
    rng = np.random.default_rng(seed)
    slopes = rng.normal(size=(60, BASE + len(OWN))) + rng.normal(size=(60, 1))
    return slopes, rng.normal(size=60)


@pytest.mark.parametrize("seed", range(8))
def test_a_step_is_the_best_within_the_bounds(seed: int) -> None:
    """Against scipy's bounded least squares, with priors as additional rows."""
    slopes, here = system(seed)
    h = Hypothesis("", OWN, np.array([0.4, 0.1]), np.zeros(BASE), here)
    ridge, offset = np.append(np.ones(BASE), np.full(2, 1e-3)), np.zeros(BASE + 2)
    step = bounded_step(h, (slopes,), here, np.ones(60), ridge, offset)
    rows = np.concatenate([slopes, np.diag(np.sqrt(ridge))])
    low = np.append(np.full(BASE, -np.inf), -h.u)  # neither slope of friction falls below zero
    best = lsq_linear(rows, np.append(-here, np.zeros(BASE + 2)), (low, np.inf)).x
    cost = [float(np.sum((rows @ x + np.append(here, np.zeros(BASE + 2))) ** 2)) for x in (step, best)]
    assert (step[BASE:] >= -h.u).all()
    assert cost[0] == pytest.approx(cost[1], rel=1e-6)


@pytest.mark.parametrize(("own", "far"), [(OWN, False), (PROFILE, True)])
def test_slopes_serve_nearby_and_those_of_a_profile_anywhere(own: tuple[Coordinate, ...], far: bool) -> None:
    at = np.full(len(own), 0.4)
    h = Hypothesis("", own, at, np.zeros(BASE), np.zeros(60), slopes=np.ones((60, len(own))))
    assert keeps_slopes(h, at + 0.9 * NEAR)
    assert keeps_slopes(h, at + np.eye(len(own))[0] * 1.1 * NEAR) is far
    assert not keeps_slopes(Hypothesis("", own, at, np.zeros(BASE), np.zeros(60)), at)
