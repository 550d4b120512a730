"""Identify friction and flow coefficients from constant-voltage runs, with intervals, and write the machine file.

The command finds stretches of constant velocity and constant pressures in the recordings. There the pressures give the
friction force: the static map, which gives Coulomb friction and drag. Static friction and Stribeck velocity come from
the force at which the piston breaks away and from how it starts to move, the flow coefficients from the mass balance,
the bristle stiffness from presliding. Machines with on/off valves or regulators, and those in a position loop, recorded
with its goal, are fitted to any motion instead, all parameters together. A parameter that the recordings do not
determine keeps its value, a sentence says so, and the exit code is 1. BAG may be a folder: all recordings in it are
read.
"""

import argparse
import shlex
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.again import again
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_model
from pneumo_ros.command.console import Console, plain
from pneumo_ros.command.identification_text import text
from pneumo_ros.command.machine_out import add_machine_file, check_machine_file
from pneumo_ros.command.recordings import expanded, measuring, read_expanded
from pneumo_ros.command.reporting import add_report, prepare_report

if TYPE_CHECKING:
    from pneumo_ros.plant import Model

ADDABLE = {"viscous": "viscous_friction", "stribeck_exponent": "stribeck_shape"}  # option -> effect

EXAMPLES = (
    "pneumo identify runs --out my.yaml",
    "pneumo identify runs --model new.yaml --out my.yaml --report my.html",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., --out, what else to fit, and the common options."""
    parser.add_argument("bags", nargs="+", metavar="BAG", help="recordings, or folders of recordings")
    add_machine_file(parser, "write the identified machine file")
    parser.add_argument("--viscous", action="store_true", help="add viscous friction and fit its coefficient sigma_2")
    parser.add_argument("--stribeck-exponent", action="store_true", help="add the exponent of the Stribeck curve")
    parser.add_argument(
        "--per-direction", action="store_true", help="fit the static map of each direction too, side by side"
    )
    parser.add_argument("--verbose", action="store_true", help="list every stretch that is refused, and why")
    add_recordings(parser)
    add_model(parser)
    add_report(parser)
    add_output(parser)
    parser.set_defaults(mechanics=True)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, identify, print, write."""
    from pneumo_ros.identify.campaign import FRICTION, identify
    from pneumo_ros.identify.directions import by_direction
    from pneumo_ros.identify.summary import summary
    from pneumo_ros.plant import save_model
    from pneumo_ros.plant.mechanical import whole
    from pneumo_ros.report.identification import identification_report
    from pneumo_ros.runs.inputs import check_driven

    check_machine_file(options)
    paths = expanded(options.bags, console)
    options.bags = list(paths)
    report = prepare_report(options)
    model = _with_added(chosen_model(options), options)
    runs, passed = read_expanded(paths, options, console, model)
    given, model = model, measuring(model, runs, console)
    check_driven(model, runs)
    with console.progress("Identifying") as progress:
        found = identify(model, runs, progress=lambda share, _: progress(share))
    result: dict[str, Any] = summary(found, runs)
    if options.per_direction:
        result["directions"] = by_direction(found, [n for n in FRICTION if n in model.parameters])
    result = plain(result | {"passed_over": passed, "machine_file": options.out, "provenance": report.origin()})
    console.say(text(result, options.verbose))
    if options.out:
        save_model(whole(given, found.model), options.out, overwrite=options.overwrite)
        console.note(f"Machine file written to {options.out}")
    then = _next(options)
    console.json(result)
    report.publish(console, lambda origin: identification_report(result, found.model, origin, f"pneumo {then}"))
    console.next(then)
    return 1 if found.undetermined else 0


def _next(options: argparse.Namespace) -> str:
    """See how the identified machine predicts; without a machine file, write it."""
    if options.out:
        return f"compare {shlex.join(options.bags[:2])}{again(options, options.out)}"
    return f"identify {shlex.join(options.bags)}{again(options)} --out my.yaml   # the machine file"


def _with_added(model: "Model", options: argparse.Namespace) -> "Model":
    """The model with the effects that options add, right behind LuGre friction and without effect until fitted."""
    wanted = [effect for option, effect in ADDABLE.items() if getattr(options, option)]
    added = [effect for effect in wanted if effect not in model.effects]
    if not added or "lugre_friction" not in model.effects:
        return model
    at = model.effects.index("lugre_friction") + 1
    larger = model.with_effects([*model.effects[:at], *added, *model.effects[at:]])
    new = {name: larger.specification(name).neutral for name in larger.parameters if name not in model.parameters}
    return larger.with_parameters({name: value for name, value in new.items() if value is not None})
