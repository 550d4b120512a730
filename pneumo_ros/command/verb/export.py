"""Write a machine as C99 for a controller."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_effects, add_output
from pneumo_ros.command.console import Console
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from pneumo_ros.plant import Model

ENDINGS = {"c": ".c"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """FORMAT, MODEL, --out and the common options."""
    parser.add_argument("format", metavar="c", help="c: one C99 file and its header")
    parser.add_argument("machine", metavar="MODEL", help="machine file, or the name of a shipped one")
    parser.add_argument("--out", required=True, metavar="FILE", help="file to write, such as axis.c")
    add_effects(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Write the machine in the format asked for."""
    from pneumo_ros.plant import load_model

    target = _target(options)
    model = load_model(options.machine, effects_files=tuple(options.effects))
    files = _write_c(model, target)
    console.say(f"{model.name} written to {' and '.join(map(str, files))}")
    console.json(
        {"schema_version": 1, "model": model.name, "format": options.format, "files": [str(path) for path in files]}
    )
    return 0


def _target(options: argparse.Namespace) -> Path:
    """--out, once format and ending are known to fit."""
    if options.format not in ENDINGS:
        raise UsageError(f"{unknown_name('format', options.format, ENDINGS)} (see: pneumo export --help)")
    target, ending = check_writable(options.out), ENDINGS[options.format]
    if target.suffix != ending:
        raise UsageError(f"--out is {options.out}; this file ends in {ending}: --out {target.with_suffix(ending)}")
    return target


def _write_c(model: "Model", target: Path) -> list[Path]:
    from pneumo_ros.export import Exported, c_files

    header = check_writable(target.with_suffix(".h"))
    declarations, source = c_files(Exported(model), header.name)
    write_whole(header, declarations)
    write_whole(target, source)
    return [target, header]
