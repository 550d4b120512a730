"""Recordings as runs: read, corrected, laid on a grid, cut, and checked against the model."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import SIDES
from pneumo_ros.plant.mechanical import mechanical, pneumatic
from pneumo_ros.reading.late import earlier, lateness
from pneumo_ros.reading.lengths import check_length
from pneumo_ros.reading.motion import velocity_note
from pneumo_ros.reading.plausible import check_run, supply_is_gauge
from pneumo_ros.reading.steady import constant, verdict
from pneumo_ros.records import Recording, read_recording
from pneumo_ros.records.corrections import corrected
from pneumo_ros.records.rates import thinned
from pneumo_ros.records.unfit import check_pressures, check_supply
from pneumo_ros.runs.cuts import Cut, without
from pneumo_ros.runs.inputs import check_inputs
from pneumo_ros.runs.run import ATMOSPHERE, Run, run_for

ZERO = 5e3  # Pa: a vented chamber reads less on a gauge
PRESSURES = tuple(f"p_{side}" for side in SIDES)  # measured, where a machine has no chambers

__all__ = ["ATMOSPHERE", "ReadOptions", "Reading", "Readings", "read_run", "read_runs"]


@dataclass(frozen=True)
class ReadOptions:
    """How recordings are read: the axis and the joint where a recording holds several, and the words of --read-as."""

    namespace: str | None = None
    joint: str | None = None
    words: tuple[str, ...] = ()  # of `records.corrections.WORDS`
    mechanics: bool = False  # whether the mechanics alone, or one chamber alone, may be judged
    imposed: bool = False  # whether a test machine imposed the motion, though no map says so
    topics: tuple[tuple[str, str], ...] = ()  # name in the contract, topic and field of another program


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
    topics = dict(options.topics)
    recording = read_recording(path, options.namespace, options.joint, options.imposed, topics)
    return corrected(recording, options.words, atmosphere)


def checked_run(recording: Recording, model: Model, cuts: Sequence[Cut] = ()) -> tuple[Run, list[str]]:
    """`recording` on a uniform grid without `cuts`, and sentences on its idle parts.

    Raises DataError when it lacks a signal that `model` needs, or is not plausible (see `check_run`).
    """
    recording, said = thinned(recording)
    try:
        whole = run_for(recording, model)
    except DataError as problem:
        raise (_vented_on_gauge(recording, model) or problem) from problem
    if late := lateness(model, whole):
        recording = earlier(recording, late)
        whole = run_for(recording, model)
        said = [
            *said,
            f"the pressures were recorded {abs(late):.2g} s {'after' if late > 0.0 else 'before'} the "
            "position, as the gas of both chambers shows; they are taken at their own times",
        ]
    check_length(model, whole)
    run, notes = _trusted(recording, model, without(whole, cuts))
    check_inputs(model, run)
    return run, [f"{note}." for note in (*said, *notes, *check_run(model, run), *velocity_note(recording, run))]


def _vented_on_gauge(recording: Recording, model: Model) -> DataError | None:
    """The error for a chamber whose pressure scatters about zero, where it is the atmosphere's on a gauge."""
    atmosphere = model.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
    mended = corrected(recording, ("gauge",), atmosphere)
    for chamber, pressure in (("a", recording.pressure_a), ("b", recording.pressure_b)):
        if pressure is None or abs(float(np.median(pressure))) > ZERO or np.ptp(pressure) == 0.0:
            continue
        try:
            run = run_for(mended, model)
            vented = constant(run, chamber) and verdict(model, run, chamber) == "vented"
        except PneumoError:
            continue
        if vented:
            other = "b" if chamber == "a" else "a"
            return DataError(
                f"{recording.name}: chamber {chamber} is vented, and the pressures are gauge pressures: "
                f"chamber_{chamber}/pressure scatters about {pressure.mean():.3g} Pa, and the forces on the piston "
                "agree. Type --read-as gauge,no-command to judge friction and load, or --read-as "
                f"gauge,no-pressure-{chamber} to judge chamber {other} and its valve"
            )
    return None


def _trusted(recording: Recording, model: Model, run: Run) -> tuple[Run, list[str]]:
    """The run without measured inputs that are not plausible, and a note on each; DataError if `model` reads them."""
    chambers, notes = PRESSURES if model.force_driven else (), list[str]()
    needed = {*model.inputs, *(chambers if recording.pressures_drive else ())}
    if model.force_driven and "measured_supply" not in needed:  # it fills nothing here, be it air or oil
        run = replace(run, further={name: held for name, held in run.further.items() if name != "measured_supply"})
    for names, check, what in (
        (chambers, _check_oil, "its pressures are not used, and no effect of them is tried"),
        (("measured_supply",), partial(_check_supply, model, run), "its supply pressure is not used"),
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


def _check_supply(model: Model, run: Run, recording: Recording) -> None:
    check_supply(recording)
    if supply_is_gauge(model, run):
        raise DataError(
            f"{recording.name}: supply/pressure is gauge pressure, it seems: with the atmosphere's added, the flows "
            "into the chambers agree; type --read-as gauge-supply, or add it where it is published"
        )


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
    """As `checked_run`; with `mechanics`, by the part of `model` that the recording can judge (see `judged_part`)."""
    return checked_run(recording, judged_part(recording, model) if mechanics else model, cuts)


def judged_part(recording: Recording, model: Model) -> Model:
    """What of `model` a recording judges: its mechanics without a valve command, one chamber with one pressure, or all.

    One chamber is driven by the measured position, whether a valve or the motion alone fills it. A machine of one
    chamber, or without a valve, is judged as a whole.
    """
    if len(model.chambers) < len(SIDES):
        return model
    measured = [pressure for pressure in (recording.pressure_a, recording.pressure_b) if pressure is not None]
    if len(measured) == 1 and (recording.voltage is not None or model.imposed):
        return pneumatic(model)
    forced = recording.effort is not None or (recording.imposed and recording.load_cell is not None and not measured)
    whole = model.imposed or (not model.has_valve and len(measured) == len(model.chambers))
    if recording.voltage is None and not whole and (forced or recording.pressures_drive):
        return mechanical(model, by_force=forced) or model
    return model


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
