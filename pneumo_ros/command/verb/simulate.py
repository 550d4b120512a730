"""Run the machine from a voltage or from a recording's commands, and write what it does as a recording."""

import argparse
import math
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros import __version__
from pneumo_ros.command.again import again
from pneumo_ros.command.arguments import add_model, add_output, add_recordings, chosen_machine, chosen_model
from pneumo_ros.command.console import Console, columns
from pneumo_ros.command.inputs import FORMS, parse_drive
from pneumo_ros.command.noisy import EXAMPLE, parse_noise, with_noise
from pneumo_ros.command.recordings import read_one
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_new_folder
from pneumo_ros.units import shown

if TYPE_CHECKING:
    from numpy.random import Generator

    from pneumo_ros.command.playing import Plan
    from pneumo_ros.multiaxis import Machine
    from pneumo_ros.plant import Model

EXAMPLES = (
    "pneumo simulate --input step:2.5@1 --seconds 5 --out step_run",
    "pneumo simulate --input sine:3,0.5 --seconds 20 --model my.yaml --out sine_run",
    "pneumo simulate --input sine:3,0.5 --noise position=5e-6,pressure_a=200,pressure_b=200 --seed 1 --out noisy_run",
    "pneumo simulate --input step_run --model better.yaml --out again   # the commands of a recording",
    "pneumo simulate --input shoulder=step:2.5@1 --input elbow=sine:3,0.5 --model two.yaml --out both",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--input, --out, duration, rate and start."""
    new = "folder of the new recording; it must not exist yet"
    parser.add_argument(
        "--input", required=True, action="append", metavar="SPEC",
        help=f"input of the valve: {FORMS}; with several axes shoulder=SPEC, once for each that moves, or a recording",
    )  # fmt: skip
    parser.add_argument(
        "--input-b",
        action="append",
        metavar="SPEC",
        help="input of the valve of chamber b, where there are two (default: against --input)",
    )
    parser.add_argument("--out", required=True, metavar="BAG", help=new)
    parser.add_argument("--seconds", type=float, metavar="S", help="how long (default: the input, else 10)")
    parser.add_argument("--rate", type=float, metavar="HZ", help="samples per second (default: 1000)")
    parser.add_argument("--position", type=float, metavar="M", help="where the piston starts (default: 0)")
    parser.add_argument(
        "--noise", metavar="SIGNAL=SIZE,...", action="append", default=[],
        help=f"white noise of sensors, as standard deviations in m and Pa: {EXAMPLE}",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, metavar="N", help="of the noise (default: 0)")
    add_recordings(parser, cut=False)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Simulate, write the recording, print a summary."""
    from pneumo_ros.command.playing import played, recorded
    from pneumo_ros.records.writing import write_recording

    check_new_folder(options.out)
    _check_numbers(options)
    noise, random = _noise(options)
    if machine := chosen_machine(options):
        return _run_axes(machine, options, console, noise, random)
    model = chosen_model(options)
    options.input = _only(options.input, "--input", model)
    options.input_b = options.input_b and _only(options.input_b, "--input-b", model)
    plan = make_plan(options, model, console)
    with console.progress("Simulating") as progress:
        states = played(model, plan, progress)
    signals = with_noise(recorded(model, plan, states), noise, random, force_driven=model.force_driven)
    description = {"schema_version": 1, "version": __version__, "model": model.as_dict(), "seed": options.seed}
    console.note(f"Writing {len(states)} samples to {options.out}")
    write_recording(options.out, **signals, **plan.commands, description=description)
    console.say(f"Simulated {model.name} for {plan.samples * plan.sample_time:g} s: {plan.text}")
    console.say(columns(extremes(signals), right=(1, 2, 3, 4)))
    console.say(f"Written to {options.out}")
    console.next(f"compare {shlex.quote(str(options.out))}{again(options)}")
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


def _run_axes(
    machine: "Machine", options: argparse.Namespace, console: Console, noise: dict[str, float], random: "Generator"
) -> int:
    """The same for a machine of several axes: one recording, each axis under its prefix."""
    from pneumo_ros.command.axes_playing import axes_plans, played_together, write_together

    plans = axes_plans(machine, options, console)
    first = next(iter(plans.values()))
    with console.progress("Simulating") as progress:
        states = played_together(machine, plans, progress)
    console.note(f"Writing {len(states)} samples to {options.out}")
    signals = write_together(options.out, machine, plans, states, noise, random, options.seed)
    console.say(f"Simulated {machine.name} for {first.samples * first.sample_time:g} s")
    for axis, one in signals.items():
        console.say(f"\n{axis}/: {plans[axis].text}\n{columns(extremes(one), right=(1, 2, 3, 4))}")
    if machine.supply is not None:
        console.say(f"\nThe supply drops by up to {1e-5 * states[:, -1].max():.3g} bar")
    console.say(f"Written to {options.out}")
    console.next(f"compare {shlex.quote(str(options.out))}{again(options)}")
    final = {
        name: dict(zip(machine.axes[name].states, x[-1], strict=True)) for name, x in machine.split(states).items()
    }
    console.json(
        {
            "schema_version": 1,
            "model": machine.name,
            "recording": options.out,
            "samples": len(states),
            "duration_s": first.samples * first.sample_time,
            "axes": {name: {"final_state": state} for name, state in final.items()},
        }
    )
    return 0


def _check_numbers(options: argparse.Namespace) -> None:
    for name, value in (("--seconds", options.seconds), ("--rate", options.rate)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} is {value:g}; it takes a number above 0")


def _noise(options: argparse.Namespace) -> tuple[dict[str, float], "Generator"]:
    """--noise, and the generator of --seed, which is then a number; UsageError for a seed without noise."""
    import numpy as np

    noise = parse_noise(options.noise)
    if options.seed is not None and not noise:
        raise UsageError(f"--seed {options.seed} goes with --noise, such as --noise {EXAMPLE}")
    if options.seed is not None and options.seed < 0:
        raise UsageError(f"--seed is {options.seed}; it takes a whole number of at least 0")
    if noise and options.seed is None:
        options.seed = 0
    return noise, np.random.default_rng(options.seed)


def _only(given: list[str], option: str, model: "Model") -> str:
    """The one value that a machine of one axis takes."""
    if len(given) > 1:
        raise UsageError(f"'{model.name}' has one axis; give {option} once, not {len(given)} times")
    return given[0]


def make_plan(options: argparse.Namespace, model: "Model", console: Console) -> "Plan":
    """What the options ask for; UsageError for options that do not go together."""
    from pneumo_ros.command.playing import drive_plan, replay_plan

    path = Path(options.input)
    if path.is_dir() or path.suffix in (".mcap", ".db3"):
        if options.input_b:
            raise UsageError("leave out --input-b: a replay takes both commands from its recording")
        reading = read_one(options.input, options, console, model)
        if options.rate is not None:
            kept = 1.0 / reading.recording.sample_time
            raise UsageError(f"leave out --rate: a replay keeps the {kept:.0f} Hz of its recording")
        return replay_plan(model, reading, seconds=options.seconds, position=options.position)
    if options.namespace or options.joint or options.read_as:
        raise UsageError(f"--namespace, --joint and --read-as go with a recording; --input is {options.input}")
    drive = parse_drive(options.input)
    second = parse_drive(options.input_b) if options.input_b else None
    return drive_plan(
        model, drive, seconds=options.seconds, rate=options.rate, position=options.position or 0.0, second=second
    )


UNITS = {"position": "m", "velocity": "m/s", "effort": "N", "pressure_a": "Pa", "pressure_b": "Pa"}


def extremes(signals: dict[str, Any]) -> list[tuple[str, ...]]:
    """Table: first, last, least and greatest value of each signal."""
    rows: list[tuple[str, ...]] = [("", "start", "end", "least", "greatest", "")]
    for name, unit in UNITS.items():
        if name in signals:
            values = signals[name]
            numbers = (values[0], values[-1], values.min(), values.max())
            negligible = 1e-9 * abs(values).max()
            cells = (f"{number if abs(number) > negligible else 0.0:.5g}" for number in numbers)
            rows.append((name, *cells, shown(unit)))
    return rows
