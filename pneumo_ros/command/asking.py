"""Questions in the terminal for `pneumo new`, one after the other; a wrong answer is explained and asked again."""

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable

if TYPE_CHECKING:
    from pneumo_ros.parts.shelf import Shelf

TRIES = 5  # wrong answers to one question before the verb gives up


def asked(options: argparse.Namespace, shelf: "Shelf") -> None:
    """Fill `options` with the answers; UsageError after too many wrong ones, or at the end of the input."""
    from pneumo_ros.parts import wishes
    from pneumo_ros.parts.order import ATMOSPHERE
    from pneumo_ros.parts.quantity import parse, pressure

    def length(what: str) -> Callable[[str], object]:
        return lambda text: parse(text, "length", what, plain="mm", example="250")

    print("A machine file from data sheets. Enter takes the answer in brackets; Ctrl-C ends.")
    options.cylinder = ask("Cylinder, such as iso15552-32-250 (empty: give its sizes)", shelf.cylinder, "")
    stroke = options.cylinder is None or shelf.cylinder(options.cylinder)[1] is None
    for name in ("bore", "rod") if options.cylinder is None else ():
        setattr(options, name, ask(f"{name.capitalize()} in mm", length(f"the {name}")))
    if stroke:
        options.stroke = ask("Stroke in mm", length("the stroke"))
    options.valve = ask(
        "Valve, such as smc-sy7000 (empty: give its flow)", lambda text: shelf.find(text, "valve", "regulator"), ""
    )
    if options.valve is None or not _flows(shelf, options.valve):
        options.valve_flow = ask(f"Flow of the valve: {wishes.FLOW_FORMS}", wishes.flow)
    if options.valve is None:
        options.signal = ask("Signal in volts, LOW,CLOSED,HIGH", wishes.signal, "-10,0,10")
    options.supply = ask("Supply pressure", lambda text: pressure(text, "the supply", ATMOSPHERE), "6barg")
    options.mass = ask("Mass that moves, in kg", lambda text: parse(text, "mass", "the mass", plain="kg"))
    options.mounting = ask("Mounting: horizontal, vertical, vertical-down or an angle", wishes.tilt, "horizontal")
    options.sensors = ask("Pressure sensors, such as gauge-bar", wishes.read_as, "absolute-Pa")
    if options.out is None:
        options.out = ask("Machine file to write", _new_file, "my_machine.yaml")


def ask(question: str, check: Callable[[str], object], default: str | None = None) -> str | None:
    """The answer that `check` accepts; `default` on Enter, None where that is empty."""
    shown = f" [{default}]" if default else ""
    for _ in range(TRIES):
        try:
            answer = input(f"{question}{shown}: ").strip() or default
        except EOFError as error:
            raise UsageError(f"no answer to: {question}; give it as an option (see: pneumo new --help)") from error
        if answer == "":
            return None
        try:
            if answer is None:
                raise UsageError("this needs an answer")
            check(answer)
        except UsageError as error:
            print(f"  {error}")
        else:
            return answer
    raise UsageError(f"{TRIES} answers to '{question}' were none of its kind; see: pneumo new --help, pneumo parts")


def _flows(shelf: "Shelf", valve: str) -> bool:
    from pneumo_ros.parts.order import FLOWS

    return any(name in shelf.find(valve).figures for name in FLOWS)


def _new_file(path: str) -> None:
    if check_writable(path).exists():
        raise UsageError(f"{path} exists; name another file")
