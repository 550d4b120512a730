"""Signals at another rate: interpolated between samples, low-pass filtered first where the rate is lowered."""

from typing import Any

import numpy as np

from pneumo_ros.records.recording import Array, Recording

FASTEST = 4000.0  # Hz: valve and friction act within milliseconds, and a step of the simulation takes 0.1 ms
_SAME = 1.01  # a step this much longer lowers no rate
_THINNER = 1.1  # of FASTEST: faster recordings are thinned
_GAP = 2.5  # samples: a point farther than this from any sample is in a gap
_UNEVEN = 0.1  # of a sample time: clocks that differ by less are not worth a word


def laid(grid: Array, time: Array, values: Array, lowered: bool = True) -> Array:
    """A signal (n,) over `time` (n,) [s] at the times `grid` (m,): linear between finite samples.

    Where the rate may be `lowered`, and the steps of `grid` are longer than those of the samples, what is too fast for
    it is filtered out first.
    """
    good = np.isfinite(values)
    time, values = time[good], values[good]
    if len(time) < 2 or len(grid) < 2:
        return np.full(len(grid), values[0])
    step, own = float(np.median(np.diff(grid))), float(np.median(np.diff(time)))
    if not lowered or step <= _SAME * own:
        return np.asarray(np.interp(grid, time, values))
    from scipy.signal import resample_poly

    times = max(int(np.ceil(step / own - 0.01)), 2)
    count = int(round((grid[-1] - grid[0]) / step)) + 1
    fine = grid[0] + step / times * np.arange(times * (count - 1) + 1)
    slow = resample_poly(np.interp(fine, time, values), 1, times, padtype="line")
    return np.asarray(np.interp(grid, fine[::times], slow))


def thinned(recording: Recording) -> tuple[Recording, list[str]]:
    """A recording of at most FASTEST, without what is too fast for it, and a sentence on that.

    Commands keep their times. Another sentence says how uneven its clock is.
    """
    time, own = recording.time, recording.sample_time
    said = _jitter(time, own)
    if own * FASTEST * _THINNER >= 1.0:
        return recording, said
    step = own * np.ceil(1.0 / (own * FASTEST) - 1e-6)
    grid = np.arange(0.0, time[-1] + 1e-9, step)
    after = np.clip(np.searchsorted(time, grid), 1, len(time) - 1)
    near = np.minimum(np.abs(grid - time[after - 1]), np.abs(time[after] - grid)) < _GAP * own
    signals: dict[str, Any] = {name: laid(grid, time, one)[near] for name, one in recording.signals.items()}
    if recording.voltage is not None:
        last = np.clip(np.searchsorted(time, grid + 1e-9, side="right") - 1, 0, len(time) - 1)
        signals["voltage"] = recording.voltage[last][near]
    said.append(f"{1.0 / own:.4g} Hz are thinned to {1.0 / step:.4g} Hz, without what is too fast for it")
    return recording.with_signals(signals, time=grid[near]), said


def _jitter(time: Array, own: float) -> list[str]:
    """How uneven a clock is, in words, if it is."""
    steps = np.diff(time)
    within = float(np.percentile(np.abs(steps - np.maximum(np.rint(steps / own), 1.0) * own), 90.0))
    if within < _UNEVEN * own:
        return []
    return [
        f"uneven clock: median {1e3 * own:.3g} ms, 90 % within {1e3 * within:.3g} ms, longest step "
        f"{1e3 * float(steps.max()):.3g} ms; signals are interpolated onto even steps"
    ]
