"""Recordings named on the command line: folders of them expanded, read as the options say, problems reported."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.console import Console

if TYPE_CHECKING:
    from pneumo_ros.command.together import Together
    from pneumo_ros.plant import Model
    from pneumo_ros.reading.read import Reading, ReadOptions
    from pneumo_ros.runs.cuts import Cut
    from pneumo_ros.runs.run import Run


def expanded(named: Sequence[str], console: Console) -> dict[str, bool]:
    """The recordings named, in order, and whether each came out of a folder of recordings.

    A recording named twice is taken once.
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


def unfolded(named: Sequence[str]) -> list[str]:
    """The recordings named, in order, those of folders by name; one that is named twice stays twice."""
    from pneumo_ros.records.folders import recordings_in

    return [str(path) for name in named for path in recordings_in(Path(name)) or [Path(name)]]


def read_options(options: argparse.Namespace) -> "ReadOptions":
    """--namespace, --joint, --read-as and --imposed; UsageError for unknown words."""
    from pneumo_ros.reading.read import ReadOptions
    from pneumo_ros.records.corrections import parse_words

    mechanics = getattr(options, "mechanics", False)  # a default of the verbs that can judge them alone
    imposed = getattr(options, "imposed", False)  # not every verb has it
    rig = getattr(options, "rig_said", None)
    topics = tuple(rig.topics.items()) if rig else ()
    return ReadOptions(options.namespace, options.joint, parse_words(options.read_as), mechanics, imposed, topics)


def _cuts(options: argparse.Namespace) -> "dict[Path, tuple[Cut, ...]]":
    from pneumo_ros.runs.cuts import parse_cuts

    return parse_cuts(getattr(options, "cut", ()))  # not every verb has the option


def read_one(path: str, options: argparse.Namespace, console: Console, model: "Model") -> "Reading":
    """One recording as a run for `model`, read as `options` (of `add_recordings`) say; its notes are printed.

    Raises DataError when it cannot be used.
    """
    from pneumo_ros.reading.read import read_run

    reading = read_run(path, model, read_options(options), _cuts(options).get(Path(path).resolve(), ()))
    for note in reading.notes:
        console.note(f"{reading.recording.name}: {note}")
    return _on_shared_supply({path: reading}, options, console)[path]


def _on_shared_supply(
    usable: "Mapping[str, Reading]", options: argparse.Namespace, console: Console
) -> "Mapping[str, Reading]":
    """The readings of one axis of several, with the pressure of the supply that they share where it is computed."""
    together: Together | None = getattr(options, "together", None)
    if together is None:
        return usable
    found = together.supplied(usable)
    for path, reading in found.items():
        gone = int((usable[path].run.measured & ~reading.run.measured).sum()) * reading.run.sample_time
        if gone:
            console.note(
                f"{reading.recording.name}: it begins in motion; what the axes drew before is not known, nor is the "
                f"supply's pressure: {gone:.2g} s at the start are left out"
            )
    return found


def measuring(model: "Model", runs: "Sequence[Run]", console: Console) -> "Model":
    """The model as `inputs.measuring` says, for what the runs hold; notes say what is different."""
    from pneumo_ros.runs import inputs

    found = inputs.measuring(model, runs)
    by_force = any(run.force_driven and not run.by_pressures for run in runs)
    if found.force_driven != model.force_driven:
        console.note(
            "No recording has a valve command: friction and load are judged, driven by the measured "
            f"{'force' if by_force else 'pressures'}; record valve/command to judge valve and chambers as well"
        )
    elif found.imposed == model.imposed and found.inputs != model.inputs:
        console.note(inputs.in_place(model, found, runs))
    console.note(inputs.judged(found, runs))
    return found


def say_rates(runs: "Sequence[Run]", console: Console) -> None:
    """One line where runs of different rates are fitted together."""
    from pneumo_ros.runs.clock import lowered

    if said := lowered(runs):
        console.note(said)


def read_named(bags: Sequence[str], options: argparse.Namespace, console: Console, model: "Model") -> "list[Run]":
    """The recordings named, each of which must be usable, as runs for `model`; otherwise as `read_one`."""
    return [read_one(bag, options, console, model).run for bag in bags]


def read_expanded(
    paths: dict[str, bool], options: argparse.Namespace, console: Console, model: "Model"
) -> "tuple[list[Run], dict[str, str]]":
    """The runs, and a sentence for each recording of a folder that is passed over because it cannot be used.

    A recording that was named itself must be usable: DataError says why it is not.
    """
    from pneumo_ros.reading.read import read_runs

    with console.progress("Reading") as progress:
        found = read_runs(
            list(paths), model, read_options(options), _cuts(options),
            required=[path for path, from_folder in paths.items() if not from_folder],
            progress=progress, note=console.note, refuse=lambda path, why: console.note(f"Passed over: {why}"),
        )  # fmt: skip
    runs = [reading.run for reading in _on_shared_supply(found.usable, options, console).values()]
    return runs, dict(found.refused)
