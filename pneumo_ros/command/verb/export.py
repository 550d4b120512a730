"""Write a machine for other programs: a functional mock-up unit (FMI), C99 for a controller, Modelica, or MJCF."""

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_effects, add_output
from pneumo_ros.command.console import Console
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from pneumo_ros.plant import Model

ENDINGS = {"fmu": ".fmu", "c": ".c", "mjcf": ".xml", "modelica": ".mo"}
FMI = ("3", "2")

EXAMPLES = (
    "pneumo export fmu my.yaml --out axis.fmu",
    "pneumo export c my.yaml --out axis.c",
    "pneumo export modelica my.yaml --out axis.mo",
    "pneumo export mjcf my.yaml --out axis.xml",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """FORMAT, MODEL, --out, --fmi and the common options."""
    formats = "fmu: for other simulators; c: one C99 file and its header; modelica: a package of its equations; "
    formats += "mjcf: the mechanism for MuJoCo"
    parser.add_argument("format", metavar="fmu|c|modelica|mjcf", help=formats)
    parser.add_argument("machine", metavar="MODEL", help="machine file, or the name of a shipped one")
    parser.add_argument("--out", required=True, metavar="FILE", help="file to write, such as axis.fmu or axis.c")
    parser.add_argument("--fmi", metavar="VERSION", help="of the standard, for fmu: 3 (default) or 2")
    add_effects(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Write the machine in the format asked for."""
    from pneumo_ros.plant import load_model

    target = _target(options)
    model = load_model(options.machine, effects_files=tuple(options.effects))
    version = int(options.fmi or FMI[0])
    if options.format == "fmu":
        console.note(f"Compiling {model.name} for FMI {version}.0")
    files = _written(options, model, target, version)
    console.say(f"{model.name} written to {' and '.join(map(str, files))}")
    told = {"schema_version": 1, "model": model.name, "format": options.format, "files": [str(f) for f in files]}
    machine = "" if options.machine == "axis" else f" --model {shlex.quote(options.machine)}"
    console.next(f"simulate{machine} --input step:2@1 --out reference   # the same machine here, to compare with")
    console.json({**told, "fmi": version} if options.format == "fmu" else told)
    return 0


def _written(options: argparse.Namespace, model: "Model", target: Path, version: int) -> list[Path]:
    """Write the files; their paths."""
    if options.format == "c":
        return _write_c(model, target)
    if options.format == "fmu":
        return _write_fmu(model, target, version)
    if options.format == "modelica":
        return _write_modelica(model, target)
    from pneumo_ros.export.mjcf import mjcf_text

    write_whole(target, mjcf_text(model, options.machine))
    return [target]


def _target(options: argparse.Namespace) -> Path:
    """--out, once format, its version and the ending are known to fit."""
    if options.format not in ENDINGS:
        raise UsageError(f"{unknown_name('format', options.format, ENDINGS)} (see: pneumo export --help)")
    if options.fmi is not None and options.format != "fmu":
        raise UsageError(f"--fmi goes with fmu: pneumo export fmu {options.machine} --out FILE.fmu --fmi {FMI[0]}")
    if options.fmi not in (None, *FMI):
        raise UsageError(f"--fmi is {options.fmi}; it takes {' or '.join(FMI)}")
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


def _write_modelica(model: "Model", target: Path) -> list[Path]:
    from pneumo_ros.export import Exported, modelica_text

    write_whole(target, modelica_text(Exported(model)))
    return [target]


def _write_fmu(model: "Model", target: Path, version: int) -> list[Path]:
    from pneumo_ros.export import Exported, fmu_archive

    write_whole(target, fmu_archive(Exported(model), version))
    return [target]
