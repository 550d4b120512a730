"""Run the machine from a voltage or from a recording's commands, and write what it does as a recording."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros import __version__
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_model
from pneumo_ros.command.console import Console, columns, program
from pneumo_ros.command.inputs import FORMS, parse_drive
from pneumo_ros.command.recordings import read_one
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_new_folder

if TYPE_CHECKING:
    from pneumo_ros.command.playing import Plan
    from pneumo_ros.plant import Model

EXAMPLES = (
    "pneumo simulate --input step:2.5@1 --seconds 5 --out step_run",
    "pneumo simulate --input sine:3,0.5 --seconds 20 --model my.yaml --out sine_run",
    "pneumo simulate --input step_run --model better.yaml --out again   # the commands of a recording",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--input, --out, duration, rate and start."""
    new = "folder of the new recording; it must not exist yet"
    parser.add_argument("--input", required=True, metavar="SPEC", help=f"input of the valve: {FORMS}")
    parser.add_argument("--out", required=True, metavar="BAG", help=new)
    parser.add_argument("--seconds", type=float, metavar="S", help="how long (default: the input, else 10)")
    parser.add_argument("--rate", type=float, metavar="HZ", help="samples per second (default: 1000)")
    parser.add_argument("--position", type=float, metavar="M", help="where the piston starts (default: 0)")
    add_recordings(parser, cut=False)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Simulate, write the recording, print a summary."""
    from pneumo_ros.command.playing import played, recorded
    from pneumo_ros.records.writing import write_recording

    check_new_folder(options.out)
    model = chosen_model(options)
    plan = make_plan(options, model, console)
    with console.progress("Simulating") as progress:
        states = played(model, plan, progress)
    signals = recorded(model, plan, states)
    description = {"schema_version": 1, "version": __version__, "model": model.as_dict(), "seed": None}
    console.note(f"Writing {len(states)} samples to {options.out}")
    write_recording(options.out, **signals, **plan.commands, description=description)
    console.say(f"Simulated {model.name} for {plan.samples * plan.sample_time:g} s: {plan.text}")
    console.say(columns(extremes(signals), right=(1, 2, 3, 4)))
    console.say(f"Written to {options.out}; see also: {program()} compare {options.out}")
    console.json(
        {
            "schema_version": 1,
            "model": model.name,
            "recording": options.out,
            "samples": len(states),
            "duration_s": plan.samples * plan.sample_time,
            "final_state": dict(zip(model.states, states[-1], strict=True)),
        }
    )
    return 0


def make_plan(options: argparse.Namespace, model: "Model", console: Console) -> "Plan":
    """What the options ask for; UsageError for lengths and rates that make no sense."""
    from pneumo_ros.command.playing import drive_plan, replay_plan

    for name, value in (("--seconds", options.seconds), ("--rate", options.rate)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} is {value:g}; it takes a number above 0")
    path = Path(options.input)
    if path.is_dir() or path.suffix in (".mcap", ".db3"):
        reading = read_one(options.input, options, console, model)
        if options.rate is not None:
            kept = 1.0 / reading.recording.sample_time
            raise UsageError(f"leave out --rate: a replay keeps the {kept:.0f} Hz of its recording")
        return replay_plan(model, reading, seconds=options.seconds, position=options.position)
    if options.namespace or options.joint or options.read_as:
        raise UsageError(f"--namespace, --joint and --read-as go with a recording; --input is {options.input}")
    drive = parse_drive(options.input)
    return drive_plan(model, drive, seconds=options.seconds, rate=options.rate, position=options.position or 0.0)


UNITS = {"position": "m", "velocity": "m/s", "effort": "N", "pressure_a": "Pa", "pressure_b": "Pa"}


def extremes(signals: dict[str, Any]) -> list[tuple[str, ...]]:
    """Table: first, last, least and greatest value of each signal."""
    rows: list[tuple[str, ...]] = [("", "start", "end", "least", "greatest", "")]
    for name, unit in UNITS.items():
        if name in signals:
            values = signals[name]
            numbers = (values[0], values[-1], values.min(), values.max())
            negligible = 1e-9 * abs(values).max()
            rows.append((name, *(f"{number if abs(number) > negligible else 0.0:.5g}" for number in numbers), unit))
    return rows
