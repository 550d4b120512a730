"""Commission a new axis: how it is wired, then its machine file, gains and report, from moves of a few minutes.

Stage 0 opens the valve a little for ten seconds: is every sensor alive, are units, zeros, signs and plugs right? Stage
1 moves at constant voltages, stage 2 at levels that change; stage 3 makes the moves that narrow the intervals most,
until another minute would gain less than a tenth. Every move is rehearsed before on machines as this one may be, with
voltages small enough for the stroke. --model is the machine as data sheets tell it (pneumo new). A commissioning that
was interrupted goes on where it stopped when it is called again with the same folder.
"""

import argparse
import math
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_closed, add_model, add_output, add_rig, chosen_model
from pneumo_ros.command.commissioning_text import outcome_text, parameters_text, wiring_text
from pneumo_ros.command.console import Console, plain
from pneumo_ros.command.live_rig import declared_wiring, live_settings, rig_said
from pneumo_ros.command.machine_out import add_machine_file, check_machine_file
from pneumo_ros.command.reporting import add_report, prepare_report
from pneumo_ros.command.rig_file import rig_text
from pneumo_ros.environment import require_ros
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole

if TYPE_CHECKING:
    from pneumo_ros.commission.commission import Commissioned, Commissioning
    from pneumo_ros.commission.wiring import Wired
    from pneumo_ros.plant import Model

MINUTES, EVALUATIONS, TIMEOUT = 5.0, 40, 200.0  # min; of the gains; ms

EXAMPLES = (
    "pneumo commission --model my.yaml --closed 0V --out mine.yaml",
    "pneumo commission --model my.yaml --closed 5V --sensors gauge-bar --namespace rig --out mine.yaml",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What is known of the rig, what to write, how long to move, and the common options."""
    add_machine_file(parser, "the machine file to write", required=True)
    add_closed(parser)
    parser.add_argument(
        "--sensors", metavar="KIND", help="of pressure, such as gauge-bar or absolute-Pa (default: guessed)"
    )
    parser.add_argument(
        "--as-wired", action="store_true", help="go on with swapped or reversed plugs, corrected by the program"
    )
    parser.add_argument("--stage", type=int, choices=(0, 3), default=3, help="0: find the wiring and stop")
    parser.add_argument(
        "--minutes", type=float, default=MINUTES, metavar="MIN", help=f"of moves, at most (default: {MINUTES:g})"
    )
    parser.add_argument("--folder", metavar="FOLDER", help="for the recordings (default: the name of --out, _runs)")
    parser.add_argument("--control", metavar="FILE", help="control file to write (default: name of --out, _cascade)")
    parser.add_argument(
        "--evaluations", type=int, default=EVALUATIONS, metavar="N",
        help=f"sets of gains to try; 0: tune none (default: {EVALUATIONS})",
    )  # fmt: skip
    parser.add_argument("--timeout", type=float, default=TIMEOUT, metavar="MS", help="silence that ends a move")
    add_rig(parser)
    add_model(parser)
    add_report(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Find the wiring, move, fit, write."""
    from pneumo_ros.plant.closed import check_one_command

    check_machine_file(options)
    _check(options)
    require_ros()
    options.folder = options.folder or _beside(options.out, "_runs")
    options.control = options.control or _beside(options.out, "_cascade.yaml")
    check_writable(options.control)
    report = prepare_report(options)
    model = chosen_model(options)
    model.require_metres("commissioning")
    check_one_command(model)
    job = _job(options, console, model)
    wired = job.wiring()
    console.say(wiring_text(wired))
    rig = _write_rig(options, model, wired, console)
    if wired.faults and not options.as_wired:
        console.note(f"Mend that and call the same again with another --folder; or add --as-wired to go on with {rig}")
    stopped = bool(wired.faults and not options.as_wired) or not wired.certain
    if stopped or options.stage == 0:
        console.json({**_wiring_dict(wired), "rig_file": rig, "stage": 0})
        return 1 if stopped else 0
    found = job.run()
    result = _finish(options, console, found, rig)
    if report.page is not None or report.figures is not None:
        from pneumo_ros.report.commissioning import commissioning_report

        model = chosen_model(argparse.Namespace(model=options.out, effects=options.effects))
        report.publish(console, lambda origin: commissioning_report(result, model, origin))
    console.json(result)
    return 0


def _check(options: argparse.Namespace) -> None:
    """Raises UsageError for options that make no sense."""
    for name in ("minutes", "timeout"):
        value = getattr(options, name)
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"--{name} is {value:g}; it takes a number above 0")
    if options.evaluations < 0:
        raise UsageError(f"--evaluations is {options.evaluations}; it takes 0 or more")


