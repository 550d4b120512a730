"""Messages of one topic as numbers over time: cleaned, cut, and brought to the times of another topic."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.records.block import Integers
from pneumo_ros.records.rates import laid
from pneumo_ros.records.recording import Array

Mask = NDArray[np.bool_]
SAME_CLOCK = (-5_000_000, 100_000_000)  # [ns] range of recorded time minus stamp on one clock
COMMAND_LEAD = 0.1  # of a sample time: clocks jitter, so a command may be recorded a little after the sample it acts on


@dataclass(frozen=True)
class Series:
    """Values of one topic; every array has one row per message."""

    topic: str
    stamp: Integers  # [ns] header stamp; the recorded time where a message has none
    log_time: Integers  # [ns] recorded time
    values: dict[str, Array]

    def __len__(self) -> int:
        return len(self.stamp)

    def select(self, mask: Mask | slice) -> "Series":
        """The messages that `mask` picks."""
        chosen = {name: column[mask] for name, column in self.values.items()}
        return Series(self.topic, self.stamp[mask], self.log_time[mask], chosen)


def seconds(stamp: Integers, origin: int) -> Array:
    """Time [s] from `origin` to each of `stamp` [ns]; a float holds the difference to the nanosecond."""
    since: Array = (stamp - origin).astype(np.float64) / 1e9
    return since


def finite(series: Series, name: str, warn: Callable[[str], None]) -> Series:
    """`series` without the messages whose value `name` is NaN or infinite."""
    good = np.isfinite(series.values[name])
    if good.all():
        return series
    first = seconds(series.stamp[~good], int(series.stamp[0]))[0]
    warn(
        f"{series.topic}: {_count(~good)} of {len(good)} values of {name} are not finite (first at {first:.3f} s); "
        "these messages are left out."
    )
    return series.select(good)


def increasing(series: Series, warn: Callable[[str], None]) -> Series:
    """`series` without the messages whose stamp is not later than every stamp before it."""
    if len(series) > 1 and (series.stamp == series.stamp[0]).all():
        warn(f"{series.topic}: all header stamps are equal; the recorded times are used instead.")
        series = Series(series.topic, series.log_time, series.log_time, series.values)
    later = np.ones(len(series), dtype=bool)
    later[1:] = series.stamp[1:] > np.maximum.accumulate(series.stamp)[:-1]
    if later.all():
        return series
    repeated = _count(np.diff(series.stamp) == 0)
    warn(
        f"{series.topic}: {_count(~later)} of {len(later)} messages have a stamp that is not later than the one before "
        f"({repeated} repeat it); they are left out."
    )
    return series.select(later)


def resampled(series: Series, name: str, stamp: Integers) -> Array:
    """Value `name` at the times `stamp` (n,) [ns]: unchanged where stamps agree, linear between, constant outside.

    What is too fast for slower `stamp` is filtered out first.
    """
    if np.array_equal(series.stamp, stamp):
        return series.values[name]
    origin = int(stamp[0])
    return laid(seconds(stamp, origin), seconds(series.stamp, origin), series.values[name])


def held(time: Array, command_time: Array, command: Array) -> Array:
    """Command in force from each of `time` (n,) [s] to the next: zero-order hold, the first one from the start."""
    lead = COMMAND_LEAD * float(np.median(np.diff(time)))
    last = np.searchsorted(command_time, time + lead, side="right") - 1
    return command[np.maximum(last, 0)]


def on_clock_of(joint_states: Series, log_time: Integers, warn: Callable[[str], None]) -> Integers:
    """Recorded times (m,) [ns] on the clock of the stamps of `joint_states`.

    Usually that is the same clock. It is not when stamps are simulated time, when a recording is played back, or when
    another machine's clock is off: then the recorded times of the joint states show which stamp belongs to which time.
    """
    low, high = _apart(joint_states)
    if SAME_CLOCK[0] <= low and high <= SAME_CLOCK[1]:
        return log_time
    span = f"{low * 1e-9:+.3f} s" + (f" to {high * 1e-9:+.3f} s" if high - low > SAME_CLOCK[1] else "")
    warn(
        f"{joint_states.topic}: stamps and recorded times are {span} apart, so they come from different clocks, or the "
        "recorder fell behind; commands, which have no stamp, are placed by the joint states recorded around them."
    )
    recorded, first = np.unique(joint_states.log_time, return_index=True)
    stamp, origin = joint_states.stamp[first], int(recorded[0])
    passed = np.interp(seconds(log_time, origin), seconds(recorded, origin), seconds(stamp, int(stamp[0])))
    # Before and after the joint states time runs at the usual rate.
    beyond = np.minimum(log_time - recorded[0], 0) + np.maximum(log_time - recorded[-1], 0)
    placed: Integers = stamp[0] + np.rint(passed * 1e9).astype(np.int64) + beyond
    return placed


def _apart(series: Series) -> tuple[float, float]:
    """Least and greatest delay [ns], recorded time minus stamp, of the parts of a series: 5th percentile of each."""
    parts = np.array_split(series.log_time - series.stamp, max(min(len(series) // 100, 20), 1))
    best = [float(np.percentile(part, 5)) for part in parts]
    return min(best), max(best)


def _count(mask: Mask) -> int:
    return int(np.count_nonzero(mask))
