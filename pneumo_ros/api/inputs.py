"""Recordings as people give them in Python - paths, folders, recordings - and as runs for a model."""

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from pathlib import Path

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.read import ReadOptions, corrected_recording, run_of
from pneumo_ros.records import Recording
from pneumo_ros.records.folders import recordings_in
from pneumo_ros.runs.run import Run
from pneumo_ros.units import write_in

Machine = str | Path | Model
One = str | Path | Recording
Given = One | Iterable[One]
Progress = Callable[[float, str], None]
"""Called with the share done, 0 to 1, and what is being done."""


@dataclass(frozen=True)
class Runs:
    """Runs for a model, with the paths they come from and sentences on what was found in them."""

    runs: tuple[Run, ...]
    paths: tuple[Path, ...]
    notes: tuple[str, ...]


def machine(given: Machine) -> Model:
    """The model itself, or that of a machine file or of the name of a shipped one; errors as `load_model`.

    Texts of the verb that asks for it are written in its units.
    """
    model = given if isinstance(given, Model) else load_model(given)
    write_in(model.coordinate)
    return model


def recordings(given: Given, without: Collection[Path] = ()) -> tuple[Recording, ...]:
    """The recordings given, those of a folder by name but for `without`; UsageError for none, DataError as `read`."""
    each = list(given) if isinstance(given, Iterable) and not isinstance(given, (str, Recording)) else [given]
    found = list[Recording]()
    for one in each:
        if isinstance(one, Recording):
            found.append(one)
            continue
        if not isinstance(one, (str, Path)):
            raise UsageError(f"a recording is given by its path, or as pn.read gives it; this is {brief(one)}")
        inside = [path for path in recordings_in(Path(one)) if path.resolve() not in without]
        found += [corrected_recording(path, ReadOptions()) for path in inside or [Path(one)]]
    if not found:
        raise UsageError("no recording is given; give paths of recordings, or what pn.read returns")
    return tuple(found)


def runs_of(given: Given, model: Model, *, mechanics: bool = True, without: Collection[Path] = ()) -> Runs:
    """The recordings as runs for `model`; `mechanics` alone are judged where no valve command is there.

    Recordings of a folder whose resolved path is in `without` are left out. Raises UsageError for two of one name, and
    for none; DataError for a recording that cannot be used.
    """
    runs, paths, notes, names = list[Run](), list[Path](), list[str](), set[str]()
    for recording in recordings(given, without):
        run, found = run_of(recording, model, mechanics=mechanics)
        if run.name in names:
            raise UsageError(f"two recordings have the name {run.name}; give each once, and each its own name")
        names.add(run.name)
        runs.append(run)
        paths.append(recording.path)
        notes += [f"{recording.name}: {sentence}" for sentence in (*recording.warnings, *found)]
    return Runs(tuple(runs), tuple(paths), tuple(notes))
