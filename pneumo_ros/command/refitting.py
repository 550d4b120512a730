"""The options that refit a model before it is used, and the table of what moved."""

import argparse
import math
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console, table_text
from pneumo_ros.command.recordings import measuring, read_named, say_rates
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.runs.run import Run


def add_refit(parser: argparse.ArgumentParser) -> None:
    """--refit, --fit, --segment and --out."""
    parser.add_argument(
        "--refit", action="store_true", help="refit the model first, to BAG... unless --fit names others"
    )
    parser.add_argument("--fit", nargs="+", metavar="BAG", help="recordings to refit on, while BAG... are scored only")
    parser.add_argument(
        "--segment", type=float, metavar="S",
        help="length of the segments of a refit, each from its own start (default: 0.5 s); long ones show slow laws",
    )  # fmt: skip
    parser.add_argument("--out", metavar="MODEL", help="write the refitted machine file")


def refitted(
    options: argparse.Namespace, console: Console, model: "Model", runs: "list[Run]"
) -> "tuple[Model, dict[str, Any] | None]":
    """The model as the options want it, and the JSON of its refit; UsageError for --out or --segment without."""
    if options.segment is not None:
        _check_segment(options)
    if options.out and not (options.refit or options.fit):
        raise UsageError("--out writes the refitted machine file; add --refit, or --fit BAG...")
    if options.out:
        check_writable(options.out)
    given, model = model, measuring(model, runs, console)
    if not (options.refit or options.fit):
        return model, None
    from pneumo_ros.compare.moved import refit_dict
    from pneumo_ros.plant import save_model
    from pneumo_ros.plant.mechanical import whole
    from pneumo_ros.shooting.refit import SEGMENT, refit

    used = read_named(options.fit, options, console, model.measuring(())) if options.fit else runs
    model = measuring(model, [*runs, *used], console) if options.fit else model
    say_rates(used, console)
    with console.progress("Refitting") as progress:
        segment = options.segment or SEGMENT
        found = refit(model, used, segment=segment, progress=lambda share, _: progress(share))
    if options.out:
        save_model(whole(given, found.model), options.out)
        console.note(f"Refitted machine written to {options.out}")
    return found.model, refit_dict(found, [one.name for one in used])


def _check_segment(options: argparse.Namespace) -> None:
    if not (options.refit or options.fit):
        raise UsageError("--segment is the length of the segments of a refit; add --refit, or --fit BAG...")
    if not 0.0 < options.segment < math.inf:
        raise UsageError(f"--segment {options.segment:g} is not a length of time; give seconds, such as --segment 40")


def refit_text(refit: dict[str, Any]) -> str:
    """What the refit changed: a line for each parameter, then those that moved beyond what was known."""
    from pneumo_ros.wording.moved import moved_sentence, refit_table

    return table_text(refit_table(refit)) + "\n" + moved_sentence(refit)
