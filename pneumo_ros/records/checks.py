"""What may be wrong with a recording that can be read: each check returns sentences, none when all is well."""

from collections.abc import Iterable

import numpy as np

from pneumo_ros.records.series import Series

GAP = 5.0  # sample times between two samples that count as a gap
FEWEST = 10  # samples a recording is good for anything with


def gaps(series: Series) -> list[str]:
    """Times without samples, longer than GAP sample times."""
    if len(series) < FEWEST:
        return []
    steps = np.diff(series.stamp) * 1e-9
    usual = float(np.median(steps))
    wide = np.flatnonzero(steps > GAP * usual)
    if not len(wide):
        return []
    longest = wide[np.argmax(steps[wide])]
    at = (series.stamp[longest] - series.stamp[0]) * 1e-9
    many = "1 gap" if len(wide) == 1 else f"{len(wide)} gaps"
    return [
        f"{series.topic}: {many} of more than {GAP:g} sample times ({GAP * usual * 1e3:.3g} ms), the longest "
        f"{steps[longest]:.3g} s at {at:.3f} s."
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


def all_of(series: Iterable[Series], joint_states: Series) -> list[str]:
    """Every check of the sampled signals."""
    found = gaps(joint_states)
    for one in series:
        found += gaps(one) + unmatched(one, joint_states)
    return found
