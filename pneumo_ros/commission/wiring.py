"""What the plumbing trial says of a rig's wiring, and what to swap."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pneumo_ros.commission.information import begun
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import family_scales
from pneumo_ros.diagnose.score import MARGIN
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.reading.read import ATMOSPHERE
from pneumo_ros.reading.rig_guess import Guess, guess_rig, moving_part
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import corrected, wiring
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.run import Run, check_position, run_for

FAULTS = {  # words that say that a plug, a hose or a sign is wrong, and how to mend it
    "swapped-chambers": "swap the plugs of the two pressure sensors (each shows the other chamber)",
    "reversed-position": "reverse the sign of the position sensor (it falls while the rod extends)",
    "reversed-voltage": "swap the two hoses between valve and cylinder, or reverse the sign of the command (a positive "
    "command retracts the rod)",
}
STEADY = 1e-4  # of its mean: a pressure that moves by less shows nothing
TRIED = 8  # wirings that explain the trial alike, fitted
VALVES = 6  # that fits begin with, one after another until a wiring explains the recordings
EXPLAINED = 4.0  # times the noise of windows: up to it a fit explains recordings; wrong wirings leave 13 and more
MOVED = 0.004  # m, the least that one of the ramps must have moved


class UnmovedError(DataError):
    """The piston hardly moved."""


@dataclass(frozen=True)
class Wired:
    """The wiring: words of --read-as, those of them that are faults, and whether no other wiring explains the trial."""

    words: tuple[str, ...]
    certain: bool

    @property
    def faults(self) -> dict[str, str]:
        """What to mend, by word."""
        return {word: FAULTS[word] for word in self.words if word in FAULTS}


def find_wiring(
    recordings: Sequence[Recording], model: Model, known: Sequence[str] = (), sensors: Sequence[str] | None = None
) -> Wired:
    """The wiring that recordings show, that of the plumbing trial first; a `known` closed signal is not guessed.

    `sensors`: unit of the pressures, and gauge or not, as words; None: to be guessed.

    Raises DataError, with what to look at, where a sensor is dead, UnmovedError where the piston hardly moved.
    """
    _check_alive(recordings[0], model)
    found = guess_rig(recordings, model, sensors, [word for word in known if word.startswith("closed=")])
    judged = fitted(found, recordings, model)
    return Wired(judged.best.words, judged.certain)


def fitted(found: Guess, recordings: Sequence[Recording], model: Model) -> Guess:
    """The guess with the hypotheses that explain the recordings alike in the order of fits of the machine to them."""
    alike = found.alike[:TRIED]
    if len(alike) < 2:
        return found
    parts = [moving_part(one) for one in recordings]
    fitters = {one.words: _fitter(parts, model, one.words) for one in alike}
    fits = dict.fromkeys(fitters, UNFIT)
    for number in range(VALVES):  # that of the data sheet first
        fits = {words: max(fits[words], _fit(fitter, number)) for words, fitter in fitters.items()}
        if max(fits.values()).misfit < EXPLAINED:
            break
    best, second, *others = sorted(alike, key=lambda one: -fits[one.words].likelihood)
    ranked = (best, second, *others, *(one for one in found.ranked if one not in alike))
    sure = fits[best.words].likelihood > fits[second.words].likelihood + MARGIN
    return replace(found, ranked=ranked, decided=sure)


class Fit(NamedTuple):
    """Log likelihood of recordings at a fit of the machine, and the largest residual of an equation, over its noise."""

    likelihood: float
    misfit: float


UNFIT = Fit(-math.inf, math.inf)  # of a wiring that makes no sense, or a machine that cannot be


def _fitter(recordings: Sequence[Recording], model: Model, words: tuple[str, ...]) -> Fitter | None:
    """What fits the machine, within what its file says, to the recordings wired as `words` say.

    Mirror images move alike and differ by the areas of the piston: wired wrongly, volumes and friction have to give.
    """
    try:
        runs = on_one_clock([as_run(recording, model, words) for recording in recordings])
        return Fitter(model, runs, candidates=())
    except PneumoError:
        return None


def _fit(fitter: Fitter | None, number: int) -> Fit:
    """The fit that begins with valve `number` of `begun`: a dead zone far beyond the data sheet's takes a near one."""
    if fitter is None or number >= len(starts := begun(fitter.start, fitter.train.runs)):
        return UNFIT
    try:
        found = fitter.refit(starts[number])
        found.state()
        scale = family_scales(fitter.train, fitter.train.residual(found))
        misfit = max(one for name, one in zip(fitter.train.names, scale, strict=True) if name != "breakaway")
        return Fit(fitter.likelihood(found), float(misfit))
    except PneumoError:
        return UNFIT


def as_run(recording: Recording, model: Model, words: Sequence[str]) -> Run:
    """The recording as a run of `model`, wired as `words` say.

    Gauge sensors are not looked for once more: figures of data sheets are too rough. Raises DataError for a recording
    that cannot be used.
    """
    atmosphere = model.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
    run = run_for(corrected(recording, words, atmosphere), model)
    check_position(model, run)
    return run


def _check_alive(recording: Recording, model: Model) -> None:
    position = recording.position
    if float(np.ptp(position)) == 0.0:
        raise DataError("the position never changes: is its sensor plugged in, and the supply pressure on?")
    dead = [
        side
        for side, signal in (("a", recording.pressure_a), ("b", recording.pressure_b))
        if signal is None or float(np.ptp(signal)) <= STEADY * max(float(np.abs(signal).mean()), 1e-12)
    ]
    if dead:
        topics = " and ".join(f"chamber_{side}/pressure" for side in dead)
        raise DataError(f"{topics} never changes while the valve opens both ways: is the sensor plugged in?")
    metres = wiring(("mm",)).length if float(np.ptp(position)) > 2.0 * model["piston.stroke"] else 1.0
    if metres * float(np.ptp(position)) < MOVED:
        largest = float(np.abs(recording.voltage).max()) if recording.voltage is not None else 0.0
        raise UnmovedError(
            f"the piston moved by {1e3 * metres * float(np.ptp(position)):.1f} mm only, with commands up to "
            f"{largest:.2f} V: is the supply pressure on, does the valve get the command, is the piston free? A valve "
            "with a wider dead zone needs dead_zone limits in the machine file"
        )
