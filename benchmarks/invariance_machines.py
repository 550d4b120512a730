"""The same axis seen in a mirror, or of another size: its machine file, its recordings and what is found in them."""

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

Array = NDArray[np.float64]

PAIRS = (("a", "b"), ("right", "left"), ("extension", "retraction"))  # words in names that a mirror exchanges
EXCHANGED = {one: other for pair in PAIRS for one, other in (pair, pair[::-1])}
SIGNED = ("constant_load.load", "spring_load.rest_position", "valve_null_offset.offset")
LAST_KNOT = 24  # of the profile of friction over the stroke
# Powers of area and of pressure in a quantity, where all lengths along the axis and all times stay
POWERS = {
    "kg": (1, 1), "N": (1, 1), "N/m": (1, 1), "N s/m": (1, 1), "N s2/m2": (1, 1), "m2": (1, 0), "m3": (1, 0),
    "kg/(s Pa)": (1, 0), "m3/(s Pa)": (1, 0), "N/Pa": (1, 0), "Pa": (0, 1), "Pa s/kg": (-1, 0),
}  # fmt: skip


def mirrored_name(dotted: str) -> str:
    """The parameter that has this one's place in the mirror."""
    section, _, key = dotted.partition(".")
    if knot := re.fullmatch(r"knot_(\d+)", key):
        return f"{section}.knot_{LAST_KNOT - int(knot[1]):02d}"
    return f"{section}.{'_'.join(EXCHANGED.get(word, word) for word in key.split('_'))}"


def mirrored_value(dotted: str, value: float) -> float:
    """A parameter's value in the mirror."""
    if dotted == "asymmetric_friction.ratio":  # of retraction to extension; see `invariance_changes`
        return 1.0 / (1.0 + value) - 1.0
    return -value if dotted in SIGNED else value


def mirrored_model(model: Model) -> Model:
    """The machine file of the axis that extends where this one retracts."""
    return model.with_parameters({mirrored_name(k): mirrored_value(k, v) for k, v in model.parameters.items()})


def mirrored_run(run: Run) -> Run:
    """The same recording: positions and voltages of the other sign, chambers a and b exchanged."""
    return replace(run, position=-run.position, input=-run.input, pressure_a=run.pressure_b, pressure_b=run.pressure_a)


def factor(unit: str, area: float, pressure: float) -> float:
    """By how much a quantity of this unit grows with area and pressure."""
    of_area, of_pressure = POWERS.get(unit, (0, 0))
    return float(area**of_area * pressure**of_pressure)


def scaled_model(model: Model, area: float, pressure: float) -> Model:
    """The machine file with areas and pressures multiplied, and everything else so that it moves alike."""
    values: Mapping[str, float] = model.parameters
    return model.with_parameters(
        {k: v * factor(model.specification(k).unit, area, pressure) for k, v in values.items()}
    )


def scaled_run(run: Run, pressure: float) -> Run:
    """The same recording at higher pressures."""
    p_a, p_b = (None if one is None else pressure * one for one in (run.pressure_a, run.pressure_b))
    return replace(run, pressure_a=p_a, pressure_b=p_b)
