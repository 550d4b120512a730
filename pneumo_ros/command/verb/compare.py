"""Compare a model with recordings: error per run and signal against the sensor noise, and the equations that fail.

Each run is predicted in windows of --horizon seconds, every window from a start state estimated around its first
sample, and once more from its first sample alone (free run). The equations are judged along the measured signals; where
one fails, the regimes, the variables and the intervals that hold most of the error are named.
"""

import argparse
import io
import shlex
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.again import again, parted
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_model
from pneumo_ros.command.console import Console, columns, plain
from pneumo_ros.command.recordings import read_named, unfolded
from pneumo_ros.command.refitting import add_refit, refit_text, refitted
from pneumo_ros.command.reporting import add_report, prepare_report
from pneumo_ros.compare.findings import findings, verdict
from pneumo_ros.compare.typical import typical_error
from pneumo_ros.compare.wording import EQUATIONS, SIGNALS, TARGETS
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole
from pneumo_ros.units import LINE

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison, RunComparison
    from pneumo_ros.plant import Model
    from pneumo_ros.report.chart import Report

SHOWN_RUNS = 8  # more runs than these get one line each

EXAMPLES = (
    "pneumo compare run_1 run_2 --model my.yaml",
    "pneumo compare hold_1 --fit run_1 run_2 --model my.yaml --out refitted.yaml",
    "pneumo compare run_1 --model my.yaml --read-as bar,gauge --report page.html",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., --horizon, how to read recordings, the refit, the report and the common options."""
    parser.add_argument(
        "bags", nargs="+", metavar="BAG", help="recordings: rosbag2 folders or .mcap files, or folders of these"
    )
    parser.add_argument(
        "--horizon", type=float, metavar="S", help="length of the windows (default: 1 s, or shorter runs)"
    )
    add_recordings(parser)
    add_refit(parser)
    add_model(parser)
    add_report(parser)
    parser.add_argument("--series", metavar="FILE.npz", help="write measured and predicted signals as numpy arrays")
    add_output(parser)
    parser.set_defaults(mechanics=True)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, refit if asked, compare, print, write."""
    from pneumo_ros.compare.compare import compare

    if options.horizon is not None and not options.horizon > 0.0:
        raise UsageError(f"--horizon {options.horizon:g} is not a length of time; give seconds, such as --horizon 1")
    options.bags, options.fit = unfolded(options.bags), options.fit and unfolded(options.fit)
    report = prepare_report(options)
    if options.series:
        check_writable(options.series)
    model = chosen_model(options)
    runs = read_named(options.bags, options, console, model)
    model, refit = refitted(options, console, model, runs)
    with console.progress("Comparing") as progress:
        comparison = compare(model, runs, options.horizon, lambda share, _: progress(share))
    result: dict[str, Any] = plain(comparison.as_dict() | ({"refit": refit} if refit else {}))
    result |= {"typical_error": typical_error(result["runs"]), "headline": verdict(result)}
    _print(console, model, comparison, result)
    console.json(result)
    if options.series:
        _write_series(comparison, options.series)
    then = _next(options, model, result)
    report.publish(console, lambda origin: _report(result, comparison, model, origin, f"pneumo {then}"))
    console.next(then)
    return 0


def _next(options: argparse.Namespace, model: "Model", result: dict[str, Any]) -> str:
    """Look for what is missing where an equation fails, refit where predictions drift; else use the model."""
    from pneumo_ros.wording.comparing import next_step

    machine = options.out or options.model
    own = "".join(f" --effects {shlex.quote(path)}" for path in options.effects)
    named = ("" if machine == "axis" else f" --model {shlex.quote(machine)}") + own
    how = again(options, options.out)
    step, several = next_step(result), len(options.bags) > 1
    fitted, held = parted(options.bags) if several else (options.bags, options.bags)
    if step == "refit":
        judged = f"{shlex.join(held)} --fit {shlex.join(fitted)}" if several else f"{shlex.join(fitted)} --refit"
        return f"compare {judged}{how} --out refitted.yaml"
    if step == "diagnose" and several:
        return f"diagnose {shlex.join(fitted)} --holdout {shlex.join(held)}{how}"
    if step == "diagnose":
        return f"diagnose OTHER_BAG... --holdout {shlex.quote(options.bags[0])}{how}"
    controlled = len(model.chambers) > 1 and model.coordinate == LINE
    return f"tune{named} --out my_cascade.yaml" if controlled else f"effects{named}"


def _write_series(comparison: "Comparison", path: str) -> None:
    import numpy as np

    from pneumo_ros.compare.arrays import comparison_arrays

    packed = io.BytesIO()
    np.savez(packed, **comparison_arrays(comparison))  # type: ignore[arg-type]  # numpy's stub reads them as flags
    write_whole(path, packed.getvalue())


def _report(
    result: dict[str, Any], comparison: "Comparison", model: "Model", origin: dict[str, Any], then: str
) -> "Report":
    from pneumo_ros.report.comparison import comparison_report

    return comparison_report(result, comparison, model, origin, then)


def _print(console: Console, model: "Model", comparison: "Comparison", result: dict[str, Any]) -> None:
    if "refit" in result:
        console.say(refit_text(result["refit"]) + "\n")
    for caution in model.cautions():
        console.note(f"Note: {caution}")
    console.say(comparison_text(comparison) + "\n")
    console.say(equations_text(comparison))
    console.say("\n" + findings_text(result))


def comparison_text(comparison: "Comparison") -> str:
    """The errors of every run: a table for each, or one line for each of many."""
    if len(comparison.runs) > SHOWN_RUNS:
        return runs_text(comparison)
    return "\n\n".join(run_text(one, comparison.horizon) for one in comparison.runs)


def run_text(run: "RunComparison", horizon: float) -> str:
    """Table of one run."""
    head = ("", f"rms over {horizon:g} s", "largest", "noise", "rms / noise", "fit", "free run rms")
    rows = [head]
    for name, error in run.error.items():
        words, unit, factor = SIGNALS[name]
        rms, worst, noise, free = (
            f"{factor * x:.4g} {unit}" for x in (error.rms, error.max, error.noise, run.free[name])
        )
        rows.append((words, rms, worst, noise, f"{error.ratio:.1f}", f"{error.fit_percent:.1f} %", free))
    title = f"{run.name}: {run.duration:.1f} s, {run.samples} samples, {run.windows} windows"
    return title + "\n" + columns(rows, right=(1, 2, 3, 4, 5, 6))


def runs_text(comparison: "Comparison") -> str:
    """Many runs, one line each: errors over noise."""
    signals, equations = list(comparison.runs[0].error), list(comparison.equations)
    rows = [("rms / noise", "duration", *(TARGETS[name][0] for name in (*signals, *equations)))]
    for one in comparison.runs:
        ratios = [one.error[name].ratio for name in signals]
        ratios += [one.equations[name].ratio_to_noise for name in equations]
        rows.append((one.name, f"{one.duration:.1f} s", *(f"{ratio:.1f}" for ratio in ratios)))
    title = f"{len(comparison.runs)} runs, windows of {comparison.horizon:g} s:"
    return title + "\n" + columns(rows, right=range(1, len(rows[0])))


def equations_text(comparison: "Comparison") -> str:
    """One line per equation: its residual along the measured signals, and whether noise explains it."""
    rows = []
    for name, judged in comparison.equations.items():
        if judged.explained_by_noise is None:
            rows.append((EQUATIONS[name][0], "-", "-", "not judged: nothing slides in these recordings"))
            continue
        said = "explained by noise" if judged.explained_by_noise else "FAILS: noise does not explain it"
        sizes = (f"{judged.residual_rms:.3g} {judged.unit}", f"{judged.ratio_to_noise:.1f} x noise")
        rows.append((EQUATIONS[name][0], *sizes, said))
    title = f"Equations of '{comparison.model}', residual along the measured signals:"
    return title + "\n" + columns(rows, right=(1, 2))


def findings_text(result: dict[str, Any]) -> str:
    """Where it fails: a line for each equation and signal that noise does not explain, and its details."""
    lines = [verdict(result)]
    for finding in findings(result):
        if finding.level != "good":
            lines.append(f"  {TARGETS[finding.target][0]} {finding.verdict}")
            lines += [f"    {detail}" for detail in finding.details]
    return "\n".join(lines)
