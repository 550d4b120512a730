"""The waterfall: a bar for each model, and a pale part removed by each step."""

import numpy as np
import pytest

from pneumo_ros.report.chart import Trace
from pneumo_ros.report.waterfall import waterfall_chart
from pneumo_ros.wording.errors import steps


def bars_of(trace: Trace) -> list[tuple[float, float, float]]:
    """Row, begin and end of each bar."""
    ends = np.asarray(trace.x, dtype=float).reshape(-1, 3)[:, :2]
    rows = np.asarray(trace.y, dtype=float).reshape(-1, 3)[:, 0]
    return [(float(row), float(begin), float(end)) for row, (begin, end) in zip(rows, ends, strict=True)]


def test_pale_bars_show_what_each_step_removed() -> None:
    course = [("as given", 6.0), ("refitted", 4.0), ("viscous_friction", 5.0), ("line_delay", 1.2)]
    traces = {trace.name: trace for trace in waterfall_chart(steps(course)).panels[0].traces}
    assert bars_of(traces["removed"]) == [(1.0, 4.0, 6.0), (3.0, 1.2, 5.0)]
    assert bars_of(traces["with what was added"]) == [(2.0, 0.0, 5.0), (3.0, 0.0, 1.2)]


@pytest.mark.parametrize(("first", "log"), [(7.0, False), (9.0, True)])
def test_the_axis_is_logarithmic_from_eight_times_the_noise_floor(first: float, log: bool) -> None:
    assert waterfall_chart(steps([("as given", first), ("refitted", 1.0)])).log_x == log
