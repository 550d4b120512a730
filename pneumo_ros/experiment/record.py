"""The record of an experiment on a machine: simulated, without noise."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.experiment.offers import Part
from pneumo_ros.experiment.rehearsal import Rehearsal, rehearse
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.int64]

INTERVAL = 4e-3  # s between samples; noise is scaled to it
_DECIDE = 1.2e-2  # s between two decisions of the conductor, a multiple of INTERVAL
SLIDING = 0.01  # m/s: below this, friction is not a function of velocity
_STILL, _MOVING, _REST = 1e-3, 5e-3, 0.15  # m/s before a breakaway; m/s after it; s of rest before it


@dataclass(frozen=True)
class Record:
    """An experiment from its beginning, returns and rests included. Arrays are (n,), `INTERVAL` apart.

    frame (n, 2 + chambers): y, v and pressures as the sensors show them, v by differences; voltage (n,): held on from
    each sample; recorded: whether a trial was running; breakaways: last samples before the piston slips; ways: their
    directions.
    """

    part: Part
    frame: Array
    voltage: Array
    recorded: Mask
    breakaways: Index
    ways: Array
    duration: float

    @property
    def time(self) -> Array:
        """Since the beginning [s]."""
        return np.asarray(INTERVAL * np.arange(len(self.frame)))

    @property
    def sliding(self) -> Mask:
        """Where a trial was running and the piston slid."""
        return np.asarray(self.recorded & (np.abs(self.frame[:, 1]) > SLIDING))


def record(part: Part, truth: Model) -> Record | str:
    """Run `part` on the machine `truth`; the reason in words if it must not be run."""
    machine = part.held(truth)
    rehearsal = rehearse(part.programme, machine, sample=_DECIDE)
    if rehearsal.aborted:
        return rehearsal.aborted
    count = round(rehearsal.duration / INTERVAL)
    time = INTERVAL * np.arange(count + 1, dtype=float)
    voltage = _held(rehearsal, time)
    states = np.vstack([machine.state(), machine.simulate(voltage[:-1], machine.state(), sample_time=INTERVAL)])
    seen = machine.outputs(states, voltage)
    pressures = [seen[f"{chamber.state}_measured"] for chamber in machine.chambers]
    frame = np.stack([seen["y_measured"], states[:, 1], *pressures], axis=1)
    frame[:, 1] = np.gradient(frame[:, 0], INTERVAL)
    recorded = np.zeros(count + 1, dtype=bool)
    for begin, end in rehearsal.recorded:
        recorded[round(begin / INTERVAL) : round(end / INTERVAL)] = True
    at, ways = _breakaways(states[:, 1], recorded)
    return Record(part, frame, voltage, recorded, at, ways, float(rehearsal.duration))


def _held(rehearsal: Rehearsal, time: Array) -> Array:
    changes, volts = (np.array(column) for column in zip(*rehearsal.commands, strict=True))
    return np.asarray(volts[np.searchsorted(changes, time + 0.5 * INTERVAL, side="right") - 1])


def _breakaways(velocity: Array, recorded: Mask) -> tuple[Index, Array]:
    """Last samples before motion after a rest, where friction is near its limit, and the directions of motion."""
    moving, wait = np.flatnonzero(np.abs(velocity) > _MOVING), round(_REST / INTERVAL)
    found = []
    for k in moving[np.diff(moving, prepend=-wait - 1) > wait]:
        begin = max(k - wait, 0)
        still = np.flatnonzero(np.abs(velocity[begin:k]) < _STILL)
        if len(still) and recorded[k]:
            found.append((begin + int(still[-1]), np.sign(velocity[k])))
    at, ways = (np.array(column) for column in zip(*found, strict=True)) if found else (np.zeros(0), np.zeros(0))
    return at.astype(np.int64), ways
