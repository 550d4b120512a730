"""Make a machine file from data sheets: cylinder, valve, supply, mass, mounting; without options, it asks.

Every value has its source beside it, and a standard deviation as wide as the source is (section uncertainty), which
fits take as its prior. Where nothing is published a rule stands in, and says so. `pneumo parts` lists the parts.
"""

import argparse
import shlex
import sys
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.asking import asked
from pneumo_ros.command.console import Console
from pneumo_ros.command.machine_out import add_machine_file, check_machine_file
from pneumo_ros.command.making_text import file_text, record, said
from pneumo_ros.command.verb.parts import add_parts
from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.parts.design import Design

NEEDED = {"supply": "6barg", "mass": "10kg"}
WISHES = (
    "cylinder", "bore", "rod", "stroke", "valve", "valve_flow", "signal", "supply", "mass", "mounting", "sensors",
)  # fmt: skip

EXAMPLES = (
    "pneumo new                  # question by question",
    "pneumo new --cylinder iso15552-32-250 --valve smc-sy7000 --supply 6barg --mass 10 --out my.yaml",
    "pneumo new --bore 25 --rod 10 --stroke 200 --valve-flow 'qn 700 l/min' --supply 6barg --mass 2 --out my.yaml",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The cylinder, the valve, their use, --out, and the common options."""
    parser.add_argument("--cylinder", metavar="PART", help="a cylinder of `pneumo parts` with its stroke in mm")
    for name in ("bore", "rod", "stroke"):
        parser.add_argument(f"--{name}", metavar="LENGTH", help=f"{name} of the cylinder, in mm unless a unit is given")
    parser.add_argument("--valve", metavar="PART", help="a valve of `pneumo parts`")
    parser.add_argument(
        "--valve-flow", metavar="FLOW", help="of its data sheet: 'qn 700 l/min', 'C 2.8, b 0.3', 'Kv 0.4'"
    )
    parser.add_argument(
        "--signal",
        metavar="LOW,CLOSED,HIGH",
        help="of a proportional valve, in volts, or mA over 500 ohm: 0,5,10 or 4,12,20mA",
    )
    parser.add_argument(
        "--supply", metavar="PRESSURE", help="6barg, 0.6 MPa, 87 psi (gauge); 7bara, 101psia (absolute)"
    )
    parser.add_argument(
        "--mass", metavar="MASS", help="all that moves: piston, rod and load; kg unless a unit is given"
    )
    parser.add_argument(
        "--mounting", metavar="WAY", default="horizontal",
        help="horizontal (default), vertical (the rod lifts the load), vertical-down, or an angle such as 30deg",
    )  # fmt: skip
    parser.add_argument(
        "--sensors", metavar="KIND", default="absolute-Pa",
        help="of pressure: gauge or absolute, and the unit, such as gauge-bar (default: absolute-Pa)",
    )  # fmt: skip
    parser.add_argument("--predict", action="store_true", help="print how long a stroke takes, with its 95 %% band")
    add_machine_file(parser, "the machine file to write")
    add_parts(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Ask for what is missing if a person is there, make the machine, write it, say what it is."""
    from pneumo_ros.files import write_whole
    from pneumo_ros.parts.design import Wishes, design
    from pneumo_ros.parts.shelf import load_shelf

    shelf = load_shelf(options.parts)
    if not any(getattr(options, name) for name in WISHES[:-2]) and sys.stdin.isatty():
        asked(options, shelf)
    _complete(options)
    check_machine_file(options)
    made = design(Wishes(**{name: getattr(options, name) for name in WISHES}), shelf)
    result = record(made, options.out)
    if options.predict:
        result["stroke_s"] = _predicted(made)
    write_whole(options.out, file_text(made, _call(options)))
    console.say(said(made, result))
    for caution in made.cautions:
        console.note(f"Caution: {caution}")
    console.say(f"Machine file written to {options.out}")
    console.next(f"simulate --model {shlex.quote(options.out)} --input constant:{made.signal[0]:g} --out first_run")
    console.json(result)
    return 0


def _complete(options: argparse.Namespace) -> None:
    """UsageError, with what to type, where something is missing that no rule can replace."""
    missing = [f"--{name} {example}" for name, example in NEEDED.items() if getattr(options, name) is None]
    if not (options.valve or options.valve_flow):
        missing.insert(0, "--valve smc-sy7000 (see: pneumo parts) or --valve-flow 'qn 700 l/min'")
    if not (options.cylinder or options.bore):
        missing.insert(0, "--cylinder iso15552-32-250 (see: pneumo parts) or --bore 32 --rod 12 --stroke 250")
    if options.out is None:
        missing.append("--out my.yaml")
    if missing:
        raise UsageError("pneumo new lacks: " + ", ".join(missing))


def _call(options: argparse.Namespace) -> str:
    """The command line that makes this machine again."""
    given = [(f"--{n.replace('_', '-')}", getattr(options, n)) for n in WISHES if getattr(options, n)]
    return "pneumo new " + " ".join(f"{option} {shlex.quote(value)}" for option, value in given)


def _predicted(made: "Design") -> dict[str, Any]:
    """Stroke times [s] with their bands, out and back."""
    from pneumo_ros.parts.strokes import band

    each = {way: band(made, volts) for way, volts in zip(("out", "back"), made.signal, strict=True)}
    return {way: {"value": value, "low": low, "high": high} for way, (value, low, high) in each.items()}
