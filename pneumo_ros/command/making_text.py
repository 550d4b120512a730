"""What `pneumo new` writes and says: the machine file with its head, and a summary."""

import math
import textwrap
from typing import TYPE_CHECKING, Any

from pneumo_ros import __version__
from pneumo_ros.command.console import columns, program

if TYPE_CHECKING:
    from pneumo_ros.parts.design import Design

WIDTH = 118  # letters of a comment line


def file_text(made: "Design", call: str) -> str:
    """The machine file: how it was made, how to use it, values with sources, and their uncertainty."""
    from pneumo_ros.plant.machine_file import machine_text

    head = [
        f"Made by pneumo_ros {__version__}: {call}",
        f"Command: {made.commands}.",
        "Sensors: absolute pressures in Pa."
        if not made.read_as
        else f"Sensors: read recordings with {_reading(made)}.",
        *(f"Caution: {caution}" for caution in made.cautions),
        "A value without a source is the default of its effect; a rule stands in for what nobody publishes. Sources:",
        *(f"[{number}] {source}" for number, source in enumerate(made.sources, 1)),
    ]
    lines = [line for text in head for line in textwrap.wrap(text, WIDTH, break_on_hyphens=False)]
    return "".join(f"# {line}\n" for line in lines) + machine_text(made.model, made.notes)


def record(made: "Design", out: str) -> dict[str, Any]:
    """The result for JSON, in SI units."""
    model = made.model
    parameters = {
        name: {
            "value": value, "std": model.uncertainty.get(name), "unit": model.specification(name).unit,
            "source": made.notes.get(name),
        }
        for name, value in model.parameters.items()
    }  # fmt: skip
    signal = {"extend": made.signal[0], "retract": made.least, "closed": made.closed}
    return {
        "schema_version": 1, "machine_file": out, "effects": list(model.effects), "signal_v": signal,
        "read_as": made.read_as, "cautions": list(made.cautions), "sources": list(made.sources),
        "parameters": parameters,
    }  # fmt: skip


def said(made: "Design", result: dict[str, Any]) -> str:
    """What the machine is, for a person."""
    from pneumo_ros.parts.wishes import conductance_text

    model, figure = made.model, made.order.nominal
    rows = [
        ("  cylinder", f"bore {1e3 * figure['bore']:g} mm, rod {1e3 * figure['rod']:g} mm, "
         f"stroke {1e3 * figure['stroke']:g} mm"),
        ("  supply", f"{figure['supply'] / 1e5:.4g} bar absolute"),
        ("  flow", f"C {_full(made, 'filling', conductance_text)} in, {_full(made, 'exhaust', conductance_text)} out, "
         f"b {model['choked_flow.critical_ratio']:.2g}"),
        ("  mass", f"{model['piston.mass']:g} kg, load {model.parameters.get('constant_load.load', 0.0):.4g} N"),
        ("  friction", _spread(made, "lugre_friction.coulomb_friction", "N") + " sliding"),
        ("  command", made.commands),
    ]  # fmt: skip
    for way, time in result.get("stroke_s", {}).items():
        rows.append((f"  stroke {way}", f"{_seconds(time['value'])}, 95 % within {_seconds(time['low'])} to "
                     f"{_seconds(time['high'])}"))  # fmt: skip
    text = [columns(rows)]
    if made.read_as:
        text.append(f"The sensors are no absolute pascals: read recordings with {_reading(made)}")
    return "\n".join(text)


def _full(made: "Design", edge: str, words: Any) -> str:
    """C of an edge at full signal, which is less than the parameter: an arctangent never opens fully."""
    model = made.model
    reach = max(abs(end - made.closed) for end in made.signal)
    share = math.atan(model["arctan_flow.voltage_gain"] * reach) * 2.0 / math.pi
    return str(words(model[f"choked_flow.conductance_{edge}"] * share))


def _spread(made: "Design", name: str, unit: str) -> str:
    return f"{made.model[name]:.3g} +- {made.model.uncertainty.get(name, 0.0):.2g} {unit}"


def _seconds(value: float) -> str:
    return f"{value:.3f} s" if math.isfinite(value) else "more than 5 s"


def _reading(made: "Design") -> str:
    return f"--read-as {made.read_as}, as in: {program()} view BAG --read-as {made.read_as}"
