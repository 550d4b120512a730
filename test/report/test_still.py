"""Charts as drawings without a script, and the round numbers along their axes."""

import re

import numpy as np
import pytest

from pneumo_ros.report.chart import Chart, Panel, Trace
from pneumo_ros.report.scale import Scale, ticks
from pneumo_ros.report.still import WIDTH, still

X = np.arange(5.0)


def drawn(*traces: Trace, **more: object) -> str:
    """The drawing of one panel."""
    return still(Chart("c", "A <chart>", "", "time [s]", (Panel("y [mm]", traces),), **more))  # type: ignore[arg-type]


def paths(text: str, kind: str) -> list[str]:
    """The paths of all traces of a kind."""
    return re.findall(rf'<path d="([^"]*)" class="trace [a-z]+ {kind}', text)


@pytest.mark.parametrize(
    ("low", "high", "log", "expected"),
    [
        (0.0, 6.0, False, [0, 1, 2, 3, 4, 5, 6]),
        (-0.21, 0.14, False, [-0.2, -0.1, 0.0, 0.1]),
        (0.7, 300.0, True, [1, 2, 5, 10, 20, 50, 100, 200]),
        (0.7, 3e5, True, [1, 10, 100, 1e3, 1e4, 1e5]),
    ],
)
def test_axes_have_round_numbers(low: float, high: float, log: bool, expected: list[float]) -> None:
    assert ticks(low, high, log) == pytest.approx(expected)


def test_a_scale_ends_at_its_ends() -> None:
    scale = Scale(1.0, 100.0, 0.0, 50.0, log=True)
    assert [scale(v) for v in (-1.0, 1.0, 10.0, 1e9)] == pytest.approx([0.0, 0.0, 25.0, 50.0])


@pytest.mark.parametrize("x", [[0.2], [0.2, 0.2], [0.0, 0.2], [-1.0, 0.2], [0.0], []])
def test_a_logarithmic_axis_takes_one_value_and_values_without_a_logarithm(x: list[float]) -> None:
    at = np.array(x)
    (path,) = paths(drawn(Trace("y", "model", "dots", at, at), log_x=True), "dots")
    assert path.count("M") == len([value for value in x if value > 0.0])


def test_a_line_goes_from_end_to_end_and_has_a_gap_where_data_are_missing() -> None:
    (whole,) = paths(drawn(Trace("y", "model", "line", X, X)), "line")
    moves = [tuple(map(int, pair)) for pair in re.findall(r"[Ml](-?\d+) (-?\d+)", whole)]
    assert (moves[0][0], sum(x for x, _ in moves)) == (150, WIDTH - 24)
    assert all(y < 0 for _, y in moves[1:])  # rises
    (broken,) = paths(drawn(Trace("y", "model", "line", X, np.array([0.0, 1.0, np.nan, 1.0, 0.0]))), "line")
    assert (whole.count("M"), broken.count("M")) == (1, 2)


def test_long_series_are_thinned_and_keep_their_extremes() -> None:
    x = np.arange(100_000.0)
    y = np.zeros(len(x))
    y[54_321] = 1.0
    (path,) = paths(drawn(Trace("y", "model", "line", x, y)), "line")
    assert len(path) < 10_000
    assert min(int(dy) for dy in re.findall(r"l\d+ (-?\d+)", path)) < -100


def test_hidden_traces_are_left_out_and_names_are_escaped() -> None:
    shown = Trace("<b>", "model", "line", X, X)
    text = drawn(shown, Trace("hidden", "free", "line", X, X, hidden=True))
    assert "hidden" not in text.replace('aria-hidden="true"', "")
    assert "&lt;b&gt;" in text
    assert "<b>" not in text


@pytest.mark.parametrize("kind", ["steps", "dots", "band", "area", "spans", "bars", "removed"])
def test_every_kind_is_drawn_and_nothing_to_draw_is_no_error(kind: str) -> None:
    high = X + 1.0 if kind == "band" else None
    assert paths(drawn(Trace("y", "first", kind, X, X, high)), kind)[0].startswith("M")  # type: ignore[arg-type]
    empty = np.empty(0)
    assert 'd="z"' not in drawn(Trace("y", "first", kind, empty, empty, None))  # type: ignore[arg-type]


def test_a_band_has_an_outline_for_each_stretch() -> None:
    low = np.array([0.0, 1.0, np.nan, 1.0, 0.0])
    (outline,) = paths(drawn(Trace("y", "first", "band", X, low, low + 1.0)), "band")
    assert (outline.count("M"), outline.count("z")) == (2, 2)
