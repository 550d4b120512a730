"""Find which effects a model lacks, with the evidence; add them, refit, and write the improved machine file.

The model is refitted to BAG..., and every known effect is tried on what remains. An effect is added if the recordings
of --holdout, which are never fitted, support it. This repeats until no effect helps. The command prints the held-out
error before and after, the parameters with their intervals, the effects that explain as much, and what no effect
explains. If effects cannot be distinguished, it names the experiment that distinguishes them. BAG may be a folder of
recordings; recordings named by --holdout are not fitted.

Ctrl-C ends the search: what was found by then is printed and written, with exit code 130. --within ends it in time to
print the best answer by then, with the usual exit code. Exit code 1 says that something is missing that no known effect
explains.
"""

import argparse
import math
import shlex
import time
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.again import again
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_model
from pneumo_ros.command.console import Console, plain
from pneumo_ros.command.machine_out import add_machine_file, check_machine_file
from pneumo_ros.command.patience import deadline, finishing
from pneumo_ros.command.recordings import measuring, say_rates
from pneumo_ros.command.reporting import add_report, prepare_report
from pneumo_ros.command.roles import add_holdout, read_roles, require_holdout, roles

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pneumo_ros.diagnose.outcome import Outcome
    from pneumo_ros.diagnose.search import Search
    from pneumo_ros.plant import Model
    from pneumo_ros.runs.run import Run
    from pneumo_ros.shooting.refit import Estimate

INTERRUPTED = 130
EVALUATION = 12.0  # times one prediction of the held-out runs: what the result takes after the search

