"""Run the machine from a voltage or from a recording's commands, and write what it does as a recording."""

import argparse
import math
from dataclasses import dataclass
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
    import numpy as np
    from numpy.typing import NDArray

    from pneumo_ros.plant import Model

    Array = NDArray[np.float64]

SECONDS = 10.0  # of an input without an end
RATE = 1000.0  # Hz
CHUNK = 50_000  # samples between two reports of progress


@dataclass(frozen=True)
class Plan:
    """The simulation to run.

    held: (samples * parts, inputs) voltage [V], or force [N], and what else the model reads; `parts` rows one after
    another in each sample.
    state: where it starts; text: what it is, for a person; commands: the arrays that the recording is to hold.
    """

    held: "Array"
    parts: int
    sample_time: float
    state: "Array"
    text: str
    commands: dict[str, Any]

    @property
    def samples(self) -> int:
        """How many samples are simulated."""
        return len(self.held) // self.parts


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
    parser.add_argument("--seconds", type=float, metavar="S", help=f"how long (default: the input, else {SECONDS:g})")
    parser.add_argument("--rate", type=float, metavar="HZ", help=f"samples per second (default: {RATE:g})")
    parser.add_argument("--position", type=float, metavar="M", help="where the piston starts (default: 0)")
    add_recordings(parser, cut=False)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Simulate, write the recording, print a summary."""
    from pneumo_ros.records.writing import write_recording

    check_new_folder(options.out)
    model = chosen_model(options)
    plan = make_plan(options, model, console)
    states = simulate(model, plan, console)
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


def make_plan(options: argparse.Namespace, model: "Model", console: Console) -> Plan:
    """What the options ask for; UsageError for lengths and rates that make no sense."""
    for name, value in (("--seconds", options.seconds), ("--rate", options.rate)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} is {value:g}; it takes a number above 0")
    path = Path(options.input)
    replays = path.is_dir() or path.suffix in (".mcap", ".db3")
    if replays:
        return _replay(options, model, console)
    if options.namespace or options.joint or options.read_as:
        raise UsageError(f"--namespace, --joint and --read-as go with a recording; --input is {options.input}")
    return _drive(options, model)


def _drive(options: argparse.Namespace, model: "Model") -> Plan:
    """The plan for a formula or a CSV file."""
    import numpy as np

    drive = parse_drive(options.input)
    if further := ", ".join(model.inputs[1:]):
        raise UsageError(
            f"effects of '{model.name}' read measured signals ({further}); give --input a recording that has them"
        )
    dt = 1.0 / (options.rate or RATE)
    samples = max(1, round((options.seconds or drive.duration or SECONDS) / dt))
    time = np.arange(1 + samples, dtype=float) * dt
    volts = drive.voltage(time)
    commands = {} if model.force_driven else {"voltage": volts}
    return Plan(volts[:-1, None], 1, dt, model.state(y=options.position or 0.0), drive.text, commands)


def _replay(options: argparse.Namespace, model: "Model", console: Console) -> Plan:
    """The plan for a recording: its commands at their times, from its start state."""
    import numpy as np

    from pneumo_ros.runs.run import PARTS
    from pneumo_ros.shooting.start import start_states

    reading = read_one(options.input, options, console, model)
    recording, run = reading.recording, reading.run
    if options.rate is not None:
        raise UsageError(f"leave out --rate: a replay keeps the {1.0 / recording.sample_time:.0f} Hz of its recording")
    samples = len(run) - 1 if options.seconds is None else round(options.seconds / run.sample_time)
    if not 1 <= samples < len(run):
        raise UsageError(f"--seconds is {options.seconds:g}; {recording.name} lasts {recording.duration:g} s")
    state = start_states(model, run, np.zeros(1, dtype=np.int64))[0]
    if options.position is not None:
        state = model.state(**{**dict(zip(model.states, state, strict=True)), "y": options.position})
    commands: dict[str, Any] = {}
    if recording.command_time is not None and recording.command is not None:
        sent = recording.command_time <= samples * run.sample_time
        commands = {"command_time": recording.command_time[sent], "command": recording.command[sent]}
    text = f"the commands of {recording.name}"
    return Plan(run.inputs(model.inputs)[: samples * PARTS], PARTS, run.sample_time, state, text, commands)


def simulate(model: "Model", plan: Plan, console: Console) -> "Array":
    """States (samples + 1, states) at the start and at the end of each sample."""
    import numpy as np

    rows = [plan.state[None, :]]
    with console.progress("Simulating") as progress:
        for begin in range(0, plan.samples, CHUNK):
            held = plan.held[begin * plan.parts : (begin + CHUNK) * plan.parts]
            start = begin * plan.sample_time
            rows.append(model.simulate(held, rows[-1][-1], sample_time=plan.sample_time, start=start, parts=plan.parts))
            progress((begin + CHUNK) / plan.samples)
    return np.concatenate(rows)


def recorded(model: "Model", plan: Plan, states: "Array") -> dict[str, Any]:
    """The arrays that `write_recording` takes; measured pressures that the model read are recorded again."""
    import numpy as np

    from pneumo_ros.plant.signals import DRIVE

    time = np.arange(len(states)) * plan.sample_time
    column = {name: states[:, index] for index, name in enumerate(model.states)}
    signals = {"time": time, "position": column["y"], "velocity": column["v"]}
    if model.force_driven:
        held = np.concatenate([plan.held[:: plan.parts], plan.held[-1:]])
        read = dict(zip(model.inputs, held.T, strict=True))
        pressures = {f"pressure_{side}": read[f"p_{side}"] for side in "ab" if f"p_{side}" in read}
        return {**signals, "effort": read[DRIVE], **pressures}
    return {**signals, "effort": model.effort(states), "pressure_a": column["p_a"], "pressure_b": column["p_b"]}


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
