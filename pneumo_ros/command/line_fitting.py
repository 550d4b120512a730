"""What a verb that identifies all axes of a machine finds of the supply line that they share."""

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console
from pneumo_ros.errors import DataError

if TYPE_CHECKING:
    from pneumo_ros.multiaxis import Machine


def with_line(
    machine: "Machine", options: argparse.Namespace, paths: Sequence[str], console: Console
) -> "tuple[Machine, dict[str, Any]]":
    """The machine with its line fitted to `paths`, and the JSON of it; as it was where they do not determine it."""
    if machine.supply is None:
        return machine, {}
    from pneumo_ros.command.together import Together
    from pneumo_ros.multiaxis.line import fit_line, measured

    together, found = Together(machine, options), []
    for path in paths:
        try:
            axes = together.axes(path)
        except DataError:  # the axis that could not be read was named
            continue
        found += [axes] if measured(axes) else []
    if not found:
        console.say("supply line: as the file states; record supply/pressure to fit it")
        return machine, {}
    line = fit_line(found, machine.supply)
    result = _result(machine, line, len(found))
    console.say(_text(result["supply"]))
    fitted = {**machine.supply, **{n: v for n, v in line.values.items() if n not in line.undetermined}}
    return machine.with_supply(fitted), result


def _result(machine: "Machine", line: Any, recordings: int) -> dict[str, Any]:
    from pneumo_ros.plant.axes_section import SUPPLY

    known = next(iter(machine.axes.values())).library.find(SUPPLY).parameters
    parameters = {
        name: {
            "value": value, "std": value * line.std[name], "unit": known[name].unit,
            "before": (machine.supply or {})[name], "determined": name not in line.undetermined,
        }
        for name, value in line.values.items()
    }  # fmt: skip
    return {"supply": {"parameters": parameters, "levels_pa": list(line.levels), "residual_rms_pa": line.residual,
                       "recordings": recordings}}  # fmt: skip


def _text(found: dict[str, Any]) -> str:
    """A line for each parameter of the supply line."""
    lines = []
    for name, one in found["parameters"].items():
        words, unit = name.replace("_", " "), one["unit"]
        if one["determined"]:
            was = f"was {one['before']:.3g}"
            lines.append(f"supply line: {words} {one['value']:.3g} +- {one['std']:.2g} {unit}, {was}")
        else:
            lines.append(f"supply line: {words} is not determined and stays {one['before']:.3g} {unit}")
    lines.append(f"supply line: the sensor is explained within {1e-3 * found['residual_rms_pa']:.2g} kPa rms")
    return "\n".join(lines)
