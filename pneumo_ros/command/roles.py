"""Recordings in two roles: those that are fitted, and those held out, by which the fit is judged."""

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.console import Console
from pneumo_ros.command.recordings import expanded, read_expanded
from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.runs.run import Run

_KEPT = "hold"  # names of recordings to hold out begin with it


def add_holdout(parser: argparse.ArgumentParser, why: str) -> None:
    """--holdout."""
    parser.add_argument("--holdout", nargs="+", metavar="BAG", default=[], help=why)


def roles(options: argparse.Namespace, console: Console) -> tuple[dict[str, bool], dict[str, bool]]:
    """Recordings to fit and to judge by, as `expanded` gives them; also set as `bags` and `holdout` of `options`.

    A recording of a folder that is held out by name is not fitted. Raises UsageError for a recording in both
    roles, and when no recording is left to fit.
    """
    train, held = expanded(options.bags, console), expanded(options.holdout, console)
    twice = {Path(path).resolve(): path for path in held}
    for path, from_folder in list(train.items()):
        other = twice.get(Path(path).resolve())
        if other is not None and (not from_folder or held[other]):
            raise UsageError(f"{path} is to be fitted and held out; a recording judges only what it was not fitted to")
        if other is not None:
            console.note(f"{path} is held out, not fitted")
            del train[path]
    if not train:
        raise UsageError("every recording is held out; name others to fit")
    options.bags, options.holdout = list(train), list(held)
    return train, held


def require_holdout(options: argparse.Namespace, verb: str, console: Console) -> None:
    """UsageError, with what to type, when nothing is held out."""
    if options.holdout:
        return
    why = "--holdout is missing: a diagnosis is judged by recordings that it was not fitted to"
    paths = list(expanded(options.bags, Console(quiet=True)))
    kept = [path for path in paths if Path(path).name.startswith(_KEPT)]
    if kept and len(kept) < len(paths):
        named = [bag for bag in options.bags if bag not in kept]
        raise UsageError(f"{why}; type: {_line(verb, named, kept, options)}")
    if len(paths) > 1:
        named = paths[:-1] if len(options.bags) > 1 else options.bags
        raise UsageError(f"{why}; keep one back: {_line(verb, named, paths[-1:], options)}")
    raise UsageError(f"{why}; record one more run: pneumo diagnose {shlex.join(paths)} --holdout OTHER")


def _line(verb: str, bags: Sequence[str], kept: Sequence[str], options: argparse.Namespace) -> str:
    model = [] if options.model == "axis" else ["--model", options.model]
    effects = [word for path in options.effects for word in ("--effects", path)]
    return shlex.join(["pneumo", verb, *bags, "--holdout", *kept, *model, *effects])


def read_roles(
    train: dict[str, bool], held: dict[str, bool], options: argparse.Namespace, console: Console, model: "Model"
) -> "tuple[list[Run], list[Run], dict[str, str]]":
    """The runs to fit, those to judge by, and what was passed over, as `read_expanded`; UsageError for copies."""
    fitted, passed = read_expanded(train, options, console, model)
    judging, more = read_expanded(held, options, console, model) if held else ([], {})
    check_copies(fitted, judging)
    return fitted, judging, passed | more


def check_copies(fitted: "Sequence[Run]", judging: "Sequence[Run]") -> None:
    """UsageError for a recording that is fitted and, under another name, held out."""
    import numpy as np  # slow; --help does not need it

    for run in judging:
        for other in fitted:
            if np.array_equal(run.position, other.position):
                raise UsageError(f"{run.name}, held out, is a copy of {other.name}, which is fitted; name another one")
