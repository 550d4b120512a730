"""Pressures of sealed chambers that were recorded later than the position: by another device, or behind a filter.

The first law of a sealed chamber, p' V + gamma p V' = (gamma - 1) Q with V = V_0 + A y and Q = h (T_w - T), is linear
in four unknowns: its volume V_0 / A, and three by which heat passes at any h, T_w and mass of gas:

    y p' + gamma p v = -V_0 / A p' + c_1 - c_2 p - c_3 y p

So it needs nothing of a machine but gamma, and no other delay fits as well as the right one.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.records import Recording
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.smooth import smooth

Array = NDArray[np.float64]

_LONGEST, _STEP = 1.0, 0.02  # s: longest delay that is looked for, and steps in which it is
_WINDOW = 0.25  # s, half of it: smoothing before derivatives are taken
_GAIN = 2.5  # times smaller residual that proves a delay, as for mistakes of the wiring
_AGREE = 0.1  # s: how far apart the delays of both chambers may be
_MOVES = 0.1  # of the stroke: with less motion nothing is asked


def lateness(model: Model, run: Run) -> float:
    """Delay [s] of all pressures of sealed chambers against the position, negative for early ones; 0 for none."""
    chambers = run.sensed(model.chambers)
    if model.has_valve or not chambers or np.ptp(run.position) < _MOVES * model["piston.stroke"]:
        return 0.0
    each = [_delay(run, run.signals[one.signal], model["air.heat_capacity_ratio"]) for one in chambers]
    late = float(np.mean([delay for delay, _ in each]))
    proved = min(gain for _, gain in each) > _GAIN and float(np.ptp([delay for delay, _ in each])) < _AGREE
    return late if proved and abs(late) > 2.0 * run.sample_time else 0.0


def earlier(recording: Recording, late: float) -> Recording:
    """The recording with pressures that were recorded `late` [s] at their own times; the last ones last to the end."""
    given = {"pressure_a": recording.pressure_a, "pressure_b": recording.pressure_b}
    moved = {name: np.interp(recording.time + late, recording.time, p) for name, p in given.items() if p is not None}
    return recording.with_signals(moved)


def _delay(run: Run, pressure: Array, gamma: float) -> tuple[float, float]:
    """The delay [s] of one pressure (n,), and how many times smaller the residual is with it than without."""
    time = np.arange(0.0, run.time[-1] - run.time[0], _STEP)
    if len(time) < 10 * round(_LONGEST / _STEP):
        return 0.0, 1.0
    clock = run.time - run.time[0]
    y = np.interp(time, clock, smooth(run.position, run.sample_time, _WINDOW, 3, 0))
    v = np.interp(time, clock, smooth(run.position, run.sample_time, _WINDOW, 3, 1))
    p, rate = (smooth(pressure, run.sample_time, _WINDOW, 3, order) for order in (0, 1))
    delays = _STEP * np.arange(-round(_LONGEST / _STEP), round(_LONGEST / _STEP) + 1)
    left = [
        _residual(y, v, np.interp(time + d, clock, p), np.interp(time + d, clock, rate), gamma) for d in delays.tolist()
    ]
    best, none = int(np.argmin(left)), len(delays) // 2
    return (float(delays[best]), left[none] / left[best]) if 0 < best < len(left) - 1 else (0.0, 1.0)


def _residual(y: Array, v: Array, p: Array, rate: Array, gamma: float) -> float:
    """Root mean square of what the first law leaves, with the best volume and heat, without both ends."""
    ends = slice(round(_LONGEST / _STEP), -round(_LONGEST / _STEP))
    work = (y * rate + gamma * p * v)[ends]
    terms = np.stack([rate, np.ones(len(p)), p, y * p], axis=1)[ends]
    terms = terms / np.abs(terms).max(axis=0)
    return float(np.std(work - terms @ np.linalg.lstsq(terms, work, rcond=None)[0]))
