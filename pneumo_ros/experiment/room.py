"""The position limits of experiments, and the voltages that move the piston between them."""

from typing import TypedDict

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import check_one_command

MARGIN = 0.1  # of the stroke, before either end: a piston coasts this far after its valve closes, as in a fault
END = 0.005  # of the stroke, before either end: no piston coasts this far
MODERATE = 0.3  # V beyond the dead zone


class Room(TypedDict):
    """Entries of every programme, by their names there: positions [m] and voltages [V]."""

    low: float
    high: float
    end: float
    return_right: float
    return_left: float


def room_of(model: Model, margin: float = MARGIN) -> Room:
    """low, high and end [m] of a programme for `model`, and return_right and return_left [V].

    `margin` is the part of the stroke that is kept free before either end. Raises UsageError for a model without valve.
    """
    if model.force_driven:
        raise UsageError(
            f"{model.name} has no chambers, so no valve moves it; give --model a machine file with chambers"
        )
    check_one_command(model)
    stroke = model["piston.stroke"]
    high = (0.5 - margin) * stroke
    right, left = dead_zone(model)
    return {
        "low": -high, "high": high, "end": (0.5 - END) * stroke,
        "return_right": right + MODERATE, "return_left": left + MODERATE,
    }  # fmt: skip


def dead_zone(model: Model) -> tuple[float, float]:
    """Voltages [V] at which the valve begins to open, right and left, both positive."""
    names = ("dead_zone.right_limit", "dead_zone.left_limit")
    right, left = (model.parameters.get(name, 0.0) for name in names)
    return right, left
