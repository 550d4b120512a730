"""Which sensors of a model read something else than their states, and on what their readings depend."""

from collections.abc import Collection, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.commanded import readings_from
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.effect import LATE, Effect
from pneumo_ros.plant.reach import written_by
from pneumo_ros.plant.signals import SIGNALS

Array = NDArray[np.float64]

INVERTED = *LATE, "play"  # roles of parameters that say how a reading is inverted


def reads_wrong(effect: type[Effect]) -> bool:
    """Whether an effect makes a sensor differ from its state."""
    return not written_by(effect).isdisjoint(SENSED)


def read_from(effect: type[Effect]) -> frozenset[str]:
    """What the readings of an effect's sensors depend on: not what else it does, as a play before the load."""
    return readings_from(effect, SENSED)


def others_of(effect: type[Effect]) -> frozenset[str]:
    """What its readings depend on beside the frame's states, its own states and its own parameters."""
    return read_from(effect) - {"y", "v", *SENSED, *SENSED.values(), *effect.states, *effect.parameters}


def parameters_of(model: Model) -> set[str]:
    """Names by which effects read parameters, also those of others, without what is a signal or a state as well."""
    return {name.partition(".")[2] for name in model.parameters} - {*SIGNALS, *model.states}


def neutral_of(effect: type[Effect], keys: Collection[str]) -> dict[str, float]:
    """By dotted name, the neutral values of those of an effect's parameters that are among `keys` and have one."""
    own = [(key, p.neutral) for key, p in effect.parameters.items() if key in keys]
    return {f"{effect.name}.{key}": neutral for key, neutral in own if neutral is not None}


def differing(model: Model, parameters: Array, values: Mapping[str, float]) -> NDArray[np.bool_]:
    """Which parameter vectors (variants, parameters) have another value of any of `values`; all, if these are none."""
    names = list(model.parameters)
    found = [parameters[:, names.index(name)] != value for name, value in values.items()]
    return np.any(found, axis=0) if found else np.ones(len(parameters), dtype=bool)


def sensing(model: Model, parameters: Array) -> NDArray[np.bool_]:
    """Which parameter vectors (variants, parameters) make any sensor of the model differ from its state."""
    return _acting(model, parameters, filter(reads_wrong, model.composition.effects))


def must_drive(model: Model, parameters: Array, untold: bool = False) -> NDArray[np.bool_]:
    """The same of sensors whose readings depend on more than parameters and the frame's states, as a late one.

    `untold`: of those of which the roles of their parameters do not say how their readings are inverted.
    """
    some = list[type[Effect]]()
    for effect in filter(reads_wrong, model.composition.effects):
        own, more = read_from(effect), not others_of(effect) <= parameters_of(model)
        if more or (own & effect.states.keys() and not (untold and _told(effect))):
            some.append(effect)
    return _acting(model, parameters, some)


def _told(effect: type[Effect]) -> bool:
    """Whether the parameters on which its readings depend all have a role that says how these are inverted."""
    own = [p.role in INVERTED for key, p in effect.parameters.items() if key in read_from(effect)]
    return bool(own) and all(own)


def _acting(model: Model, parameters: Array, effects: Iterable[type[Effect]]) -> NDArray[np.bool_]:
    found = np.zeros(len(parameters), dtype=bool)
    for effect in effects:
        found |= differing(model, parameters, neutral_of(effect, read_from(effect)))
    return found
