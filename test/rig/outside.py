"""Effects of no catalogue: a diagnosis must report an unknown effect."""

import numpy as np

from .effect import Effect, Fields, Rng
from .machine import Machine


def _detent(machine: Machine, size: float, rng: Rng) -> Fields:
    """Magnets or a worn thread: a force that repeats with position, the same both ways."""
    return {"detent": size, "detent_pitch": rng.uniform(8e-3, 4e-2), "detent_phase": rng.uniform(0.0, 2.0 * np.pi)}


def _ripple(machine: Machine, size: float, rng: Rng) -> Fields:
    """A piston compressor upstream without a receiver."""
    return {"ripple": size, "ripple_hertz": rng.uniform(0.8, 4.0)}


def _kink(machine: Machine, size: float, rng: Rng) -> Fields:
    """The moving hose of chamber a folds beyond some position and passes less, both ways."""
    side, position = float(rng.choice([-1.0, 1.0])), rng.uniform(-0.1, 0.2)
    return {"kink": 1.0 - size, "kink_position": position, "kink_side": side}


OUTSIDE = {
    "detent_force": Effect("N", 6.0, 20.0, ("momentum",), _detent, same_shape=False),
    "supply_ripple": Effect("1", 0.02, 0.06, ("valve", "chamber_a", "chamber_b"), _ripple, same_shape=False),
    "kinked_hose": Effect("1", 0.3, 0.7, ("valve", "chamber_a"), _kink, same_shape=False),
}
