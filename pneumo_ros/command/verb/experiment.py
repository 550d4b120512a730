"""Run an experiment on a live plant, simulated or real, to identify a machine or to distinguish effects.

Without a name, the experiments are listed. With a name, the plant runs through the trials of the experiment within the
limits of its stroke, and each trial is recorded. --plan simulates them with the model instead. --write writes them to a
file that can be edited and given in place of the name. --separate says how well each experiment would distinguish two
effects, and takes the best. The valve is closed, and the exit code is not 0, when the piston reaches an end stop or
moves the wrong way, when the plant sends nothing, and on Ctrl-C; what was recorded until then is kept.
"""

import argparse
import math
import time
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_closed, add_model, add_output, add_wiring, chosen_model
from pneumo_ros.command.chart import chart
from pneumo_ros.command.conducting import conduct
from pneumo_ros.command.console import Console, columns
from pneumo_ros.command.live_rig import declared, live_settings
from pneumo_ros.environment import require_ros
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole

if TYPE_CHECKING:
    from pneumo_ros.experiment.programme import Programme
    from pneumo_ros.experiment.rehearsal import Rehearsal
    from pneumo_ros.plant import Model

FORMATS = (".yaml", ".yml", ".csv")
TIMEOUT = 200.0  # ms

EXAMPLES = (
    "pneumo experiment constant-voltage --model my.yaml --plan            # nothing moves",
    "pneumo experiment constant-voltage --model my.yaml --namespace rig --out runs",
    "pneumo experiment --separate asymmetric_friction constant_load --plan",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """NAME, the form of the trials, where to run them, and the common options."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="experiment, or a programme file that --write made")
    parser.add_argument(
        "--voltages", nargs="+", type=float, default=[], metavar="V",
        help="magnitudes for constant-voltage, each run both ways (default: eight beyond the machine's dead zone)",
    )  # fmt: skip
    parser.add_argument("--seconds", type=float, metavar="S", help="length of each trial, from when the piston moves")
    parser.add_argument(
        "--separate", nargs=2, metavar=("A", "B"),
        help="instead of NAME: the experiment that best distinguishes effect A from effect B",
    )  # fmt: skip
    parser.add_argument("--prepared", action="store_true", help="the experiment's preparation by hand is done")
    parser.add_argument("--plan", action="store_true", help="show the trials as the model predicts them; move nothing")
    parser.add_argument("--write", metavar="FILE", help="write the programme (.yaml), or its voltages over time (.csv)")
    parser.add_argument("--out", metavar="FOLDER", help="folder for the recordings (default: experiment_1, 2, ...)")
    parser.add_argument("--namespace", default="", metavar="NS", help="of the plant, such as cylinder_1")
    parser.add_argument("--joint", default="piston", metavar="NAME", help="joint in joint_states (default: piston)")
    parser.add_argument(
        "--timeout", type=float, default=TIMEOUT, metavar="MS",
        help=f"silence of the plant that ends the experiment (default: {TIMEOUT:g} ms)",
    )  # fmt: skip
    add_closed(parser)
    add_wiring(parser)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """List, rehearse, write, or run."""
    if options.name is None and not options.separate:
        return _list(console)
    _check(options)
    dry = bool(options.plan or options.write)
    if not dry:
        require_ros()
    programme, separated = _chosen(options, console, dry) if options.separate else (_named(options), {})
    if programme is None:
        console.json({"schema_version": 1, **separated})
        return 1
    rehearsal = _rehearsed(programme, options)
    if "end stop" in rehearsal.aborted and not (options.voltages or Path(options.name or "").suffix in FORMATS):
        programme, rehearsal = _smaller(programme, rehearsal, options, console)
    if not dry:
        return _live(options, console, programme, rehearsal, separated)
    console.say(plan_text(programme, rehearsal))
    if options.write:
        _write(options.write, programme, rehearsal)
        console.note(f"Programme written to {options.write}; {_use(options.write)}")
    console.json({**plan_dict(programme, rehearsal), **separated})
    return 1 if rehearsal.aborted else 0


def _check(options: argparse.Namespace) -> None:
    """Raises UsageError for options that make no sense, alone or together."""
    if options.separate and (options.name or options.voltages or options.seconds is not None):
        raise UsageError("--separate chooses the experiment itself; it goes without NAME, --voltages and --seconds")
    if options.write and Path(options.write).suffix not in FORMATS:
        raise UsageError(f"--write {options.write}: it takes a name that ends in {', '.join(FORMATS)}")
    if options.write:
        check_writable(options.write)
    from pneumo_ros.reading.rig_file import VOLTS, quantity
    from pneumo_ros.records.corrections import parse_words

    parse_words(options.read_as)
    if options.closed is not None:
        quantity(options.closed, VOLTS, "--closed", "5V")
    if not (math.isfinite(options.timeout) and options.timeout > 0.0):
        raise UsageError(f"--timeout is {options.timeout:g} ms; it takes a number above 0")


def _list(console: Console) -> int:
    from pneumo_ros.experiment.catalogue import EXPERIMENTS

    rows = [(f"  {name}", one.purpose) for name, one in EXPERIMENTS.items()]
    console.say(
        f"{columns(rows)}\n\nShow the trials: pneumo experiment NAME --plan; run them on a live plant: without --plan."
    )
    listed = [{"name": name, "purpose": one.purpose} for name, one in EXPERIMENTS.items()]
    console.json({"schema_version": 1, "experiments": listed})
    return 0


def _model(options: argparse.Namespace) -> "Model":
    """The machine, along whose stroke in m the trials are planned."""
    model = chosen_model(options)
    model.require_metres("an experiment")
    return model


def _named(options: argparse.Namespace) -> "Programme":
    """The programme of an experiment called NAME, or of a programme file."""
    from pneumo_ros.experiment.catalogue import make_programme
    from pneumo_ros.experiment.programme_file import read_programme

    if Path(options.name).suffix not in FORMATS[:2]:
        made = make_programme(options.name, _model(options), options.voltages, options.seconds)
        return declared(made, options)
    if options.voltages or options.seconds is not None:
        raise UsageError(f"--voltages and --seconds are not for a programme file; change them in {options.name}")
    return read_programme(options.name)


def _chosen(options: argparse.Namespace, console: Console, dry: bool) -> "tuple[Programme | None, dict[str, Any]]":
    """The programme that best distinguishes the two effects, None if none does; and how well each one does, as data."""
    from pneumo_ros.command.separating import separation_dict, separation_text
    from pneumo_ros.experiment.separate import separate
    from pneumo_ros.experiment.suggestion import best, suggestion
    from pneumo_ros.experiment.whitened import Noise

    noise, (first, second) = Noise(), options.separate
    with console.progress("Separating") as progress:
        ranked = separate(_model(options), first, second, noise=noise, progress=progress)
    sentence = suggestion(ranked, first, second, options.model)
    console.say(f"{separation_text(ranked, options.separate, noise)}\n\n{sentence}\n")
    found, most = best(ranked, by_hand=dry or options.prepared), best(ranked)
    if most is not None and found is not most:
        console.note(f"{most.offer.name} needs a preparation ({most.offer.prepare}) and --prepared; not done now")
    chosen = declared(found.offer.programme, options) if found else None
    return chosen, separation_dict(ranked, options.separate, noise, sentence)


def _rehearsed(programme: "Programme", options: argparse.Namespace) -> "Rehearsal":
    """The rehearsal on the model of a programme that has been prepared."""
    from pneumo_ros.experiment.offers import conditions
    from pneumo_ros.experiment.rehearsal import rehearse

    model = _model(options)
    return rehearse(programme, conditions(programme, model).held(model))


def _smaller(
    programme: "Programme", rehearsal: "Rehearsal", options: argparse.Namespace, console: Console
) -> "tuple[Programme, Rehearsal]":
    """The programme without the constant voltages that take the model to an end stop, or with all voltages smaller."""
    from dataclasses import replace

    from pneumo_ros.commission.safe import safe

    trials = programme.trials
    for kept in range(len(rehearsal.outcomes) // 2 * 2, 0, -2) if programme.experiment == "constant-voltage" else ():
        less = replace(programme, trials=trials[:kept])
        if not (rehearsed := _rehearsed(less, options)).aborted:
            if kept < len(trials):
                left_out = ", ".join(one.voltage.text for one in trials[kept:])
                console.note(f"Left out, as the model would reach an end stop: {left_out}")
            return less, rehearsed
    found = safe(programme, [_model(options)])
    if found is None:
        return programme, rehearsal
    console.note("With smaller voltages, as the model would reach an end stop")
    return found, _rehearsed(found, options)


def _write(path: str, programme: "Programme", rehearsal: "Rehearsal") -> None:
    from pneumo_ros.experiment.programme_file import commands_text, programme_text

    as_voltages = Path(path).suffix == ".csv"
    write_whole(path, commands_text(programme, rehearsal.commands) if as_voltages else programme_text(programme))


def _use(path: str) -> str:
    verb = "simulate --input" if Path(path).suffix == ".csv" else "experiment"
    return f"use it with: pneumo {verb} {path}"


def plan_text(programme: "Programme", rehearsal: "Rehearsal") -> str:
    """The trials as the model predicts them, and the path of the piston."""
    from pneumo_ros.experiment.trial_result import ENDS

    rows = [("", "voltage", "speed", "way", "valve open", "ends because")]
    for one in rehearsal.outcomes:
        speed, way = f"{1e3 * one.speed:.1f} mm/s", f"{1e3 * one.travel:.0f} mm"
        rows.append((one.name, one.voltage, speed, way, f"{one.seconds:.1f} s", ENDS[one.ended]))
    total = f"{len(programme.trials)} trials, {_minutes(rehearsal.duration)}, {rehearsal.way:.1f} m of travel"
    title = f"{programme.experiment}, as the model of '{programme.machine}' predicts it: {total}"
    times, positions = zip(*rehearsal.path, strict=True)
    drawing = chart(times, {"*": positions}, "m")
    room = f"Room: {programme.low:g} to {programme.high:g} m; the end stop counts from +-{programme.end:g} m."
    lines = [title, columns(rows, right=(1, 2, 3, 4)), "", drawing, "", room]
    lines += [f"First {programme.prepare}."] if programme.prepare else []
    return "\n".join(lines + ([f"It would be aborted: {rehearsal.aborted}"] if rehearsal.aborted else []))


def plan_dict(programme: "Programme", rehearsal: "Rehearsal") -> dict[str, Any]:
    """The same as data, SI units."""
    from pneumo_ros.experiment.summary import trial_dict

    return {
        "schema_version": 1, "experiment": programme.experiment, "machine": programme.machine,
        "duration_s": rehearsal.duration, "travel_m": rehearsal.way, "aborted": rehearsal.aborted,
        "prepare": programme.prepare, "trials": [trial_dict(one) for one in rehearsal.outcomes],
    }  # fmt: skip


def _minutes(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.1f} minutes"


def _live(
    options: argparse.Namespace,
    console: Console,
    programme: "Programme",
    rehearsal: "Rehearsal",
    separated: dict[str, Any],
) -> int:
    """Run it on a plant."""
    if programme.prepare and not options.prepared:
        raise UsageError(f"{programme.experiment} needs a preparation: first {programme.prepare}, then add --prepared")
    if rehearsal.aborted:
        console.note(f"Note: on the model this would be aborted: {rehearsal.aborted}")
    folder = Path(options.out) if options.out else _next_folder()
    console.note(f"{len(programme.trials)} trials, about {_minutes(rehearsal.duration)}; Ctrl-C closes the valve")
    began = time.monotonic()
    settings: dict[str, object] = {"output": str(folder.resolve()), "joint_name": options.joint}
    settings |= live_settings(options)
    settings["measurement_timeout"] = float(1e-3 * options.timeout)
    code, result = conduct(programme, settings, options.namespace.strip("/"), console)
    if code == 0:
        console.say(f"Done in {_minutes(time.monotonic() - began)}. Next: {_next(programme.experiment, folder)}")
    console.json({**result, **separated, "folder": str(folder), "exit_code": code})
    return code


def _next(experiment: str, folder: Path) -> str:
    if experiment == "constant-voltage":
        return f"pneumo identify {folder} --out identified.yaml"
    return f"pneumo compare {folder}/*/"


def _next_folder() -> Path:
    return next(path for number in count(1) if not (path := Path(f"experiment_{number}")).exists())
