"""The even clock onto which the rows of a table are laid, and which of its points are measured."""

from collections.abc import Mapping

import numpy as np

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import checks
from pneumo_ros.records.recording import Array
from pneumo_ros.records.series import Series
from pneumo_ros.tables.clock import FASTEST, SLOWEST, Clock

MOST = 20_000_000  # points of a grid: 20 min at 20 kHz


def check_rate(rate: float | None) -> None:
    """Raises UsageError for a rate [Hz] that is not accepted."""
    if rate is not None and not SLOWEST <= rate <= FASTEST:
        raise UsageError(f"--rate is {rate:g}; it takes {SLOWEST:g} to {FASTEST:g} Hz")


def grid_of(time: Array, clock: Clock, rate: float | None) -> Array:
    """Times [s] of the recording: those of the rows, where their clock is even and no other `rate` [Hz] is asked for.

    Else even steps from the first row on, at `rate` or at the rows' own rate. Raises DataError for more than MOST
    points.
    """
    if rate is None and clock.even:
        return time
    span = float(time[-1] - time[0])
    # Steps are counted, as gaps and rounded times would change the rate otherwise
    counts = np.maximum(np.rint(np.diff(time) / clock.median), 1.0)
    step = span / float(counts.sum()) if rate is None else 1.0 / rate
    count = int(span / step + 1e-6) + 1
    if count > MOST:
        raise DataError(
            f"{span:.4g} s at {1.0 / step:g} Hz are {count} samples; at most {MOST} are written: cut the table"
        )
    grid: Array = time[0] + step * np.arange(count)
    return np.asarray(grid[grid <= time[-1] + 1e-6 * step])


def covered(grid: Array, time: Array, signals: Mapping[str, Array]) -> Array:
    """The points of `grid` that lie inside every signal (n,) over `time` (n,): in no gap, and not beyond its ends."""
    origin = float(grid[0])
    places = np.arange(len(grid), dtype=np.float64)
    series = _series("grid", grid - origin, places)
    found = [_series(name, time[good] - origin, time[good]) for name, good in _measured(signals).items()]
    step = int(np.median(np.diff(series.stamp))) if len(grid) > 1 else 0
    first = max(int(one.stamp[0]) for one in found) - step // 2
    last = min(int(one.stamp[-1]) for one in found) + step // 2
    kept = checks.outside_gaps(series.select((series.stamp >= first) & (series.stamp <= last)), found)
    return grid[kept.values["value"].astype(np.int64)]


def _measured(signals: Mapping[str, Array]) -> dict[str, "np.ndarray[tuple[int], np.dtype[np.bool_]]"]:
    return {name: np.isfinite(values) for name, values in signals.items()}


def _series(name: str, time: Array, values: Array) -> Series:
    stamp = np.rint(time * 1e9).astype(np.int64)
    return Series(name, stamp, stamp, {"value": values})
