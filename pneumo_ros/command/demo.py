"""The axis on ROS 2: simulator, controller and recorder run as processes; the recording is compared with the model."""

import argparse
import math
import time
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.bag_summary import hardship, traffic
from pneumo_ros.command.chart import chart
from pneumo_ros.command.compare import equations_text, run_text
from pneumo_ros.command.console import Console, program
from pneumo_ros.command.processes import Fleet
from pneumo_ros.environment import require_ros
from pneumo_ros.errors import DataError, PneumoError, UsageError
from pneumo_ros.files import check_new_folder

if TYPE_CHECKING:
    from pneumo_ros.diagnose.compare import Comparison
    from pneumo_ros.records import Recording

LEVELS = (0.1, -0.05, 0.05, 0.0)  # m, where the piston is sent, one after the other
SECONDS = 16.0  # in all
START = 60.0  # s, until the first valve command; the kernel may have to be compiled
# Sensors as on a rig: position alone, 5 um and 10 um steps; 300 Pa and 16 bit over 10 bar
SENSORS = {
    "publish_velocity": False,
    "noise_position": 5e-6,
    "quantisation_position": 1e-5,
    "noise_pressure": 300.0,
    "quantisation_pressure": 1e6 / 2**16,
    "seed": 1,
}
NAMESPACE = "demo"
OWN_ERROR = """This plant is the model. What exceeds the noise is timing: a command acts when it reaches the simulator
and is stamped when it reaches the recorder, a fraction of a millisecond apart, and a piston near sticking minds."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--recording, --seconds, --out and the common options."""
    other = "also compare the default machine with this recording, which it has not made"
    length = f"how long the axis runs (default: {SECONDS:g})"
    parser.add_argument("--recording", metavar="BAG", help=other)
    parser.add_argument("--seconds", type=float, default=SECONDS, metavar="S", help=length)
    parser.add_argument("--out", metavar="DIR", help="new folder for bag and logs (default: demo_output/1, 2, ...)")
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Run the nodes, read the bag back, compare."""
    require_ros()
    if not (math.isfinite(options.seconds) and options.seconds >= 4.0):
        raise UsageError(f"--seconds is {options.seconds:g}; it takes at least 4, so that there is something to see")
    other = _recording(options.recording) if options.recording else None
    folder = check_new_folder(options.out) if options.out else _next_folder(Path("demo_output"))
    folder.mkdir(parents=True)
    bag = folder / "bag"

    console.say("1. The axis runs: simulator, controller and recorder, three processes on ROS 2\n")
    codes = drive(bag, folder / "logs", options.seconds, console)
    console.say(traffic(bag))
    console.say(f"\nExit codes: {', '.join(f'{name} {code}' for name, code in codes.items())}")
    if busy := hardship(bag):
        console.say(f"\n{busy}")
    recording = _recording(bag)
    console.say("\n2. It moves: piston position (*) and reference (-)\n")
    console.say(motion(recording, options.seconds))
    console.say("\n3. The model against the recording just made\n")
    own = _compare(recording, console)
    console.say(f"\n{OWN_ERROR}")
    result: dict[str, Any] = {"schema_version": 1, "bag": bag, "exit_codes": codes, "own": own.as_dict()}
    if other:
        console.say("\n4. The model against a recording it did not make\n")
        comparison = _compare(other, console)
        console.say(f"\n{judgement(comparison)}")
        result["other"] = comparison.as_dict()
    console.say(f"\n{_farewell(bag, options.recording)}")
    console.json(result)
    return int(any(codes.values()))


def drive(bag: Path, logs: Path, seconds: float, console: Console) -> dict[str, int]:
    """Run the nodes for `seconds` of motion and end them; exit codes by name. PneumoError when one of them fails."""
    steps = {"reference.shape": "steps", "reference.levels": LEVELS, "reference.hold": seconds / len(LEVELS)}
    with Fleet(logs) as fleet:
        fleet.start("recorder", "pneumo_ros.ros.recorder", {"output": str(bag)}, NAMESPACE)
        fleet.start("simulator", "pneumo_ros.ros.simulator", SENSORS, NAMESPACE)
        fleet.start("controller", "pneumo_ros.ros.controller", steps, NAMESPACE)
        console.note("Starting the nodes")
        _wait_for_motion(fleet, bag)
        began = time.monotonic()
        with console.progress("Recording") as progress:
            while (passed := time.monotonic() - began) < seconds:
                progress(passed / seconds)
                fleet.wait(0.1)
        return fleet.stop()


def _wait_for_motion(fleet: Fleet, bag: Path) -> None:
    """Until the first valve command is in the bag; PneumoError after a minute."""
    from pneumo_ros.records import Bag

    for _ in range(round(START / 0.25)):
        fleet.wait(0.25)
        try:
            if Bag(bag).overview().counts.get(f"/{NAMESPACE}/valve/command"):
                return
        except DataError:  # nothing recorded yet
            continue
    raise PneumoError(f"no valve command within {START:g} s; what the nodes said is in {fleet.logs}")


def _recording(path: "Path | str") -> "Recording":
    from pneumo_ros.records import read_recording

    return read_recording(path)


def motion(recording: "Recording", seconds: float) -> str:
    """Chart of position and reference, and how near the piston came to each level."""
    import numpy as np

    assert recording.command_time is not None
    begin = float(recording.command_time[0])  # the controller counts from its first measurement
    hold = seconds / len(LEVELS)
    shown = (recording.time >= begin) & (recording.time < begin + seconds)
    passed, position = recording.time[shown] - begin, recording.position[shown]
    step = np.minimum(passed // hold, len(LEVELS) - 1).astype(int)
    drawing = chart(passed.tolist(), {"-": np.array(LEVELS)[step].tolist(), "*": position.tolist()}, "m")
    ends = [float(position[step == k][-1]) for k in range(len(LEVELS))]
    errors = ", ".join(f"{1e3 * abs(end - level):.2f}" for end, level in zip(ends, LEVELS, strict=True))
    return f"{drawing}\n\nDistance from the reference at the end of each step: {errors} mm"


def _compare(recording: "Recording", console: Console) -> "Comparison":
    """The default machine against a recording, printed."""
    from pneumo_ros.diagnose.compare import compare
    from pneumo_ros.identify.run import make_run
    from pneumo_ros.plant import load_model

    for warning in recording.warnings:
        console.note(f"{recording.name}: {warning}")
    with console.progress("Comparing") as progress:
        comparison = compare(load_model(), [make_run(recording)], progress=lambda share, _: progress(share))
    console.say(run_text(comparison.runs[0], comparison.horizon))
    console.say()
    console.say(equations_text(comparison))
    return comparison


def judgement(comparison: "Comparison") -> str:
    """One sentence on a machine that is not the model."""
    failing = [name.replace("_", " ") for name, one in comparison.equations.items() if not one.explained_by_noise]
    if not failing:
        return "Noise explains every equation: this machine is like the model."
    names = f"{', '.join(failing[:-1])} and {failing[-1]}" if len(failing) > 1 else failing[0]
    return f"Noise does not explain {names}: this machine has other parameters than the model, or other physics."


def _farewell(bag: Path, other: str | None) -> str:
    verbs = (f"compare {other or bag}", "effects", "--help")
    return "\n".join((f"Bag and logs are in {bag.parent}. Next:", *(f"  {program()} {verb}" for verb in verbs)))


def _next_folder(parent: Path) -> Path:
    """The first of parent/1, parent/2, ... that does not exist."""
    return next(path for path in (parent / str(number) for number in count(1)) if not path.exists())
