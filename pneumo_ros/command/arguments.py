"""Command line arguments: errors in the words of this package, and the options most verbs share."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.units import write_in

if TYPE_CHECKING:
    from pneumo_ros.multiaxis import Machine
    from pneumo_ros.plant import Model


class Parser(argparse.ArgumentParser):
    """argparse that raises UsageError, accepts no abbreviated options and names the nearest for a misspelt one."""

    def __init__(self, prog: str, description: str | None, epilog: str | None = None) -> None:
        super().__init__(
            prog=prog,
            description=description,
            epilog=epilog,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )

    def error(self, message: str) -> NoReturn:
        """Raise UsageError instead of leaving the program."""
        raise UsageError(f"{message} (see: {self.prog} --help)")

    def parse_strictly(self, arguments: Sequence[str]) -> argparse.Namespace:
        """Parse, and refuse unknown arguments."""
        options, extra = self.parse_known_args(arguments)
        if extra:
            self.error(self._unknown(extra[0]))
        return options

    def _unknown(self, given: str) -> str:
        if given.startswith("--"):
            return unknown_name(
                "option", given.partition("=")[0], [n for n in self._option_string_actions if n[:2] == "--"]
            )
        return f"unexpected argument '{given}'"


def add_rig(parser: argparse.ArgumentParser) -> None:
    """--namespace, --joint, --read-as and --rig: which axis, and how it is wired."""
    parser.add_argument("--namespace", metavar="NS", help="of the axis, where a recording holds several")
    parser.add_argument("--joint", metavar="NAME", help="the piston in joint_states, where these hold several joints")
    add_wiring(parser)


def add_wiring(parser: argparse.ArgumentParser) -> None:
    """--read-as and --rig: how the rig is wired."""
    parser.add_argument(
        "--read-as",
        metavar="WORD,WORD",
        default="",
        help="read recordings that are not in SI units and absolute pressures, or wired otherwise: bar, kPa, hPa, MPa, "
        "psi; gauge, gauge-supply; mm, cm, in, or deg, mrad, rev; kN, lbf; swapped-chambers, reversed-position, "
        "reversed-voltage, reversed-force; zero=125mm: position at mid stroke; closed=5V: the command that closes the "
        "valve; without a signal: no-pressure-a, no-pressure-b, no-supply, no-effort, no-load-cell, no-command",
    )
    parser.add_argument(
        "--rig",
        dest="rig_file",
        metavar="RIG.yaml",
        help="machine and wiring of the rig, as `pneumo rig check` writes them",
    )


def add_closed(parser: argparse.ArgumentParser) -> None:
    """--closed: which signal closes the valve."""
    parser.add_argument(
        "--closed", metavar="VOLT", help="the signal that closes the valve, by its data sheet, such as 0V or 5V"
    )


def add_recordings(parser: argparse.ArgumentParser, *, cut: bool = True) -> None:
    """As `add_rig`, and --imposed; if `cut`, also --cut: what to leave out."""
    add_rig(parser)
    parser.add_argument(
        "--imposed",
        action="store_true",
        help="a test machine imposed the motion: the force is predicted, not the position",
    )
    if cut:
        parser.add_argument(
            "--cut", metavar="BAG:FROM-TO", action="append", default=[],
            help="leave these seconds of a recording out, such as run_3:2.5-4; may be repeated",
        )  # fmt: skip


def add_model(parser: argparse.ArgumentParser) -> None:
    """--model and --effects."""
    parser.add_argument(
        "--model", metavar="FILE", default="axis",
        help="machine file, or the name of a shipped one; two.yaml:shoulder is one axis of several",
    )  # fmt: skip
    add_effects(parser)


def add_effects(parser: argparse.ArgumentParser) -> None:
    """--effects."""
    parser.add_argument(
        "--effects",
        metavar="FILE.py",
        action="append",
        default=[],
        help="file with effects of your own; may be repeated",
    )


def add_output(parser: argparse.ArgumentParser) -> None:
    """--json and --quiet."""
    parser.add_argument("--json", metavar="FILE", help="write the results as JSON too; - for stdout, instead of text")
    parser.add_argument("--quiet", action="store_true", help="no messages and no progress")


def add_executor(parser: argparse.ArgumentParser) -> None:
    """--executor."""
    from pneumo_ros.sweep.executors import FORMS

    parser.add_argument("--executor", metavar="NAME", default="processes", help=f"{FORMS} (default: processes)")


def model_for_workers(options: argparse.Namespace) -> tuple[str, tuple[str, ...]]:
    """--model and --effects for a process in another folder: absolute path or shipped name, and absolute paths."""
    own = Path(options.model)
    model = str(own.resolve()) if own.is_file() else str(options.model)
    return model, tuple(str(Path(path).resolve()) for path in options.effects)


def chosen_machine(options: argparse.Namespace) -> "Machine | None":
    """The machine of several axes that --model asks for; None where it has one axis, or one of them is named."""
    place = Path(options.model)
    if not place.is_file() or "axes" not in place.read_text(encoding="utf-8", errors="ignore"):
        return None  # most machines: their file is read once, by `chosen_model`
    from pneumo_ros.multiaxis.machine_file import holds_axes, load_machine

    return load_machine(place, tuple(options.effects)) if holds_axes(place) else None


def chosen_model(options: argparse.Namespace) -> "Model":
    """The model that --model and --effects ask for; texts are written in its units from here on."""
    from pneumo_ros.plant import load_model

    model = load_model(options.model, effects_files=tuple(options.effects))
    write_in(model.coordinate)
    return model
