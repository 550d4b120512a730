"""Figures as files: the charts of the page, as PNG and SVG."""

import re
from pathlib import Path

import pytest
from report.pages import compared, report_of

from pneumo_ros.report.chart import Chart, HeatMap
from pneumo_ros.report.drawing import draw_charts

pytest.importorskip("matplotlib", reason="comes with the extra 'figures'")
KINDS = ("overview", "run-2-position_m", "run-2-residuals", "run-2-regimes", "momentum-velocity", "friction-map")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One figure of each kind."""
    folder = tmp_path_factory.mktemp("figures")
    figures = [one for one in report_of(*compared()).charts() if one.name in KINDS]
    assert draw_charts(figures, folder) == len(KINDS)
    return folder


def test_every_figure_is_there_as_png_and_svg(drawn: Path) -> None:
    assert {path.stem for path in drawn.iterdir()} == set(KINDS)
    for name in KINDS:
        assert (drawn / f"{name}.png").read_bytes().startswith(b"\x89PNG\r\n")
        assert (drawn / f"{name}.svg").read_text(encoding="utf-8").lstrip().startswith("<?xml")


def test_figures_hold_curves_and_names_as_they_are(drawn: Path) -> None:
    text = (drawn / "run-2-position_m.svg").read_text(encoding="utf-8")
    assert "<img" not in text
    assert "<script" not in text
    assert "$x_2$" in text  # no formula, and nothing removed
    assert max(map(len, re.findall(r'<path d="([^"]*)"', text))) > 10_000


def test_axes_have_units_and_plain_numbers(drawn: Path) -> None:
    text = (drawn / "friction-map.svg").read_text(encoding="utf-8")
    assert "friction force [N]" in text
    assert "mathdefault" not in text


def test_names_of_figures_are_those_of_the_page() -> None:
    figures = report_of(*compared()).charts()
    assert isinstance(figures[0], Chart)  # the first page's
    assert isinstance(figures[1], HeatMap)
    names = [one.name for one in figures]
    assert len(names) == len(set(names))
    assert all(re.fullmatch(r"[\w-]+", name) for name in names)
    assert all(one.words for one in figures if isinstance(one, Chart))
