"""The catalogue of physical effects: equations, parameters, units, how to recognise each, and sources."""

import argparse
import inspect
import textwrap
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_model, add_output, chosen_model
from pneumo_ros.command.console import Console, columns
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from pneumo_ros.plant import Effect, Model

FRAME_ROOM = "frame"

EXAMPLES = (
    "pneumo effects              # all, a line each",
    "pneumo effects lugre_friction",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """NAME and the common options."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="explain this effect; without it, list all")
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """List the catalogue, or explain one effect."""
    from pneumo_ros.plant.catalogue import catalogue, record

    model = chosen_model(options)
    effects = catalogue(model)
    if options.name is None:
        console.say(listing(effects, model))
        chosen = list(effects.values())
    elif options.name in effects:
        chosen = [effects[options.name]]
        console.say(explanation(chosen[0], model))
    else:
        raise UsageError(f"{unknown_name('effect', options.name, effects)} (effects of your own: --effects FILE.py)")
    console.next("effects NAME" if options.name is None else f"add {options.name} BAG... --out more.yaml")
    console.json({"schema_version": 1, "model": model.name, "effects": [record(effect, model) for effect in chosen]})
    return 0


def listing(effects: dict[str, "type[Effect]"], model: "Model") -> str:
    """One line for each effect, under the part of the machine it belongs to; a star marks those of `model`."""
    from pneumo_ros.plant.catalogue import room, summary

    inside = {effect.name for effect in model.composition.effects}
    rows = {name: (f" {'*' if name in inside else ' '} {name}", summary(effect)) for name, effect in effects.items()}
    lines = dict(zip(rows, columns(list(rows.values())).splitlines(), strict=True))
    text, last = [], ""
    for name, effect in effects.items():
        if room(effect) != last:
            last = room(effect)
            text += ["", last + (" (part of every machine)" if last == FRAME_ROOM else "")]
        text.append(lines[name])
    return "\n".join((*text[1:], "", f"* in the machine '{model.name}'. Equations and parameters: pneumo effects NAME"))


def explanation(effect: "type[Effect]", model: "Model") -> str:
    """Everything about one effect, as text."""
    from pneumo_ros.plant.catalogue import body, helpers, room

    parts = [f"{effect.name}  ({room(effect)})", inspect.cleandoc(effect.__doc__ or "")]
    if effect.signature:
        parts.append(f"Recognised by: {effect.signature}")
    if effect.remedy:
        parts.append(f"At the machine: {effect.remedy}")
    if effect.source:
        parts.append(f"Source: {effect.source}")
    for name in ("equations", "advance"):
        if name in effect.functions:
            when = " (once after each step)" if name == "advance" else ""
            parts.append(f"{name.capitalize()}{when}:\n{textwrap.indent(body(effect, name), '    ')}")
    if used := helpers(effect):
        parts.append("Where:\n" + textwrap.indent("\n".join(used.values()), "    "))
    if effect.states:
        rows = [(f"  {name}", f"[{state.unit}]", state.meaning) for name, state in effect.states.items()]
        parts.append(f"States:\n{columns(rows)}")
    if effect.parameters:
        parts.append(f"Parameters (value in '{model.name}', else default):\n{columns(parameter_rows(effect, model))}")
    return "\n\n".join(parts)


def parameter_rows(effect: "type[Effect]", model: "Model") -> list[tuple[str, ...]]:
    """Dotted name, value, unit, allowed range and meaning of each parameter."""
    return [
        (
            f"  {effect.name}.{name}",
            f"{model.parameters.get(f'{effect.name}.{name}', parameter.default):g}",
            f"[{parameter.unit}]",
            parameter.range_text(),
            parameter.meaning,
        )
        for name, parameter in effect.parameters.items()
    ]
