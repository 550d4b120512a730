"""The part of recordings for the first ranking of candidates: a share of every run, spread evenly over its time.

Chosen by time alone, not by the model's error: the largest errors may all be in one direction, where an effect that
differs between directions looks like one that does not.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]

LENGTH, LEAST = 4.0, 3.0  # s: usual length of a stretch, and the least that is taken of a run
SETTLING = 0.5  # s at the start of a stretch that are not judged, as its hidden states start at rest
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)  # fractions of its multiples fill an interval evenly, in no order


def stretches(runs: Sequence[Run], seconds: float) -> list[Run]:
    """Stretches of about `seconds` together, at least three seconds of every run; [] if all runs are no longer.

    Each run is divided into cells of equal length with a stretch in each. Its place differs from cell to cell, so that
    a periodic motion is not sampled at one phase only.
    """
    whole = sum(float(run.time[-1]) for run in runs)
    if whole <= seconds:
        return []
    found, count = list[Run](), 0
    for run in runs:
        duration = float(run.time[-1])
        own = max(seconds / whole * duration, LEAST)
        if own >= duration:
            found.append(run)
            continue
        cells = max(round(own / LENGTH), 1)
        cell, length = duration / cells, own / cells
        for k in range(cells):
            count += 1
            begin = k * cell + (count * _GOLDEN) % 1.0 * (cell - length)
            found.append(stretch(run, begin, begin + length))
    return found


def stretch(run: Run, begin: float, end: float) -> Run:
    """The run from `begin` to `end` [s]; its settling time at the start is not judged."""
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
    )


def _part(signal: Array | None, rows: slice) -> Array | None:
    return None if signal is None else signal[rows]
