"""The options that refit a model before it is used, and the table of what moved."""

import argparse
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console, columns
from pneumo_ros.command.recordings import read_named
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.runs.run import Run


def add_refit(parser: argparse.ArgumentParser) -> None:
    """--refit, --fit and --out."""
    parser.add_argument(
        "--refit", action="store_true", help="refit the model first, to BAG... unless --fit names others"
    )
    parser.add_argument("--fit", nargs="+", metavar="BAG", help="recordings to refit on, while BAG... are scored only")
    parser.add_argument("--out", metavar="MODEL", help="write the refitted machine file")


def refitted(
    options: argparse.Namespace, console: Console, model: "Model", runs: "list[Run]"
) -> "tuple[Model, dict[str, Any] | None]":
    """The model as the options want it, and the JSON of its refit; UsageError for --out without a refit."""
    if not (options.refit or options.fit):
        if options.out:
            raise UsageError("--out writes the refitted machine file; add --refit, or --fit BAG...")
        return model, None
    from pneumo_ros.compare.moved import refit_dict
    from pneumo_ros.plant import save_model
    from pneumo_ros.shooting.refit import refit

    if options.out:
        check_writable(options.out)
    used = read_named(options.fit, options, console, model) if options.fit else runs
    with console.progress("Refitting") as progress:
        found = refit(model, used, progress=lambda share, _: progress(share))
    if options.out:
        save_model(found.model, options.out)
        console.note(f"Refitted machine written to {options.out}")
    return found.model, refit_dict(found, [one.name for one in used])


def refit_text(refit: dict[str, Any]) -> str:
    """What the refit changed, a line for each parameter."""
    rows = [("", "before", "after", "95 % interval", "moved", "unit")]
    for name, one in refit["parameters"].items():
        low, high = one["low"], one["high"]
        interval = "not determined" if not one["determined"] or low is None else f"{low:.5g} to {high:.5g}"
        note = f"{one['priors_moved']:+.1f} sd" + (" !" if one["moved_beyond_prior"] else "")
        rows.append((name, f"{one['before']:.5g}", f"{one['value']:.5g}", interval, note, one["unit"]))
    title = f"Refitted to {', '.join(refit['runs'])}; moved in standard deviations of what was known before:"
    moved = refit["moved"]
    last = (
        f"Beyond what was known (2 sd): {', '.join(moved)}" if moved else "Nothing moved beyond what was known (2 sd)."
    )
    return "\n".join((title, columns(rows, right=(1, 2, 4)), last))
