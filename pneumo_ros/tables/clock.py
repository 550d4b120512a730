"""The clock of a table: rows out of order, repeated or without a time; and how even it is."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import clocks
from pneumo_ros.records.block import Integers
from pneumo_ros.records.recording import Array
from pneumo_ros.records.series import Series, increasing

EVEN = 0.01  # of a step: times printed with few digits differ by that
_LATEST = 2.0**31 - 1.0  # s: a header stamp holds no more
_REPEATED = 0.5  # share of rows that repeat a time beyond which its digits are too few
SLOWEST, FASTEST = 20.0, 20_000.0  # Hz


@dataclass(frozen=True)
class Clock:
    """Steps of a clock [s]: median, 90th percentile of the distance from it, and the longest."""

    median: float
    within: float
    longest: float
    even: bool  # all steps are whole multiples of the median

    @property
    def rate(self) -> float:
        """Rows in a second [Hz]."""
        return 1.0 / self.median

    def words(self) -> str:
        """The steps in words: `median 5.2 ms, 90 % within 0.3 ms, longest gap 31 ms`."""
        jitter = self.within if self.within > 1e-6 * self.median else 0.0  # what is less is rounding
        one, most, longest = (f"{1e3 * step:.3g} ms" for step in (self.median, jitter, self.longest))
        return f"median {one}, 90 % within {most}, longest gap {longest}"


def ordered(path: Path, time: Array, warn: Callable[[str], None]) -> Integers:
    """The rows (m,) of `time` (n,) [s] that are used, in increasing time; `warn` gets a sentence on those left out.

    The rules are those for recordings: strays and repeated times are left out, and where the clock was set back or
    stood for more than 10 s, the longest part is used. Raises DataError where no clock is left.
    """
    good = np.flatnonzero(np.isfinite(time))
    if len(good) < len(time):
        warn(f"{len(time) - len(good)} of {len(time)} rows have no time; they are left out.")
    if len(good) < 2:
        raise DataError(
            f"{path} has {len(good)} rows with a time; at least two are needed: name another column in its map"
        )
    least, most = float(time[good].min()), float(time[good].max())
    if least == most:
        raise DataError(
            f"{path}: the time is {least:g} s in all {len(good)} rows; name another column in its map, or, for rows "
            "at a "
            "constant rate, type time: {rate: 1000}"
        )
    if max(abs(least), abs(most)) > _LATEST:
        raise UsageError(
            f"{path}: the time reaches {most:g} s, more than a recording can hold; give its unit: ms, us or ns"
        )
    stamp = np.rint((time[good] - least) * 1e9).astype(np.int64)
    series = Series("time", stamp, stamp, {"row": good.astype(np.float64)})
    kept = clocks.without_strays(series, lambda _: None)
    if len(kept) < len(series):
        warn(
            f"{len(series) - len(kept)} of {len(series)} rows have a time far from those around them; they are left "
            "out."
        )
    kept = _longest_part(kept, warn)
    return _increasing(path, kept, warn).values["row"].astype(np.int64)


def _longest_part(series: Series, warn: Callable[[str], None]) -> Series:
    """The longest part without a jump."""
    found = clocks.jumps(series.stamp, series.log_time)
    if not found:
        return series
    part = clocks.longest(series, lambda _: None)
    first = found[0]
    more = "" if len(found) == 1 else f", the first of {len(found)} jumps"
    row = int(series.values["row"][first.first])
    seconds = (series.stamp[part][-1] - series.stamp[part][0]) * 1e-9
    warn(
        f"the time jumps by {first.stamp:+.3f} s at row {row + 1}{more}; only the longest part without a jump is used: "
        f"{part.stop - part.start} rows, {seconds:.3f} s. Cut the table there to use the others."
    )
    return series.select(part)


def _increasing(path: Path, series: Series, warn: Callable[[str], None]) -> Series:
    """The rows whose time is later than every one before."""
    kept = increasing(series, lambda _: None)
    lost = len(series) - len(kept)
    repeated = int(np.count_nonzero(np.diff(series.stamp) == 0))
    if repeated > _REPEATED * len(series):
        rate = len(series) / ((series.stamp[-1] - series.stamp[0]) * 1e-9)
        raise DataError(
            f"{path}: {repeated} of {len(series)} rows repeat the time before them: it was written with too few "
            "digits. If "
            f"the rows are evenly spaced, type time: {{rate: {rate:.6g}}} in the map"
        )
    if lost:
        warn(
            f"{lost} of {len(series)} rows have a time that is not later than the one before ({repeated} repeat it); "
            "they "
            "are left out."
        )
    return kept


def clock_of(path: Path, time: Array) -> Clock:
    """The clock of increasing times (n,) [s]. Raises DataError outside of SLOWEST to FASTEST."""
    steps = np.diff(time)
    median = float(np.median(steps))
    off = np.abs(steps - median)
    even = bool(np.max(np.abs(steps - np.maximum(np.rint(steps / median), 1.0) * median)) <= EVEN * median)
    found = Clock(median, float(np.percentile(off, 90.0)), float(steps.max()), even)
    if not 0.99 * SLOWEST <= found.rate <= 1.01 * FASTEST:
        raise DataError(
            f"{path}: its rows are {median:.4g} s apart, {found.rate:.4g} Hz; {SLOWEST:g} Hz to {FASTEST:g} Hz are "
            "read. If "
            "the unit of time is wrong, mend it in the map: s, ms, us or ns; a slower recording shows no dynamics of a "
            "servo axis, a faster one must be thinned first"
        )
    return found
