"""Clocks that run at slightly different rates, as two crystals do: measured by the recorder's clock, and corrected.

A recorded time is a stamp plus a delay that is never negative. The least delays of a topic therefore show how its clock
runs beside the recorder's: on a line whose slope is the drift. Two topics on their lines are on one clock.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pneumo_ros.records.block import Integers
from pneumo_ros.records.recording import Array
from pneumo_ros.records.series import Series

PARTS = 20  # of a recording, of each of which the least delay counts
FEWEST = 100  # messages: of fewer no drift is measured
LEAST = 1e-3  # s at the end of the recording: less is no more than jitter does
SURE = 5.0  # standard errors of a drift that is corrected
MOST = 0.02  # a clock that runs 2 % fast is another kind of time, such as a simulation's


class Line(NamedTuple):
    """Least delay of a topic: `delay` [ns] at the stamp `origin` [ns], its slope, and the slope's standard error."""

    origin: int
    delay: float
    slope: float
    error: float

    def at(self, stamp: Integers) -> Array:
        """The least delay [ns] at `stamp` (n,) [ns]."""
        return np.asarray(self.delay + self.slope * (stamp - self.origin).astype(np.float64))


def least_delays(series: Series) -> Line | None:
    """The line of the least delays of a topic; None where it is too short to show one."""
    if len(series) < FEWEST:
        return None
    delay = (series.log_time - series.stamp).astype(np.float64)
    parts = np.array_split(np.arange(len(series)), PARTS)
    chosen = np.array([part[np.argmin(delay[part])] for part in parts])
    origin = int(series.stamp[0])
    x, y = (series.stamp[chosen] - origin).astype(np.float64), delay[chosen]
    first, second = np.triu_indices(len(x), 1)
    slope = float(np.median((y[second] - y[first]) / np.maximum(x[second] - x[first], 1.0)))  # Theil 1950, Sen 1968
    level = float(np.median(y - slope * x))
    spread = 1.4826 * float(np.median(np.abs(y - slope * x - level)))
    error = 1.25 * spread / max(float(np.std(x)) * np.sqrt(len(x)), 1.0)
    return Line(origin, level, slope, error)


def drifts(slope: float, error: float, span: float) -> bool:
    """Whether a drift is beyond doubt and matters over `span` [ns], and is one of a clock."""
    return abs(slope) * span * 1e-9 > LEAST and abs(slope) > SURE * error and abs(slope) < MOST


def on_rate_of(series: Series, reference: Series, warn: Callable[[str], None]) -> Series:
    """`series` with stamps on the clock of `reference`, where the two run at different rates; a warning says how much.

    Both least delays are taken to be alike.
    """
    own, other = least_delays(series), least_delays(reference)
    if own is None or other is None:
        return series
    slope, error = own.slope - other.slope, float(np.hypot(own.error, other.error))
    span = float(series.stamp[-1] - series.stamp[0])
    if not drifts(slope, error, span):
        return series
    recorded = series.stamp + np.rint(own.at(series.stamp)).astype(np.int64)
    stamp = stamps_at(other, recorded)
    moved = np.abs(stamp - series.stamp).max() * 1e-6
    warn(
        f"{series.topic}: its clock runs {100.0 * abs(slope):.2g} % {'slower' if slope > 0.0 else 'faster'} than that "
        f"of {reference.topic}, by the recorded times; its stamps are corrected by up to {moved:.3g} ms."
    )
    return Series(series.topic, stamp, series.log_time, series.values)


def steady_rate(reference: Series) -> Line | None:
    """The line of `reference` where its clock drifts steadily from the recorder's; None where it does not."""
    line = least_delays(reference)
    span = float(reference.stamp[-1] - reference.stamp[0])
    return line if line is not None and drifts(line.slope, line.error, span) else None


def stamps_at(line: Line, recorded: Integers) -> Integers:
    """The stamps [ns] of what is recorded at `recorded` (n,) [ns] without further delay."""
    since = (recorded - line.origin).astype(np.float64) - line.delay
    found: Integers = line.origin + np.rint(since / (1.0 + line.slope)).astype(np.int64)
    return found
