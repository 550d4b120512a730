"""Add effects to a model by name, refit it, and show the error before and after.

A name of the catalogue (pneumo effects) or of --effects is an effect, everything else is a recording; their order does
not matter. Model and effects are fitted to BAG... together. The error is that on the recordings of --holdout, or on
BAG... without --holdout. With --model two.yaml:lift the effects are added to that axis, and MODEL holds all axes.
Exit code 1 says that the recordings do not determine a parameter of an added effect.
"""

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.again import again
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_model
from pneumo_ros.command.console import Console, plain
from pneumo_ros.command.machine_out import add_machine_file, check_machine_file
from pneumo_ros.command.recordings import measuring, say_rates
from pneumo_ros.command.reporting import add_report, prepare_report
from pneumo_ros.command.roles import add_holdout, read_roles, roles
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from pneumo_ros.diagnose.adding import Adding
    from pneumo_ros.plant import Model

EXAMPLES = (
    "pneumo add viscous_friction runs --holdout runs/hold_1 --model my.yaml --out more.yaml",
    "pneumo add viscous_friction valve_spool_dynamics runs --out more.yaml",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """EFFECT... BAG..., --out, --holdout, how to read recordings, and the common options."""
    parser.add_argument(
        "named", nargs="+", metavar="EFFECT|BAG", help="effects to add, and recordings (or folders of them) to fit"
    )
    add_machine_file(parser, "write the machine file with the effects", required=True)
    add_holdout(parser, "recordings to judge by; never fitted")
    parser.add_argument(
        "--horizon", type=float, metavar="S", help="length of predictions (default: 1 s, or shorter runs)"
    )
    add_recordings(parser)
    add_model(parser)
    add_report(parser)
    add_output(parser)
    parser.set_defaults(mechanics=True)


def run(options: argparse.Namespace, console: Console) -> int:
    """Separate effects and recordings, read, add, print, write."""
    from pneumo_ros.command.adding_json import adding_dict, undetermined
    from pneumo_ros.command.adding_text import headline, text
    from pneumo_ros.diagnose.adding import add, check_addable
    from pneumo_ros.plant import save_model
    from pneumo_ros.plant.mechanical import whole

    check_machine_file(options)
    model = chosen_model(options)
    effects, options.bags = separated(options.named, model)
    check_addable(model, effects)
    paths = roles(options, console)
    report = prepare_report(options)
    train, held, passed = read_roles(*paths, options, console, model)
    given, model = model, measuring(model, [*train, *held], console)
    say_rates([*train, *held], console)
    with console.progress("Adding") as progress:
        found = add(model, effects, train, held, progress=progress, horizon=options.horizon)
    result: dict[str, Any] = adding_dict(found)
    result = plain(result | {"passed_over": passed, "machine_file": options.out, "provenance": report.origin()})
    result["headline"] = headline(result)
    console.say(text(result))
    save_model(whole(given, found.model), options.out, overwrite=options.overwrite)
    console.note(f"Machine file written to {options.out}")
    console.json(result)
    report.publish(console, lambda origin: _report(found, result, origin))
    judged = shlex.join((options.holdout or options.bags)[:2])
    console.next(f"compare {judged}{again(options, options.out)}")
    return 1 if undetermined(result) else 0


def separated(named: Sequence[str], model: "Model") -> tuple[list[str], list[str]]:
    """Effects and recordings, each in the order given: a known name is an effect, an existing path a recording.

    Raises UsageError for a name that is neither, and when there is no effect or no recording.
    """
    known = model.library.names()
    effects = [name for name in named if name in known]
    bags = [name for name in named if name not in known]
    for name in bags:
        if not Path(name).exists():
            raise UsageError(_neither(name, known))
    if not effects:
        raise UsageError("name an effect to add, such as viscous_friction; see: pneumo effects")
    if not bags:
        raise UsageError(f"give recordings to fit, such as: pneumo add {' '.join(effects)} BAG... --out MODEL")
    return effects, bags


def _neither(name: str, known: Sequence[str]) -> str:
    """What is wrong with a name: a slash or a suffix makes it a path, anything else may be a misspelt effect."""
    if "/" in name or Path(name).suffix:
        return f"there is no recording {name}"
    near = unknown_name("effect", name, known)
    hint = near.partition("; ")[2] if "did you mean" in near else "see: pneumo effects"
    return f"'{name}' is neither an effect nor an existing recording; {hint}"


def _report(found: "Adding", result: dict[str, Any], origin: dict[str, Any]) -> Any:
    """One page on what was added, then the page of `compare` for the model with the effects."""
    from pneumo_ros.report.adding import adding_report

    compared = plain(found.after.as_dict() | {"refit": result["refit"], "added": result["added"]})
    return adding_report(found, result, compared, origin)
