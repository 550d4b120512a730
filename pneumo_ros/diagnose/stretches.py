"""The part of recordings for the first ranking of candidates: the stretches that show most of what a machine can do.

They are chosen by the measured signals, not by the model's error: the largest errors may all be in one direction, where
an effect that differs between directions looks like one that does not. Nor by time alone: a valve that opens once in
fifteen seconds shows its dynamics in one of them.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]

LENGTH = 4.0  # s: longest stretch that is chosen at once; neighbours are joined
SETTLING = 0.5  # s at the start of a stretch that are not judged, as its hidden states start at rest
_RATE = 0.05  # s: differences over this time are velocities and rates of change
_KNOWN = 1e-3  # share of the whole information that is there before any stretch is chosen


def stretches(runs: Sequence[Run], seconds: float) -> list[Run]:
    """Stretches of about `seconds` together; [] if all runs are no longer.

    The runs are divided into pieces. One after another, the piece is taken that adds most information per second to
    those taken before: the determinant of the moments of the signals grows most (a D-optimal choice, Fedorov 1972).
    """
    if sum(float(run.time[-1]) for run in runs) <= seconds:
        return []
    pieces = [(k, begin, end) for k, run in enumerate(runs) for begin, end in _divided(float(run.time[-1]))]
    length = np.array([end - begin for _, begin, end in pieces])
    chosen = _informative(_moments(runs, pieces), length, seconds)
    found = list[Run]()
    for k, run in enumerate(runs):
        own = sorted(pieces[i][1:] for i in chosen if pieces[i][0] == k)
        found += [stretch(run, begin, end) for begin, end in _joined(own)]
    return found


def _divided(duration: float) -> list[tuple[float, float]]:
    """Pieces of equal length of a run."""
    edges = np.linspace(0.0, duration, max(round(duration / LENGTH), 1) + 1)
    return list(pairwise(edges.tolist()))


def _joined(own: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Pieces of one run in order of time, those that touch as one."""
    found = list[tuple[float, float]]()
    for begin, end in own:
        if found and found[-1][1] == begin:
            found[-1] = found[-1][0], end
        else:
            found.append((begin, end))
    return found


def _informative(moments: Array, length: Array, seconds: float) -> list[int]:
    """The pieces chosen; moments (pieces, signals, signals), length (pieces,) [s]."""
    here, left, chosen = _KNOWN * moments.sum(axis=0), list(range(len(moments))), list[int]()
    here = here + 1e-9 * np.trace(here) / len(here) * np.eye(len(here))
    while left and length[chosen].sum() < seconds:
        gain = np.linalg.slogdet(here + moments[left])[1] - np.linalg.slogdet(here)[1]
        chosen.append(left.pop(int(np.argmax(gain / length[left]))))
        here = here + moments[chosen[-1]]
    return chosen


def _moments(runs: Sequence[Run], pieces: Sequence[tuple[int, float, float]]) -> Array:
    """Second moments (pieces, signals, signals) of the signals of each piece, each signal over its scatter."""
    signals = [_signals(run) for run in runs]
    whole = np.concatenate(signals)
    middle, scatter = whole.mean(axis=0), whole.std(axis=0)
    found = []
    for k, begin, end in pieces:
        rows = slice(round(begin / runs[k].sample_time), round(end / runs[k].sample_time) + 1)
        own = (signals[k][rows] - middle) / np.where(scatter > 0.0, scatter, 1.0)
        own = np.column_stack([np.ones(len(own)), own])
        found.append(own.T @ own * runs[k].sample_time)
    return np.array(found)


def _signals(run: Run) -> Array:
    """What may distinguish effects (samples, signals): position, motion, input and pressures, and their changes."""
    held = np.append(run.held, run.held[-1])
    v = _rate(run, run.position)
    found = [run.position, run.position**2, v, np.abs(v), np.sign(v), held, np.abs(held)]
    found += [np.abs(_rate(run, held)), _rate(run, v), np.abs(_rate(run, v))]
    for p in (run.pressure_a, run.pressure_b):
        found += [] if p is None else [p, p**2, _rate(run, p), np.abs(_rate(run, p))]
    return np.column_stack(found)


def _rate(run: Run, signal: Array) -> Array:
    """Difference of a signal over a short time, per second (samples,)."""
    n = min(max(round(_RATE / run.sample_time), 1), len(signal) - 1)
    change = np.zeros(len(signal))
    change[n:] = (signal[n:] - signal[:-n]) / (n * run.sample_time)
    return change


def stretch(run: Run, begin: float, end: float) -> Run:
    """The run from `begin` to `end` [s]; its settling time at the start is not judged.

    Running time goes on: friction that falls as the machine warms up looks like other effects without it.
    """
    first, last = round(begin / run.sample_time), min(round(end / run.sample_time), len(run) - 1)
    rows = slice(first, last + 1)
    measured = run.measured[rows].copy()
    if first > 0:
        measured[: round(SETTLING / run.sample_time)] = False
    return replace(
        run,
        position=run.position[rows],
        pressure_a=_part(run.pressure_a, rows),
        pressure_b=_part(run.pressure_b, rows),
        input=run.input[first * PARTS : last * PARTS],
        measured=measured,
        begin=run.begin + first * run.sample_time,
        further={name: held[first * PARTS : last * PARTS] for name, held in run.further.items()},
    )


def _part(signal: Array | None, rows: slice) -> Array | None:
    return None if signal is None else signal[rows]
