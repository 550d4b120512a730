"""The waterfall: held-out error from the model as given over the refit and every effect down to the noise floor."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.compare.wording import SIGNALS, amount, put_off, times
from pneumo_ros.report.bars import Rows, bars, guide, labels
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.naming import change, effect_words

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Outcome

_DECADES = 8.0  # from this ratio on, the axis is logarithmic
_ROOM = 0.2  # of the axis, right of the longest bar: for its label


def waterfall_section(outcome: "Outcome") -> Section:
    """The chart, and below it each signal in its unit."""
    horizon = outcome.after.horizon
    text = (
        f"Each held-out recording is predicted over windows of {horizon:g} s that start from an estimated state. Shown "
        "is the error of a typical window (the geometric mean, and the root mean square over the signals), in sensor "
        f"noise. None of these recordings was fitted. 1 x is the noise floor. {put_off(outcome.late)}"
    ).rstrip()
    signals = Section("held-out-signals", "Signal by signal", _signals(outcome))
    body = tag("p", text, class_="soft")
    return Section("held-out", "Held-out error", body, charts=(waterfall_chart(outcome.waterfall),), parts=(signals,))


def waterfall_chart(waterfall: Sequence[tuple[str, float]]) -> Chart:
    """A bar for each model of a waterfall (name, error in noise floors): as given, refitted, then what was added."""
    names, errors = [effect_words(name) for name, _ in waterfall], np.array([error for _, error in waterfall])
    lowest, highest = min(float(errors.min()), 1.0), max(float(errors.max()), 1.0)
    log = highest / lowest > _DECADES
    begin = 0.7 * lowest if log else 0.0
    before = np.concatenate([errors[:1], errors[:-1]])
    rows = np.arange(len(errors))
    gone = before > errors
    traces: list[Trace] = [bars("removed", "quiet", errors[gone], rows[gone], before[gone], kind="removed")]
    stages: tuple[tuple[str, Role, Rows], ...] = (
        ("as given", "measured", rows[:1]),
        ("refitted", "second", rows[1:2]),
        ("with what was added", "first", rows[2:]),
    )
    traces += [bars(name, role, np.full(len(own), begin), own, errors[own]) for name, role, own in stages if len(own)]
    said = [times(errors[0]), *(f"{times(b)}  ({change(a, b)})" for a, b in pairwise(errors))]
    traces += [
        bars("noise floor", "noise", np.array([begin]), np.array([len(errors)]), np.array([1.0])),
        guide("noise floor", 1.0, len(errors) + 1),
        labels(np.append(errors, 1.0), np.append(rows, len(errors)), [*said, "1 x"]),
    ]
    steps = "; ".join(f"{name} {text}" for name, text in zip(names, said, strict=True))
    return Chart(
        "waterfall",
        "From the model as given to the noise floor",
        f"Error over the noise floor: {steps}. Pale: what a step removed.",
        "held-out error [noise floors]",
        (Panel("", tuple(traces), ticks=(*names, "noise floor")),),
        span=(begin, highest * (highest / begin) ** _ROOM if log else (1.0 + _ROOM) * highest),
        log_x=log,
        legend=False,
        height=84 + 36 * (len(errors) + 1),
    )


def _signals(outcome: "Outcome") -> Html:
    """Errors of each signal in its unit beside the noise: refitted and, where effects were added, with them."""
    before, after, noise = (outcome.errors[key] for key in ("before", "after", "noise"))
    rows: list[tuple[Content, ...]] = []
    for name in after:
        final = (*_error(after[name], noise[name], name), change(before[name], after[name])) if outcome.added else ()
        first = _error(before[name], noise[name], name)
        rows.append((SIGNALS[name][0], amount(noise[name], name), *first, *final))
    head = ("signal", "noise", "refitted", "/ noise", *(("final model", "/ noise", "change") if outcome.added else ()))
    caption = f"Error over {outcome.after.horizon:g} s, rms over the held-out recordings"
    return table(head, rows, caption, numeric=range(1, len(head)))


def _error(error: float, noise: float, name: str) -> tuple[str, str]:
    return amount(error, name), times(error / noise)
