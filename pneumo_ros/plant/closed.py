"""The signal at which a machine's valve is closed: 0 V, or where its machine file says it is."""

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.plant.model import Model

Array = NDArray[np.float64]

OFFSET = "valve_null_offset.offset"
OFFSET_B = "second_valve.offset"
LIMIT = "dead_zone.right_limit"
SECOND = "U_b"  # the input of the valve of chamber b
LARGEST = 10.0  # V, that valve amplifiers of this kind take


def closed_signal(model: Model) -> float:
    """The command [V] that closes the valve: 5 V for a valve of 0 to 10 V, by its `valve_null_offset`."""
    return -model.parameters.get(OFFSET, 0.0) + 0.0  # never -0


def second_closed(model: Model) -> float | None:
    """The command [V] that closes the valve of chamber b, where each chamber has a valve of its own; else None."""
    return -model.parameters.get(OFFSET_B, 0.0) + 0.0 if SECOND in model.inputs else None


def check_one_command(model: Model) -> None:
    """Raises UsageError for a machine with a valve for each chamber, where only one command is sent."""
    if SECOND in model.inputs:
        raise UsageError(
            f"each chamber of {model.name} has a valve of its own, and this sends one command; move it by the "
            "controller or by commands of your own on valve/command and valve_b/command, and record that"
        )


def mirrored(model: Model, volts: Array) -> Array:
    """Commands of the valve of chamber b that moves against that of chamber a, both counted from where they close."""
    return np.asarray((second_closed(model) or 0.0) - (volts - closed_signal(model)))


def centred(model: Model) -> Model:
    """The same machine with commands counted from the closed signal."""
    return model.with_parameters({OFFSET: 0.0}) if closed_signal(model) else model


def says_closed(effects: Collection[str], parameters: Mapping[str, float], uncertainty: Mapping[str, float]) -> bool:
    """Whether a machine of these effects, `parameters` and their standard deviations says which signal closes it.

    `valve_null_offset` is that signal; the limits of `dead_zone` are counted from it, unless they are assumed: those of
    a machine from a data sheet may as well be zero. A file with neither says nothing: 0 V is then an assumption.
    """
    assumed = uncertainty.get(LIMIT, 0.0) >= parameters.get(LIMIT, 1.0)
    return OFFSET.partition(".")[0] in effects or (LIMIT.partition(".")[0] in effects and not assumed)
