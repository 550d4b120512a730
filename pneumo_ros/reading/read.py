"""Recordings as runs: read, corrected, laid on a grid, cut, and checked against the model."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical
from pneumo_ros.reading.plausible import check_run
from pneumo_ros.records import Recording, read_recording
from pneumo_ros.records.corrections import corrected
from pneumo_ros.records.unfit import check_pressures, check_supply
from pneumo_ros.runs.cuts import Cut, without
from pneumo_ros.runs.inputs import check_inputs
from pneumo_ros.runs.run import Run, make_run

ATMOSPHERE = 101325.0  # Pa, for machine files without it


@dataclass(frozen=True)
class ReadOptions:
    """How recordings are read: the axis and the joint where a recording holds several, and the words of --read-as."""

    namespace: str | None = None
    joint: str | None = None
    words: tuple[str, ...] = ()  # of `records.corrections.WORDS`
    mechanics: bool = False  # whether pressures without a valve command suffice, to judge the mechanics alone


@dataclass(frozen=True)
class Reading:
    """One recording, its run, and sentences on faults that leave them usable."""

    recording: Recording
    run: Run
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Readings:
    """Several recordings: usable ones by path, in the order given, and by path why others are not."""

    usable: Mapping[str, Reading]
    refused: Mapping[str, str] = field(default_factory=dict)

    @property
    def runs(self) -> list[Run]:
        """The runs of the usable recordings."""
        return [reading.run for reading in self.usable.values()]


def corrected_recording(path: str | Path, options: ReadOptions, atmosphere: float = ATMOSPHERE) -> Recording:
    """The recording at `path` in SI units and with absolute pressures, as `options` say.

    `atmosphere` [Pa] is added to gauge pressures. Raises DataError when it cannot be read.
    """
    return corrected(read_recording(path, options.namespace, options.joint), options.words, atmosphere)


def checked_run(recording: Recording, model: Model, cuts: Sequence[Cut] = ()) -> tuple[Run, list[str]]:
    """`recording` on a uniform grid without `cuts`, and sentences on its idle parts.

    Raises DataError when it lacks a signal that `model` needs, or is not plausible (see `check_run`).
    """
    areas = (model["piston.area_a"], model["piston.area_b"])
    whole = make_run(recording, model.force_driven, model.imposed, areas)
    run, notes = _trusted(recording, model, without(whole, cuts))
    check_inputs(model, run)
    return run, [f"{note}." for note in (*notes, *check_run(model, run))]


def _trusted(recording: Recording, model: Model, run: Run) -> tuple[Run, list[str]]:
    """The run without measured inputs that are not plausible, and a note on each; DataError if `model` reads them."""
    chambers, notes = ("p_a", "p_b") if model.force_driven else (), list[str]()
    needed = {*model.inputs, *(chambers if recording.pressures_drive else ())}
    for names, check, what in (
        (chambers, _check_oil, "its pressures are not used, and no effect of them is tried"),
        (("measured_supply",), check_supply, "its supply pressure is not used"),
    ):
        try:
            if set(names) & set(run.further):
                check(recording)
        except DataError as problem:
            if needed & set(names):
                raise
            run = replace(run, further={name: held for name, held in run.further.items() if name not in names})
            notes.append(f"{what}: {problem}")
    return run, notes


def _check_oil(recording: Recording) -> None:
    check_pressures(recording, oil=True)


def read_run(path: str | Path, model: Model, options: ReadOptions | None = None, cuts: Sequence[Cut] = ()) -> Reading:
    """The recording at `path` as a run for `model`; `cuts` [s] are left out.

    Raises DataError when it cannot be read, lacks a signal that `model` needs, or is not plausible.
    """
    how = options or ReadOptions()
    recording = corrected_recording(path, how, model.parameters.get("air.atmospheric_pressure", ATMOSPHERE))
    run, notes = run_of(recording, model, cuts, mechanics=how.mechanics)
    return Reading(recording, run, (*recording.warnings, *notes))


def run_of(
    recording: Recording, model: Model, cuts: Sequence[Cut] = (), *, mechanics: bool = False
) -> tuple[Run, list[str]]:
    """As `checked_run`; with `mechanics`, those of `model` alone where the recording has no valve command."""
    commanded = recording.voltage is not None or not recording.pressures_drive
    alone = mechanics and not (commanded or model.force_driven or model.imposed)
    return checked_run(recording, (mechanical(model) or model) if alone else model, cuts)


def read_runs(
    paths: Sequence[str],
    model: Model,
    options: ReadOptions | None = None,
    cuts: Mapping[Path, Sequence[Cut]] | None = None,
    *,
    required: Collection[str] = (),
    progress: Callable[[float], object] = lambda share: None,
    note: Callable[[str], object] = lambda text: None,
    refuse: Callable[[str, str], object] = lambda path, reason: None,
) -> Readings:
    """The recordings at `paths` as runs for `model`; runs with equal names are named by their paths.

    `cuts` [s] by resolved path are left out. A recording that cannot be used is refused, but when it is among those
    `required`, its error is raised. While reading, `progress` gets the share done, `note` each sentence on a usable
    recording, and `refuse` path and reason of one that cannot be used. Raises DataError when none can be used.
    """
    usable, refused = dict[str, Reading](), dict[str, str]()
    for done, path in enumerate(paths):
        progress(done / len(paths))
        try:
            reading = read_run(path, model, options, (cuts or {}).get(Path(path).resolve(), ()))
        except PneumoError as problem:
            if path in required:
                raise
            refused[path] = str(problem)
            refuse(path, str(problem))
            continue
        usable[path] = reading
        for sentence in reading.notes:
            note(f"{reading.recording.name}: {sentence}")
    if not usable:
        raise DataError(f"none of {len(paths)} recordings can be used; the last: {list(refused.values())[-1]}")
    return Readings(_named_apart(usable), refused)


def _named_apart(usable: dict[str, Reading]) -> dict[str, Reading]:
    names = [reading.run.name for reading in usable.values()]
    return {
        path: replace(reading, run=replace(reading.run, name=path)) if names.count(reading.run.name) > 1 else reading
        for path, reading in usable.items()
    }
