"""Recordings named on the command line: folders of them expanded, what cannot be read said, names kept apart."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.console import Console
from pneumo_ros.errors import DataError

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.records import Recording
    from pneumo_ros.runs.run import Run

ATMOSPHERE = 101325.0  # Pa, for machines that do not say


def expanded(named: Sequence[str], console: Console) -> dict[str, bool]:
    """The recordings named, in order, and whether each came out of a folder of recordings.

    What is named twice is taken once. Raises DataError for a folder that holds none.
    """
    from pneumo_ros.records.folders import recordings_in

    found: dict[str, bool] = {}
    seen: set[Path] = set()
    for name in named:
        inside = recordings_in(Path(name))
        for path in inside or [Path(name)]:
            if path.resolve() in seen:
                console.note(f"{path} is named twice and taken once")
                continue
            seen.add(path.resolve())
            found[str(path)] = bool(inside)
    return found


def read_run(path: str, options: argparse.Namespace, console: Console, model: "Model") -> "tuple[Recording, Run]":
    """One recording as `options` say, and on a uniform grid; notes and errors as `read_runs`."""
    from pneumo_ros.reading.plausible import check_run
    from pneumo_ros.records import read_recording
    from pneumo_ros.records.corrections import corrected, parse_words
    from pneumo_ros.runs.cuts import parse_cuts, without
    from pneumo_ros.runs.run import make_run

    words = parse_words(options.read_as)
    recording = read_recording(path, options.namespace, options.joint)
    recording = corrected(recording, words, model.parameters.get("air.atmospheric_pressure", ATMOSPHERE))
    for warning in recording.warnings:
        console.note(f"{recording.name}: {warning}")
    cuts = parse_cuts(getattr(options, "cut", ()))  # not every verb has the option
    run = without(make_run(recording, model.force_driven), cuts.get(Path(path).resolve(), ()))
    for note in check_run(model, run):
        console.note(f"{recording.name}: {note}.")
    return recording, run


def read_runs(bags: Sequence[str], options: argparse.Namespace, console: Console, model: "Model") -> "list[Run]":
    """The recordings named, on uniform grids; what is wrong with them is noted, or DataError says why it is too much.

    `options` are those of `add_recordings`, by which recordings are read; `model` is what they should fit.
    """
    return [read_run(bag, options, console, model)[1] for bag in bags]


def read_expanded(
    paths: dict[str, bool], options: argparse.Namespace, console: Console, model: "Model"
) -> "tuple[list[Run], dict[str, str]]":
    """The runs, and a sentence for each recording of a folder that is passed over because it cannot be used.

    A recording that was named itself must be usable: DataError says why it is not.
    """
    runs, passed = [], {}
    with console.progress("Reading") as progress:
        for done, (path, from_folder) in enumerate(paths.items()):
            progress(done / len(paths))
            try:
                runs.append(read_run(path, options, console, model)[1])
            except DataError as problem:
                if not from_folder:
                    raise
                passed[path] = str(problem)
                console.note(f"Passed over: {problem}")
    if not runs:
        raise DataError(f"none of {len(paths)} recordings can be used; the last: {list(passed.values())[-1]}")
    return _told_apart(runs, [path for path in paths if path not in passed]), passed


def _told_apart(runs: "list[Run]", paths: Sequence[str]) -> "list[Run]":
    """Runs of the same name are called by their paths."""
    names = [run.name for run in runs]
    return [
        replace(run, name=path) if names.count(run.name) > 1 else run for run, path in zip(runs, paths, strict=True)
    ]
