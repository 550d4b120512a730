"""Figures that judge a run of a control law."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.control.closed_loop import Record

Array = NDArray[np.float64]
STICKS, SLIPS = 5e-4, 5e-3  # m/s: below the first the piston sticks, above the second it slides


@dataclass(frozen=True)
class Tracking:
    """Error from a time on: rms [m], peak [m]; valve activity [V/s]; breakaways: how often it stuck and slid on."""

    rms: float
    peak: float
    activity: float
    breakaways: int


@dataclass(frozen=True)
class Arrival:
    """One move: largest error at its end [m], time from its beginning until the error stays within the tolerance [s]
    (the whole hold, if it does not), and the motion in the last quarter [m], which is hunting.
    """

    error: float
    settling: float
    motion: float


def tracking(record: Record, begin: float = 0.0) -> Tracking:
    """Figures of `record` from the time `begin` [s] on."""
    k = int(np.searchsorted(record.time, begin))
    error = record.reference[k:] - record.states[k:, 0]
    seconds = float(record.time[-1] - record.time[k])
    return Tracking(
        float(np.sqrt(np.mean(error**2))),
        float(np.abs(error).max()),
        float(np.abs(np.diff(record.voltage[k:])).sum()) / seconds,
        breakaways(record.states[k:, 1]),
    )


def breakaways(velocity: Array) -> int:
    """How often a piston of that `velocity` [m/s] stuck and slid on."""
    speed = np.abs(velocity)
    known = speed[(speed < STICKS) | (speed > SLIPS)] > SLIPS  # in between it does not change
    return int(np.count_nonzero(known[1:] & ~known[:-1]))


def arrivals(record: Record, hold: float, tolerance: float = 3e-4) -> list[Arrival]:
    """Every move of `record`, each of `hold` [s]; the first is left out, because nothing moves in it."""
    n = round(hold / float(record.time[1] - record.time[0]))
    moves = len(record.time) // n
    return [_arrival(record, slice(k * n, (k + 1) * n), hold, tolerance) for k in range(1, moves)]


def _arrival(record: Record, part: slice, hold: float, tolerance: float) -> Arrival:
    y = record.states[part, 0]
    error = np.abs(record.reference[part] - y)
    outside = np.flatnonzero(error > tolerance)
    last = -(-len(y) // 4)
    return Arrival(
        float(error[-last:].max()),
        hold * float(outside[-1] + 1) / len(y) if len(outside) else 0.0,
        float(np.ptp(y[-last:])),
    )
