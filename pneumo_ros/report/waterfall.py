"""The waterfall: held-out error of the model as given, after the refit and after every effect, and the noise floor."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.report.bars import Rows, bars, guide, labels
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.markup import tag, worded
from pneumo_ros.wording.diagnosis import DiagnosisWords
from pneumo_ros.wording.errors import StepWords

_DECADES = 8.0  # above this ratio, the axis is logarithmic
_ROOM = 0.2  # of the axis, right of the longest bar: for its label


def waterfall_section(said: DiagnosisWords) -> Section:
    """The chart, and each signal in its unit below."""
    text = (
        f"Each held-out recording is predicted over windows of {said.horizon:g} s that start from an estimated state. "
        "Shown is the error of a typical window (the geometric mean over the windows, the root mean square over the "
        "signals), in sensor noise. None of these recordings was fitted. 1 x is the noise floor."
    )
    signals = Section("held-out-signals", "Signal by signal", worded(said.signals))
    body = tag("p", text, class_="soft")
    return Section("held-out", "Held-out error", body, charts=(waterfall_chart(said.steps),), parts=(signals,))


def waterfall_chart(steps: Sequence[StepWords]) -> Chart:
    """A bar for each step: as given, refitted, then the added effects."""
    names, errors = [one.name for one in steps], np.array([one.error for one in steps])
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
    said = [one.text for one in steps]
    traces += [
        bars("noise floor", "noise", np.array([begin]), np.array([len(errors)]), np.array([1.0])),
        guide("noise floor", 1.0, len(errors) + 1),
        labels(np.append(errors, 1.0), np.append(rows, len(errors)), [*said, "1 x"]),
    ]
    words = "; ".join(f"{one.name} {one.text}" for one in steps)
    return Chart(
        "waterfall",
        "From the model as given to the noise floor",
        f"Error over the noise floor: {words}. Pale: what a step removed.",
        "held-out error [noise floors]",
        (Panel("", tuple(traces), ticks=(*names, "noise floor")),),
        span=(begin, highest * (highest / begin) ** _ROOM if log else (1.0 + _ROOM) * highest),
        log_x=log,
        legend=False,
        height=84 + 36 * (len(errors) + 1),
    )
