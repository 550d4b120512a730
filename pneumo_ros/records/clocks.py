"""Clocks that were set during a recording: only the longest part without a jump can be used."""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from pneumo_ros.records.block import Integers
from pneumo_ros.records.recording import Array
from pneumo_ros.records.series import Series
from pneumo_ros.records.topic_data import set_back

BACK = 0.1  # s: messages out of order fall back by less
JUMP = 1.0  # s between stamps and recorded times: more than transport or a busy recorder causes
PAUSE = 10.0  # s without messages: too long to bridge
_STRAY = 10  # messages in a row: fewer can be strays, of which only the stamps are wrong


class Jump(NamedTuple):
    """A jump in time: index of the first message after it, and how far both clocks move there [s]."""

    first: int
    stamp: float
    recorded: float


def jumps(stamp: Integers, log_time: Integers) -> list[Jump]:
    """Places where a clock was set or time is lost; stamps and recorded times (n,) [ns] in the order of recording.

    Stamps may run at another rate than the recorded time, as simulated time does; simulated time may also stand still.
    """
    if len(stamp) < 2:
        return []
    by_stamp, by_recorder = np.diff(stamp) * 1e-9, np.diff(log_time) * 1e-9
    rate = _usual(by_recorder) / max(_usual(by_stamp), 1e-9)
    back = (by_stamp < -BACK) | (by_recorder < -BACK)
    ahead = (by_stamp > JUMP) & (by_recorder < rate * (by_stamp - JUMP))
    places = np.flatnonzero(back | ahead | (by_stamp > PAUSE))
    return [Jump(int(k) + 1, float(by_stamp[k]), float(by_recorder[k])) for k in places]


def _usual(steps: Array) -> float:
    """Time that passes in all steps [s], each limited to 0 to JUMP."""
    return float(np.sum(np.clip(steps, 0.0, JUMP)))


def without_strays(series: Series, warn: Callable[[str], None]) -> Series:
    """`series` without the few messages whose stamps alone are off by more than BACK or JUMP."""
    bounds = [0, *(jump.first for jump in jumps(series.stamp, series.log_time)), len(series)]
    stray = np.zeros(len(series), dtype=bool)
    for first, last in pairwise(bounds):
        if last - first < _STRAY and first > 0 and last < len(series) and _go_on(series, first, last):
            stray[first:last] = True
    if not stray.any():
        return series
    first = (series.log_time[stray][0] - series.log_time[0]) * 1e-9
    warn(
        f"{series.topic}: {int(np.count_nonzero(stray))} of {len(series)} messages have a stamp far from those around "
        f"them (first at {first:.3f} s); they are left out."
    )
    return series.select(~stray)


def _go_on(series: Series, first: int, last: int) -> bool:
    """Whether time has no jump without the messages from `first` to before `last`."""
    around = [first - 1, last]
    return not jumps(series.stamp[around], series.log_time[around])


def longest(series: Series, warn: Callable[[str], None]) -> slice:
    """The messages of the longest part of `series` without a jump; a warning says what was found and what is used."""
    found = jumps(series.stamp, series.log_time)
    if not found:
        return slice(0, len(series))
    spans = [(series.stamp[part][-1] - series.stamp[part][0]) * 1e-9 for part in _parts(series, found)]
    best = int(np.argmax(spans))
    used = _parts(series, found)[best]
    worst = max(found, key=lambda jump: max(abs(jump.stamp), abs(jump.recorded)))
    more = "" if len(found) == 1 else f", the largest of {len(found)} jumps"
    warn(
        f"{series.topic}: {_what(worst)} at message {worst.first} of {len(series)}{more}. Only the longest part "
        f"without a jump is used: {used.stop - used.start} messages, {spans[best]:.3f} s. Set clocks before recording, "
        "and let NTP or chrony slew them, not step."
    )
    return used


def _what(jump: Jump) -> str:
    """The jump in words."""
    if 0.0 < jump.stamp < 2.0 * jump.recorded:
        return f"nothing is recorded for {jump.stamp:.3f} s (recording paused, or clock set forward)"
    if jump.stamp < -BACK and jump.recorded < -BACK:
        return f"stamps and recorded times jump by {jump.stamp:+.3f} s together"
    if jump.recorded < -BACK:
        return f"recorded times jump by {jump.recorded:+.3f} s while the stamps go on"
    return f"stamps jump by {jump.stamp:+.3f} s while recorded times go on by {jump.recorded:.3f} s"


def beside(series: Series, other: Series) -> Series:
    """The part of `series` between jumps that overlaps `other` most in stamps and recorded times."""
    found = jumps(series.stamp, series.log_time)
    if not found:
        return series
    return max(map(series.select, _parts(series, found)), key=lambda part: _overlap(part, other))


def _overlap(part: Series, other: Series) -> int:
    """Overlap of both series [ns]: the smaller of those by the two clocks."""
    clocks = ((part.stamp, other.stamp), (part.log_time, other.log_time))
    return min(int(min(a[-1], b[-1])) - int(max(a[0], b[0])) for a, b in clocks)


def after_turns(log_time: Integers, turns: int, since: int) -> tuple[Integers, Integers]:
    """Indices and times [ns] of the commands in `log_time` (m,) [ns] after its clock was set back `turns` times.

    The last command before is still in force: it is included, at the time `since` [ns].
    """
    bounds = [0, *set_back(log_time).tolist(), len(log_time)]
    first, last = (bounds[turns], bounds[turns + 1]) if turns + 1 < len(bounds) else (len(log_time), len(log_time))
    carried = int(turns > 0 and first > 0)
    places = np.arange(first - carried, last)
    times = log_time[places]
    times[:carried] = since
    return places, times


def _parts(series: Series, found: list[Jump]) -> list[slice]:
    """The messages between jumps."""
    return [slice(a, b) for a, b in pairwise([0, *(jump.first for jump in found), len(series)])]