EXAMPLES = (
    "pneumo diagnose runs --holdout runs/hold_1 --model my.yaml --out better.yaml",
    "pneumo diagnose runs --holdout runs/hold_1 --model my.yaml --within 120s --report page.html",
    "pneumo diagnose runs --holdout runs/hold_1 --effects mine.py",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., --holdout, --out, how to read recordings, and the common options."""
    parser.add_argument("bags", nargs="+", metavar="BAG", help="recordings to fit, or folders of recordings")
    add_holdout(parser, "recordings to judge by; never fitted")
    parser.add_argument(
        "--horizon", type=float, metavar="S", help="length of predictions (default: 1 s, or shorter runs)"
    )
    parser.add_argument("--within", type=seconds, default=math.inf, metavar="S", help="print the best answer by then")
    add_machine_file(parser, "write the improved machine file")
    add_recordings(parser)
    add_model(parser)
    add_report(parser)
    add_output(parser)
    parser.set_defaults(mechanics=True)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, diagnose, print, write."""
    end = time.monotonic() + options.within
    from pneumo_ros.command.diagnosis_json import diagnosis_dict
    from pneumo_ros.command.diagnosis_text import text
    from pneumo_ros.command.suggesting import cannot_say, suggested
    from pneumo_ros.plant import save_model
    from pneumo_ros.plant.mechanical import whole
    from pneumo_ros.wording.diagnosis import headline

    check_machine_file(options)
    require_holdout(options, "diagnose", console)
    paths = roles(options, console)
    report = prepare_report(options)
    model = chosen_model(options)
    for name in untried(model):
        console.note(f"{name} is not tried: no parameter has a value at which it does nothing (neutral=0.0)")
    train, held, passed = read_roles(*paths, options, console, model)
    given, model = model, measuring(model, [*train, *held], console)
    say_rates([*train, *held], console)
    for name, topics in unseen(model, [*train, *held]).items():
        console.note(f"{name} is not tried: it reads {' and '.join(topics)}, which not every recording has")
    outcome, estimates = diagnosed(model, train, held, console, end, options.horizon)
    with console.progress("Choosing an experiment") as progress:
        experiment = suggested(outcome, options.out or options.model, progress)
    result: dict[str, Any] = diagnosis_dict(outcome, estimates, experiment)
    result["cannot_say"] = cannot_say(outcome)
    result = plain(result | {"passed_over": passed, "machine_file": options.out, "provenance": report.origin()})
    result["headline"] = headline(result)
    console.say(text(result))
    if options.out:
        save_model(whole(given, outcome.model), options.out, overwrite=options.overwrite)
        console.note(f"{_what(outcome)} written to {options.out}")
    console.json(result)
    report.publish(console, lambda origin: _report(outcome, result, origin))
    console.next(_next(options))
    if outcome.interrupted:
        return INTERRUPTED
    return 1 if outcome.verdict == "unknown_effect" else 0


def _next(options: argparse.Namespace) -> str:
    """See how the machine that was found predicts; without a machine file, write it."""
    if options.out:
        return f"compare {shlex.join(options.holdout[:2])}{again(options, options.out)}"
    named = [*options.bags, "--holdout", *options.holdout]
    return f"diagnose {shlex.join(named)}{again(options)} --out better.yaml   # the machine file"


def seconds(text: str) -> float:
    """A time as typed, as 60 or 60s [s]."""
    try:
        value = float(text.removesuffix("s"))
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no time; give seconds above 0, such as 60 or 60s")
    return value


def untried(model: "Model") -> list[str]:
    """Effects of --effects without a parameter that has a neutral value: they cannot be added gradually."""
    from pneumo_ros.diagnose.coordinates import coordinates
    from pneumo_ros.plant.library import Library

    library = model.library
    own = sorted({*library.names()} - {*Library().names(), *model.effects})
    return [name for name in own if not coordinates(library.find(name))]


def unseen(model: "Model", runs: "Sequence[Run]") -> dict[str, list[str]]:
    """Effects that are not tried because a recording lacks a signal that they read, and the topics of these signals.

    An effect of a load cell or another sensor beside the supply's is not named where no recording has one: most
    machines have none.
    """
    from pneumo_ros.diagnose.hypothesis import unmeasured
    from pneumo_ros.measured import MEASURED
    from pneumo_ros.runs.inputs import IN_PLACE, measured_inputs
    from pneumo_ros.runs.run import SENSORS

    lacking = unmeasured(model, measured_inputs(runs)).items()
    some = {name for run in runs for name in run.further}
    rare = {one.input for one in MEASURED} - {*IN_PLACE}
    return {name: [SENSORS[one] for one in own] for name, own in lacking if not rare.issuperset(own) or {*own} <= some}


def diagnosed(
    model: "Model",
    train: "Sequence[Run]",
    held: "Sequence[Run]",
    console: Console,
    end: float = math.inf,
    horizon: float | None = None,
) -> "tuple[Outcome, dict[str, Estimate]]":
    """The diagnosis, and what is known of every parameter after it; Ctrl-C ends the search but not its evaluation.

    `end`: when the result has to be there, on the monotonic clock [s]; `horizon` [s] of predictions.
    """
    from pneumo_ros.diagnose.adding import estimates_along
    from pneumo_ros.diagnose.diagnosis import conclude
    from pneumo_ros.diagnose.search import Search

    again = "finishing what was found; Ctrl-C again stops at once"
    with console.progress("Diagnosing") as progress:

        def interrupted() -> None:
            progress.clear()
            console.note(f"Interrupted: {again}")

        search = Search(model, train, held, lambda share, doing: progress(0.8 * share, doing), horizon)
        found = search.run(deadline(search_time(search, end)))
        if found.interrupted:
            interrupted()
        with finishing(interrupted):
            return conclude(search, found, progress), estimates_along(search.fitter, found.model)


def search_time(search: "Search", end: float) -> float:
    """How long a search may take so that its result is evaluated by `end`, on the monotonic clock [s]."""
    if end == math.inf:
        return end
    begun = time.monotonic()
    search.predicted(search.start)  # a part of the evaluation, and the measure of the rest
    now = time.monotonic()
    return max(end - now - EVALUATION * (now - begun), 0.0)


def _what(outcome: "Outcome") -> str:
    if outcome.added:
        return f"Machine with {' and '.join(one.effect for one in outcome.added)}"
    return "Refitted machine, without any effect added,"


def _report(outcome: "Outcome", result: dict[str, Any], origin: dict[str, Any]) -> Any:
    from pneumo_ros.report.diagnosis import diagnosis_report

    return diagnosis_report(outcome, result, plain(outcome.after.as_dict()), origin)
