"""What a verb that moves a plant tells the node of its rig: wiring, limits, and which signal closes the valve."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.errors import UsageError
from pneumo_ros.units import LINE

if TYPE_CHECKING:
    from pneumo_ros.experiment.programme import Programme
    from pneumo_ros.plant import Model
    from pneumo_ros.reading.rig_file import Rig

DECLARE = (
    "the machine file does not say which signal closes the valve: without it, the valve cannot be kept closed. Look "
    "into its data sheet and add --closed 0V, or --closed 5V for a valve of 0 to 10 V"
)
DEFAULT = "axis"  # machine file where nobody names one: it says nothing of this rig


def rig_said(options: argparse.Namespace) -> "Rig":
    """What the file of --rig says; an empty one without it."""
    from pneumo_ros.reading.rig_file import Rig

    return options.rig_said or Rig()


def live_settings(options: argparse.Namespace) -> dict[str, object]:
    """Parameters of the node, for --rig, --read-as and --closed."""
    settings: dict[str, object] = {"read_as": options.read_as}
    if options.rig_file:
        settings["rig"] = str(Path(options.rig_file).resolve())
    return settings | ({"closed_signal": options.closed} if options.closed is not None else {})


def declared(programme: "Programme", options: argparse.Namespace) -> "Programme":
    """The programme inside the limits of the rig; a machine file that nobody chose does not say how a valve closes.

    Raises UsageError for limits that are angles: programmes are in m.
    """
    from pneumo_ros.experiment.programme import within

    if (limits := rig_said(options).limits) is not None:
        programme = within(programme, limits.along(LINE, programme.machine))
    return replace(programme, says_closed=False) if options.model == DEFAULT else programme


def declared_wiring(
    options: argparse.Namespace, model: "Model"
) -> tuple[tuple[str, ...], tuple[str, ...] | None, float | None]:
    """Words that are known of the wiring, those of the pressure sensors, and the signal [V] that closes the valve.

    None for sensors that are to be guessed. None for the signal where nobody has chosen a machine file: then a
    simulator must play the rig. Raises UsageError while nobody has said which signal closes the valve.
    """
    from pneumo_ros.parts.wishes import read_as
    from pneumo_ros.plant.closed import closed_signal, says_closed
    from pneumo_ros.reading.rig_file import VOLTS, quantity, with_closed
    from pneumo_ros.records.corrections import PRESSURE_UNITS, parse_words, wiring

    words = parse_words(options.read_as)
    said = any(word.startswith("closed=") for word in words) or rig_said(options).closed is not None
    if options.closed is not None:
        if said:
            raise UsageError("--closed and the wiring both say which signal closes the valve; leave one out")
        words = with_closed(words, quantity(options.closed, VOLTS, "--closed", "5V"), closed_signal(model))
        said = True
    elif not said and not says_closed(model.effects, model.parameters, model.uncertainty):
        raise UsageError(DECLARE)
    closed = wiring(words).command(closed_signal(model)) if said or options.model != DEFAULT else None
    words = tuple(word for word in words if word not in ("closed=0V", "closed=0"))
    given = tuple(word for word in words if word in (*PRESSURE_UNITS, "gauge"))
    if options.sensors:
        if given:
            raise UsageError("--sensors and the wiring both say what the pressure sensors send; leave one out")
        return words, parse_words(read_as(options.sensors)), closed
    return words, given or None, closed
