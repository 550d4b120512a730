"""Compare a model with recordings: error per run and signal against the sensor noise, and the equations that fail.

Each run is predicted in windows of --horizon seconds, every window from a start state estimated around its first
sample, and once more from its first sample alone (free run).
"""

import argparse
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_model, add_output, chosen_model
from pneumo_ros.command.console import Console, columns
from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.diagnose.compare import Comparison, RunComparison
    from pneumo_ros.identify.run import Run

# report name -> words, unit shown, factor from SI
SHOWN = {
    "position_m": ("position", "mm", 1e3),
    "pressure_a_pa": ("pressure a", "kPa", 1e-3),
    "pressure_b_pa": ("pressure b", "kPa", 1e-3),
}
EQUATIONS = {"momentum": "momentum", "chamber_a": "chamber a", "chamber_b": "chamber b"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., --horizon, --namespace and the common options."""
    parser.add_argument("bags", nargs="+", metavar="BAG", help="recordings: rosbag2 folders or .mcap files")
    parser.add_argument("--horizon", type=float, default=1.0, metavar="S", help="length of the windows (default: 1 s)")
    parser.add_argument("--namespace", metavar="NS", help="of the axis, where a recording holds several")
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, compare, print."""
    from pneumo_ros.diagnose.compare import compare

    if not options.horizon > 0.0:
        raise UsageError(f"--horizon {options.horizon:g} is no length of time; give seconds, such as --horizon 1")
    model = chosen_model(options)
    runs = read_runs(options, console, model.force_driven)
    with console.progress("Comparing") as progress:
        comparison = compare(model, runs, options.horizon, lambda share, _: progress(share))
    for caution in model.cautions():
        console.note(f"Note: {caution}")
    for result in comparison.runs:
        console.say(run_text(result, comparison.horizon))
        console.say()
    console.say(equations_text(comparison))
    console.json(comparison.as_dict())
    return 0


def read_runs(options: argparse.Namespace, console: Console, force_driven: bool) -> "list[Run]":
    """The recordings named on the command line, on uniform grids; what is wrong with them is noted."""
    from pneumo_ros.identify.run import make_run
    from pneumo_ros.records import read_recording

    runs = []
    for bag in options.bags:
        recording = read_recording(bag, options.namespace)
        for warning in recording.warnings:
            console.note(f"{recording.name}: {warning}")
        runs.append(make_run(recording, force_driven))
    return runs


def run_text(run: "RunComparison", horizon: float) -> str:
    """Table of one run."""
    head = ("", f"rms over {horizon:g} s", "largest", "noise", "rms / noise", "fit", "free run rms")
    rows = [head]
    for name, error in run.error.items():
        words, unit, factor = SHOWN[name]
        rms, worst, noise, free = (
            f"{factor * x:.4g} {unit}" for x in (error.rms, error.max, error.noise, run.free[name])
        )
        rows.append((words, rms, worst, noise, f"{error.ratio:.1f}", f"{error.fit_percent:.1f} %", free))
    title = f"{run.name}: {run.duration:.1f} s, {run.samples} samples, {run.windows} windows"
    return title + "\n" + columns(rows, right=(1, 2, 3, 4, 5, 6))


def equations_text(comparison: "Comparison") -> str:
    """One line per equation: its residual along the measured signals, and whether noise explains it."""
    rows = [
        (
            EQUATIONS[name],
            f"{verdict.residual_rms:.3g} {verdict.unit}",
            f"{verdict.ratio_to_noise:.1f} x noise",
            "explained by noise" if verdict.explained_by_noise else "FAILS: noise does not explain it",
        )
        for name, verdict in comparison.equations.items()
    ]
    title = f"Equations of '{comparison.model}', residual along the measured signals:"
    return title + "\n" + columns(rows, right=(1, 2))
