"""Faults of readable recordings: each check returns sentences, or none when all is well."""

from collections.abc import Collection, Iterable

import numpy as np

from pneumo_ros.records.block import Integers
from pneumo_ros.records.series import Series

GAP = 5.0  # sample times between two samples that count as a gap
APART = 0.1  # s between the clocks of two topics: more than transport explains
PAUSE = 0.05  # s without a command in a stream of them: valves close after some tenths of a second
FEWEST = 10  # fewest samples in which gaps are looked for


def gaps(series: Series) -> list[str]:
    """Times without samples, longer than GAP sample times."""
    wide = _wide(series)
    if not len(wide):
        return []
    steps = np.diff(series.stamp) * 1e-9
    longest = wide[np.argmax(steps[wide])]
    at = (series.stamp[longest] - series.stamp[0]) * 1e-9
    many = "1 gap" if len(wide) == 1 else f"{len(wide)} gaps"
    return [
        f"{series.topic}: {many} of more than {GAP:g} sample times ({GAP * np.median(steps) * 1e3:.3g} ms), "
        f"the longest {steps[longest]:.3g} s at {at:.3f} s, {steps[wide].sum():.3g} s in all; data in a "
        "gap is not used."
    ]


def outside_gaps(series: Series, others: Iterable[Series]) -> Series:
    """`series` without the samples in a gap of one of `others`: interpolated values there would be invented."""
    inside = np.zeros(len(series), dtype=bool)
    for one in others:
        wide = _wide(one)
        if not len(wide):
            continue
        after = np.searchsorted(one.stamp[wide], series.stamp, side="left") - 1  # the last gap that begins before
        inside |= (after >= 0) & (series.stamp < one.stamp[wide[after] + 1])
    return series.select(~inside)


def _wide(series: Series) -> Integers:
    """Indices of the samples before gaps."""
    steps = np.diff(series.stamp)
    if len(series) < FEWEST:
        return steps[:0]
    return np.flatnonzero(steps > GAP * np.median(steps))


def other_clock(series: Series, joint_states: Series) -> list[str]:
    """Whether the stamps of `series` come from another clock than those of `joint_states`, by the recorded times."""
    late, usual = (float(np.median(one.log_time - one.stamp)) * 1e-9 for one in (series, joint_states))
    if abs(late - usual) < APART:
        return []
    return [
        f"{series.topic}: its stamps are {usual - late:+.3f} s off from those of {joint_states.topic} recorded at the "
        "same time; if their clocks differ, synchronise them (NTP, chrony): signals are aligned by stamps."
    ]


def unmatched(series: Series, joint_states: Series) -> list[str]:
    """Samples of `joint_states` for which `series` has no message with the same stamp."""
    if np.array_equal(series.stamp, joint_states.stamp):
        return []
    missing = int(np.count_nonzero(~np.isin(joint_states.stamp, series.stamp)))
    if not missing:
        return []
    return [
        f"{series.topic}: {missing} of {len(joint_states)} samples of {joint_states.topic} have no message with their "
        "stamp; values between the messages are interpolated."
    ]


def trimmed(before: Series, after: Series, why: str) -> list[str]:
    """Samples cut from the ends of `before`, if they are more than GAP."""
    lost = len(before) - len(after)
    if lost <= GAP:
        return []
    start = (after.stamp[0] - before.stamp[0]) * 1e-9
    end = (before.stamp[-1] - after.stamp[-1]) * 1e-9
    return [f"{before.topic}: {start:.3f} s at the start and {end:.3f} s at the end are left out, {why}."]


def pauses(commands: Series, joint_states: Series) -> list[str]:
    """Pauses in a stream of commands, and joint states that came late: an overloaded PC, which no model explains.

    A command that is sent on change may rest as long as it likes: a pause counts where joint states came late in it.
    """
    steps, late = np.diff(commands.stamp) * 1e-9, (joint_states.log_time - joint_states.stamp) * 1e-9
    if len(steps) < FEWEST:
        return []
    usual, delay = float(np.median(steps)), late - np.median(late)
    wide = np.flatnonzero(steps > max(GAP * usual, PAUSE))
    if not len(wide) or len(wide) > 0.1 * len(steps):
        return []
    slow = joint_states.stamp[delay > PAUSE]
    begin, end = commands.stamp[wide], commands.stamp[wide + 1]
    overloaded = np.searchsorted(slow, end) > np.searchsorted(slow, begin)
    wide = wide[overloaded]
    if not len(wide):
        return []
    longest = wide[np.argmax(steps[wide])]
    at = (commands.stamp[longest] - joint_states.stamp[0]) * 1e-9
    return [
        f"{commands.topic}: {len(wide)} pauses of more than {max(GAP * usual, PAUSE):.2g} s in a stream of "
        f"{1.0 / usual:.0f} Hz, the longest {steps[longest]:.2g} s at {at:.3f} s; joint states came up to "
        f"{float(delay.max()):.2g} s late: the PC was overloaded. A valve closes when commands stop, which no model "
        f"knows: leave these times out, such as --cut BAG:{max(at, 0.0):.1f}-{at + steps[longest] + 0.5:.1f}."
    ]


def all_of(series: Collection[Series], joint_states: Series) -> list[str]:
    """Every check of the sampled signals."""
    used = outside_gaps(joint_states, series)
    found = gaps(joint_states)
    for one in series:
        found += gaps(one) + other_clock(one, joint_states) + unmatched(one, used)
    return found
