"""--rig: a file that says of a rig which machine it is and how its recordings are wired."""

import argparse
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pneumo_ros.errors import UsageError
from pneumo_ros.units import TURN

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.reading.rig_file import Rig


_UNSAID = ("axis", "piston")  # options that nobody gave


def read_rig(path: str) -> "Rig":
    """The entries of a rig file. Raises DataError and UsageError as `pneumo_ros.reading.rig_file.read_rig`."""
    from pneumo_ros.reading import rig_file  # slow; --help does not need it

    return rig_file.read_rig(path)


def rig_text(
    machine: str,
    namespace: str,
    joint: str,
    words: Sequence[str],
    origin: str,
    model: "Model",
    closed: float | None,
    said: "Rig | None" = None,
) -> str:
    """The rig file; `origin`: the end of its first line, where the wiring comes from; `closed` [V] closes the valve.

    Safe state, range and limits are those that another file has `said`; its topics are of recordings by another
    program, and this file goes with our own. Without limits, the stroke of the `model` stands there as a comment.
    """
    from pneumo_ros.plant.axes_section import from_anywhere  # slow; --help does not need it

    machine = from_anywhere(machine)
    closes = (
        "  # closed: 0V  # the command that closes the valve, by its data sheet: live work needs it\n"
        if closed is None
        else f"  closed: {closed:g}V  # the command that closes the valve\n"
    )
    return (
        f"# A rig: its machine, and the wiring of its recordings. {origin}\n"
        "rig:\n"
        f"  machine: {machine}\n"
        f"  namespace: {namespace}\n"
        f"  joint: {joint}\n"
        f"  read_as: {','.join(words)}  # as --read-as: units, gauge, swapped, reversed, zero, closed signal\n"
        f"{closes}{_live_lines(said, model)}"
    )


def _live_lines(said: "Rig | None", model: "Model") -> str:
    lines = list[str]()
    if said is not None and said.safe is not None:
        lines.append(f"safe: {said.safe:g}V")
    if said is not None and said.range is not None:
        lines.append(f"range: {said.range[0]:g}V..{said.range[1]:g}V")
    if said is not None and said.limits is not None:
        lines.append(f"limits: {said.limits.text}")
    else:
        unit, factor = ("deg", math.pi / 180.0) if model.coordinate == TURN else ("mm", 1e-3)
        end = f"{0.5 * model['piston.stroke'] / factor:.4g}{unit}"
        lines.append(f"# limits: -{end}..{end}  # the ends of the stroke; live work keeps to the positions named here")
    return "".join(f"  {line}\n" for line in lines)


def apply_rig(options: argparse.Namespace) -> str:
    """Take what the options do not say from the file of --rig, if there is one; a sentence where --model differs.

    Raises DataError when it cannot be read, UsageError when it is invalid, says something else of the wiring than an
    option, or limits in degrees a machine that moves along a line.
    """
    path = getattr(options, "rig_file", None)
    options.rig_said = None
    if not path:
        return ""
    options.rig_said = rig = read_rig(path)
    for option in ("namespace", "joint", "read_as"):
        value, present = getattr(rig, option), getattr(options, option, None)
        if present not in (None, "", *_UNSAID) and value and present != value:
            raise UsageError(
                f"--rig {path} says {option} {value}, and --{option.replace('_', '-')} {present}; leave one out"
            )
        if value and hasattr(options, option):
            setattr(options, option, value)
    sentence = _machine(options, rig.machine)
    if rig.limits and rig.limits.coordinate and hasattr(options, "model"):
        machine = _chosen(options)
        rig.limits.along(machine.coordinate, machine.name)
    if rig.closed is not None and hasattr(options, "read_as"):
        options.read_as = _read_as(options, rig.closed)
    return sentence


def _chosen(options: argparse.Namespace) -> "Model":
    from pneumo_ros.plant import load_model

    return load_model(getattr(options, "model", "axis"), tuple(getattr(options, "effects", ())))


def _machine(options: argparse.Namespace, said: str) -> str:
    """Take the machine of the rig where --model names none; else a sentence that says which one is used."""
    present = getattr(options, "model", None)
    if not said or not hasattr(options, "model"):
        return ""
    if present in (None, "", *_UNSAID):
        options.model = said
        return ""
    from pneumo_ros.plant.axes_section import from_anywhere  # slow; --help does not need it

    same = from_anywhere(present) == from_anywhere(said)
    return "" if same else f"Machine: {present}, in place of {said}, which {options.rig_file} names"


def _read_as(options: argparse.Namespace, closed: float) -> str:
    """Words of --read-as with which the machine's valve is closed at `closed` [V]."""
    from pneumo_ros.plant.closed import closed_signal
    from pneumo_ros.reading.rig_file import with_closed
    from pneumo_ros.records.corrections import parse_words

    return ",".join(with_closed(parse_words(options.read_as), closed, closed_signal(_chosen(options))))
