"""Show the program at work: an axis on ROS 2, then a machine with a hidden effect that is found, added and revealed.

A seed chooses the machine and its hidden effect. Another program simulates it: in a checkout the simulator under
test/rig, which shares no code with the package, otherwise the package's own plant. The truth is read at the end.
"""

import argparse
import math
import random
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.console import Console, program
from pneumo_ros.command.demo.axis import drive, motion
from pneumo_ros.command.demo.bag_summary import hardship, traffic
from pneumo_ros.command.demo.hidden_machine import second_simulator
from pneumo_ros.command.demo.machine import find_effect
from pneumo_ros.command.verb.compare import equations_text, run_text
from pneumo_ros.environment import require_ros
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_new_folder

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison
    from pneumo_ros.reading.read import Reading

SECONDS = 16.0  # that the axis runs
SEEDS = 10_000  # to draw from where none is given
OWN_ERROR = """This plant is the model. Any error beyond the noise comes from timing: a command acts when it
reaches the simulator and is stamped when it reaches the recorder, a fraction of a millisecond apart. Near sticking,
this matters."""

EXAMPLES = (
    "pneumo demo                 # another machine each time",
    "pneumo demo --seed 7        # the same one again",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """--seed, --rig, --recording, --seconds, --out and the common options."""
    draw = "chooses the machine and its hidden effect (default: another one each time)"
    rig = "simulator to record the machine with (default: test/rig of a checkout); none: this package's plant"
    other = "also compare the default machine with this recording of another plant"
    length = f"how long the axis runs (default: {SECONDS:g})"
    parser.add_argument("--seed", type=int, metavar="N", help=draw)
    parser.add_argument("--rig", metavar="FOLDER", help=rig)
    parser.add_argument("--recording", metavar="BAG", help=other)
    parser.add_argument("--seconds", type=float, default=SECONDS, metavar="S", help=length)
    parser.add_argument(
        "--out", metavar="DIR", help="new folder for all that is written (default: demo_output/1, 2, ...)"
    )
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Run the nodes, record and diagnose the machine, reveal what it hid; 1 when a node ended badly."""
    require_ros()
    if not (math.isfinite(options.seconds) and options.seconds >= 4.0):
        raise UsageError(f"--seconds is {options.seconds:g}; give at least 4 s")
    seed, rig = _seed(options.seed), _rig(options.rig)
    other = _read(options.recording) if options.recording else None
    folder = check_new_folder(options.out) if options.out else _next_folder(Path("demo_output"))
    folder.mkdir(parents=True)
    result: dict[str, Any] = {"schema_version": 1, "seed": seed, "rig": rig, **_axis(folder, options.seconds, console)}
    if other:
        console.say("\nThe model against a recording of another plant\n")
        result["other"] = _compare(other, console).as_dict()
    result |= find_effect(folder, seed, rig, console)
    console.say(f"\nAll of it is in {folder}. Next:\n  {program()} effects\n  {program()} --help")
    console.json(result)
    return int(any(result["exit_codes"].values()))


def _seed(given: int | None) -> int:
    if given is not None and given < 0:
        raise UsageError(f"--seed is {given}; it takes a whole number from 0, such as --seed {-given}")
    return random.SystemRandom().randrange(SEEDS) if given is None else given


def _rig(given: str | None) -> Path | None:
    if given is None:
        return second_simulator()
    if given != "none" and not (Path(given) / "__main__.py").is_file():
        raise UsageError(f"--rig is {given}, which holds no simulator; give the folder test/rig of a checkout, or none")
    return None if given == "none" else Path(given)


def _axis(folder: Path, seconds: float, console: Console) -> dict[str, Any]:
    """The axis on ROS 2, its motion, and the model compared with it."""
    bag = folder / "bag"
    console.say("1. An axis runs: simulator, controller and recorder, three processes on ROS 2\n")
    codes = drive(bag, folder / "logs", seconds, console)
    console.say(traffic(bag))
    console.say(f"\nExit codes: {', '.join(f'{name} {code}' for name, code in codes.items())}")
    if busy := hardship(bag):
        console.say(f"\n{busy}")
    reading = _read(bag)
    console.say("\n2. It moves: piston position (*) and reference (-)\n")
    console.say(motion(reading.recording, seconds))
    console.say("\n3. The model against the recording just made\n")
    own = _compare(reading, console)
    console.say(f"\n{OWN_ERROR}")
    return {"bag": bag, "exit_codes": codes, "own": own.as_dict()}


def _read(path: "Path | str") -> "Reading":
    from pneumo_ros.plant import load_model
    from pneumo_ros.reading.read import read_run

    return read_run(path, load_model())


def _compare(reading: "Reading", console: Console) -> "Comparison":
    """The default machine against a recording, printed."""
    from pneumo_ros.compare.compare import compare
    from pneumo_ros.plant import load_model

    for note in reading.notes:
        console.note(f"{reading.recording.name}: {note}")
    with console.progress("Comparing") as progress:
        comparison = compare(load_model(), [reading.run], progress=lambda share, _: progress(share))
    console.say(run_text(comparison.runs[0], comparison.horizon))
    console.say()
    console.say(equations_text(comparison))
    return comparison


def _next_folder(parent: Path) -> Path:
    """The first of parent/1, parent/2, ... that does not exist."""
    return next(path for path in (parent / str(number) for number in count(1)) if not path.exists())
