"""Find gains of a control law for a machine by simulation, and write the control file."""

import argparse
import math
from dataclasses import astuple
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_executor, add_model, add_output, chosen_model, model_for_workers
from pneumo_ros.command.console import Console, columns
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from pneumo_ros.command.rated_motions import Task
    from pneumo_ros.control.control_file import Control
    from pneumo_ros.control.tuning import Search
    from pneumo_ros.plant import Model

EVALUATIONS = 80

EXAMPLES = (
    "pneumo tune --law cascade --model my.yaml --out my_cascade.yaml",
    "pneumo tune --law pid --amplitude 0.02 --frequency 1 --model my.yaml --out my_pid.yaml",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--law, --out and the references to follow."""
    parser.add_argument("--law", metavar="NAME", help="pid, pva, cascade (default) or sliding_mode")
    parser.add_argument("--out", required=True, metavar="FILE", help="control file to write")
    parser.add_argument("--control", metavar="FILE", help="control file to start from (default: the law's defaults)")
    parser.add_argument("--amplitude", type=float, metavar="M", help="of the sine to follow (default: 0.15 strokes)")
    parser.add_argument("--frequency", type=float, metavar="HZ", help="of the sine (default: 0.64 of the top speed)")
    parser.add_argument("--step", type=float, metavar="M", help="of the moves to make (default: 0.03 strokes)")
    slow = "the gains must also suit a valve spool of this angular frequency, even if the machine file has none"
    parser.add_argument("--spool", type=float, metavar="RAD/S", help=slow)
    runs = f"how many sets of gains to try, each in four runs (default: {EVALUATIONS})"
    parser.add_argument("--evaluations", type=int, default=EVALUATIONS, metavar="N", help=runs)
    add_executor(parser)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Tune, write the control file, print the cost and the changes."""
    from pneumo_ros.command.rated_motions import reached, task_for
    from pneumo_ros.control.control_file import Control
    from pneumo_ros.plant.closed import centred, check_one_command

    _check(options)
    start, model = _start(options), chosen_model(options)
    if model.force_driven:
        raise UsageError(f"{model.name} has no valve to control; give a machine file with a section 'chambers'")
    model.require_metres("a law of control")
    model.require_two_chambers("a law of control")
    check_one_command(model)
    model = centred(model)  # laws count their voltages from the closed signal
    task = task_for(model, options.amplitude, options.frequency, options.step)
    search = _search(options, start, model, task, console)
    found = Control(start.law, {**start.gains, **search.gains}, start.smoothing)
    write_whole(options.out, found.text(_heading(start.law, model, task, options.spool)))
    _tell(options, start, model, search, console, reached(model, task, found.make(model.effects, model.parameters)))
    return 0


def _check(options: argparse.Namespace) -> None:
    check_writable(options.out)
    for name in ("amplitude", "frequency", "step", "spool", "evaluations"):
        value = getattr(options, name)
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"--{name} is {value:g}; it takes a number above 0")


def _start(options: argparse.Namespace) -> "Control":
    from pneumo_ros.control import LAWS
    from pneumo_ros.control.control_file import Control, load_control

    given = load_control(options.control) if options.control else Control(options.law or "cascade", {})
    if given.law not in LAWS:
        raise UsageError(unknown_name("law", given.law, LAWS))
    if options.law not in (None, given.law):
        raise UsageError(f"--law is {options.law}, but {options.control} is for {given.law}; leave one of them out")
    return given


def _search(options: argparse.Namespace, start: "Control", model: "Model", task: "Task", console: Console) -> "Search":
    from pneumo_ros.command.tuning import costs_over
    from pneumo_ros.control.tuning import Search
    from pneumo_ros.sweep import open_pool

    console.note(
        f"Tuning {start.law} for {model.name}: sine of {task.amplitude:g} m, {task.frequency:.3g} Hz, and moves of "
        f"{1e3 * task.step:g} mm"
    )
    with open_pool(options.executor) as pool, console.progress("Tuning") as progress:
        search = Search(
            start.make(model.effects, model.parameters),
            costs_over(pool, start, (*model_for_workers(options), astuple(task), options.spool)),
            options.evaluations,
            lambda count, _: progress(count / options.evaluations),
        )
        search.run()
    return search


def _heading(law: str, model: "Model", task: "Task", spool: float | None) -> str:
    slow = f" and a spool of {spool:g} rad/s" if spool else ""
    return (
        f"Gains of {law} for the machine {model.name}, found by simulation: pneumo tune --law {law}\n"
        f"on a sine of {task.amplitude:g} m and {task.frequency:.3g} Hz and on moves of {1e3 * task.step:g} mm in "
        f"{task.duration:.2g} s,\nwith the machine and with twice its mass, 20 % more friction{slow}."
    )


def _tell(
    options: argparse.Namespace,
    start: "Control",
    model: "Model",
    search: "Search",
    console: Console,
    errors: tuple[float, float],
) -> None:
    from pneumo_ros.control import LAWS

    gains = LAWS[start.law].gains
    before = {name: start.gains.get(name, gains[name].default) for name in search.gains}
    rows = [(n, f"{before[n]:g}", f"{search.gains[n]:g}", gains[n].unit) for n in search.gains]
    console.say(f"Tuned {start.law} for {model.name}: cost {search.first:.3f} -> {search.least:.3f}")
    console.say(columns([("gain", "before", "after", ""), *rows], right=(1, 2)))
    along, end = (1e3 * error for error in errors)
    console.say(f"In simulation it follows the sine within {along:.3g} mm rms; moves end within {end:.2g} mm.")
    node = f"ros2 run pneumo_ros controller --ros-args --params-file {options.out}"
    console.say(f"Written to {options.out}")
    console.note(f"Next: {node} --params-file MACHINE.yaml")
    console.json(
        {
            "schema_version": 1,
            "model": model.name,
            "law": start.law,
            "gains": search.gains,
            "cost": {"before": search.first, "after": search.least},
            "evaluations": search.count,
            "error_m": {"sine_rms": errors[0], "move_end": errors[1]},
            "control": options.out,
        }
    )
