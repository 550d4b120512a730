"""An axis as the supply that it shares sees it: its supply pressure comes from outside, its drawn air is counted."""

from functools import lru_cache

from pneumo_ros.plant import Effect, Model
from pneumo_ros.plant.compose import Composition, compose
from pneumo_ros.plant.effects.supply.drawn_air import DrawnAir

MEASURED = "measured_supply"  # the input that takes the place of air.supply_pressure
DRAWN = "drawn_mass"


@lru_cache(maxsize=64)
def _drawing(effects: tuple[type[Effect], ...], measured: tuple[str, ...]) -> Composition:
    return compose((*effects, DrawnAir), tuple(sorted({*measured, MEASURED})))


def drawing_model(model: Model) -> Model:
    """`model` with its supply pressure as an input, where a valve reads it, and the drawn mass [kg] as last state."""
    parts = _drawing(model.composition.effects, model.composition.measured)
    return Model(parts, model.parameters, model.name, model.library, model.uncertainty)
