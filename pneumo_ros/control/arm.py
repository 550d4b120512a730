"""Mass and load of an arm along its rod, for control laws: the polynomials of the effect `arm_load`."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

BEYOND = 1.1  # of half the stroke, beyond which the polynomials mean nothing
GRID = 41  # positions along the stroke at which the heaviest is looked for
MASSES = tuple(f"arm_load.mass_{k}" for k in range(9))
ENERGIES = tuple(f"arm_load.energy_{k}" for k in range(1, 9))


class Terms(NamedTuple):
    """What moves with the rod where it is: mass [kg], load against extension [N], its slope along the rod [N/m]."""

    mass: float
    load: float
    slope: float


class Arm:
    """M(y) y'' + M'(y) v^2 / 2 + E'(y), the mechanism of one joint along the rod; source: see `arm_load`."""

    def __init__(self, stroke: float, coefficients: Sequence[float]) -> None:
        """`coefficients` of T_0 to T_8 of M [kg], then of T_1 to T_8 of E [J]; `stroke` [m]."""
        self._scale = 2.0 / stroke
        mass, energy = Chebyshev(coefficients[: len(MASSES)]), Chebyshev([0.0, *coefficients[len(MASSES) :]])
        curves = (mass, mass.deriv(), mass.deriv(2), energy.deriv(), energy.deriv(2))
        self._curves = [_horner(one) for one in curves]
        along = [self.terms(float(y), 0.0) for y in np.linspace(-0.5, 0.5, GRID) * stroke]
        self.heaviest = max(one.mass for one in along)  # kg, along the stroke
        self.loads = min(one.load for one in along), max(one.load for one in along)  # N, along the stroke, at rest

    def terms(self, position: float, velocity: float) -> Terms:
        """Mass, load and its slope at `position` [m] and `velocity` [m/s]."""
        x = min(max(self._scale * position, -BEYOND), BEYOND)
        mass, steeper, bent, uphill, steepening = (_value(one, x) for one in self._curves)
        half = 0.5 * velocity * velocity
        load = self._scale * (half * steeper + uphill)
        return Terms(max(mass, 0.0), load, self._scale * self._scale * (half * bent + steepening))


def _horner(curve: Chebyshev) -> list[float]:
    """Coefficients of powers of x, the highest first."""
    powers: list[float] = curve.convert(kind=Polynomial).coef.tolist()
    return powers[::-1]


def _value(powers: list[float], x: float) -> float:
    value = 0.0
    for one in powers:
        value = value * x + one
    return value