def _beside(path: str, end: str) -> str:
    return str(Path(path).with_suffix("")) + end


def _job(options: argparse.Namespace, console: Console, model: "Model") -> "Commissioning":
    from pneumo_ros.command.commissioning import live
    from pneumo_ros.commission.commission import Commissioning

    words, sensors, closed = declared_wiring(options, model)
    settings = {
        **live_settings(options), "joint_name": options.joint or "piston",
        "measurement_timeout": 1e-3 * options.timeout,
    }  # fmt: skip
    if closed is not None:
        settings["closed_signal"] = f"{closed:g}V"
    perform = live(Path(options.folder), settings, (options.namespace or "").strip("/"), console)
    options.closes = closed
    return Commissioning(model, perform, words, sensors, options.minutes, console.note)


def _write_rig(options: argparse.Namespace, model: "Model", wired: "Wired", console: Console) -> str:
    """The rig file beside the machine file; its path. What --rig says of live work is kept."""
    path = _beside(options.out, "_rig.yaml")
    machine = str(Path(options.out).resolve())  # to be written
    words, origin = wired.words, "As a commissioning found it."
    place = options.namespace or "", options.joint or ""
    text = rig_text(machine, *place, words, origin, model, options.closes, rig_said(options))
    write_whole(path, text)
    console.note(f"Wiring written to {path}, for --rig")
    return path


def _wiring_dict(wired: "Wired") -> dict[str, Any]:
    return {
        "schema_version": 1,
        "wiring": {"read_as": list(wired.words), "certain": wired.certain, "swap": wired.faults},
    }


def _finish(options: argparse.Namespace, console: Console, found: "Commissioned", rig: str) -> dict[str, Any]:
    """Write machine file and gains, and say what was found; the JSON."""
    from pneumo_ros.commission.summary import errors, summary
    from pneumo_ros.plant import save_model

    save_model(found.machine, options.out)
    with console.progress("Predicting"):
        before, after = errors(found)
    result: dict[str, Any] = {
        **_wiring_dict(found.wired), "stage": 3, **summary(found),
        "error_over_noise": {"before": before, "after": after},
        "machine_file": options.out, "rig_file": rig, "folder": options.folder, "control_file": None,
    }  # fmt: skip
    result = plain(result)
    console.say(parameters_text(result))
    console.say(outcome_text(result))
    console.note(f"Machine file written to {options.out}")
    if options.evaluations:
        _tune(options, console)
        result["control_file"] = options.control
    console.next(f"diagnose {_roles(Path(options.folder))} --rig {rig} --out better.yaml --report page.html")
    return result


def _roles(folder: Path) -> str:
    """The recordings for a diagnosis: all folders that hold any, and those of the last move to judge by."""
    from pneumo_ros.records.folders import recordings_in

    made = sorted(path for path in folder.iterdir() if path.is_dir())
    held = [path for path in made if recordings_in(path)]  # a move may end before its first recording
    last = max(path for path in held if "_broken_" not in path.name)
    trained = f"{folder}/*/" if held == made else shlex.join(map(str, held))
    return f"{trained} --holdout {shlex.join(map(str, recordings_in(last)))}"


def _tune(options: argparse.Namespace, console: Console) -> None:
    from pneumo_ros.command.verb import tune

    asked = argparse.Namespace(
        law="cascade", out=options.control, control=None, amplitude=None, frequency=None, step=None, spool=None,
        evaluations=options.evaluations, executor="processes", model=options.out, effects=options.effects,
    )  # fmt: skip
    tune.run(asked, Console(console.quiet or console.json_target == "-"))
