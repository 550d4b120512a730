"""Command lines of the nodes: arguments outside ROS, and --help with the parameters."""

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rclpy.utilities import remove_ros_args

from pneumo_ros.axis.setting import Setting


@dataclass(frozen=True)
class Arguments:
    """Effect files named with --effects, and all arguments for rclpy."""

    effects: tuple[str, ...]
    ros: tuple[str, ...]


def parse(
    name: str, summary: str, settings: Iterable[Setting], args: Sequence[str] | None = None, *, effects: bool = False
) -> Arguments:
    """Arguments of the process, or `args` without the program's name.

    Ends the process with 0 after --help, which lists `settings`, and with 2 for an unknown argument, as argparse does.
    """
    given = list(sys.argv[1:] if args is None else args)
    lines = "\n".join(_line(setting) for setting in settings)
    parser = argparse.ArgumentParser(
        prog=name,
        description=summary,
        epilog=f"parameters (--ros-args -p name:=value, or --ros-args --params-file FILE):\n{lines}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    if effects:
        parser.add_argument(
            "--effects", action="append", default=[], metavar="FILE.py",
            help="file with effects of your own; it is executed, so name only files you trust",
        )  # fmt: skip
    try:
        own = remove_ros_args([name, *given])[1:]
    except RuntimeError as error:  # RCLInvalidROSArgsError is no class of rclpy's public modules
        parser.error(f"ROS arguments are refused: {error}")
    parsed = parser.parse_args(own)
    return Arguments(tuple(getattr(parsed, "effects", ())), tuple(given))


def _line(setting: Setting) -> str:
    unit = f" [{setting.unit}]" if setting.unit else ""
    fixed = "" if setting.live else "; fixed at the start"
    return f"  {setting.name:24} {setting.meaning}{unit} (default {_text(setting.default)}{fixed})"


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value) or "none"
