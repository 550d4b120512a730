"""The content of a chart: the browser draws it in a page, and matplotlib in files."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.report.markup import Html

Array = NDArray[np.float64]
Kind = Literal["line", "steps", "dots", "band", "area", "spans", "bars", "removed", "labels"]
# What a trace shows; each role has its colour, in light and dark mode
Role = Literal["measured", "model", "error", "free", "noise", "first", "second", "third", "quiet"]


@dataclass(frozen=True)
class Trace:
    """One curve: x and y (n,), in the units of the axes; a band also has its upper edge, `y_high` (n,).

    NaN breaks a line; an area reaches down to zero; spans are thick horizontal lines, bars thicker ones, and
    removed error is a pale bar; labels are `texts` right of their points. A trace with a `resolution` [unit of y] is
    long: it is stored that finely, and thinned to the screen at every zoom. A click on its name shows a hidden trace.
    """

    name: str
    role: Role
    kind: Kind
    x: Array
    y: Array
    y_high: Array | None = None
    hidden: bool = False
    resolution: float = 0.0
    texts: tuple[str, ...] = ()  # of labels


@dataclass(frozen=True)
class Panel:
    """Traces over one y axis; panels of a chart share its x axis. `share` is the panel's part of the height."""

    title: str
    traces: tuple[Trace, ...]
    share: float = 1.0
    ticks: tuple[str, ...] = ()  # names at 0, 1, 2... instead of numbers


@dataclass(frozen=True)
class Chart:
    """Panels above each other. `words` is a sentence on what they show, also for screen readers.

    Charts with the same `link` zoom together.
    """

    name: str  # file name of the figure, and key in the page
    title: str
    words: str
    x_title: str
    panels: tuple[Panel, ...]
    link: str = ""
    span: tuple[float, float] | None = None  # of x at first; None: all of it
    log_x: bool = False
    height: int = 320  # pixels
    legend: bool = True


@dataclass(frozen=True)
class HeatMap:
    """Rows x columns of ratios to the noise; `href` of a row is the link of its cells."""

    name: str
    title: str
    rows: Sequence[str]
    columns: Sequence[str]
    ratios: Sequence[Sequence[float | None]]
    texts: Sequence[Sequence[str]]  # text below each ratio
    hrefs: Sequence[str]


@dataclass(frozen=True)
class Section:
    """A part of the page: heading, markup and charts, in this order; `parts` below it."""

    identifier: str
    title: str
    body: Html = field(default_factory=Html)
    charts: tuple[Chart, ...] = ()
    heat: HeatMap | None = None
    parts: tuple["Section", ...] = ()
    folded: bool = False  # opened by a click
    columns: int = 1  # charts beside each other, where the screen is wide


@dataclass(frozen=True)
class Badge:
    """The verdict in a word, with a sign and a tone: it can be read without colours, and without letters."""

    sign: str
    word: str
    tone: Literal["good", "found", "unknown"]


@dataclass(frozen=True)
class Report:
    """A page: title, its one-sentence answer, sections, and the JSON of the verb."""

    title: str
    verdict: str
    good: bool
    sections: tuple[Section, ...]
    result: dict[str, object]
    badge: Badge | None = None

    def charts(self) -> list[Chart | HeatMap]:
        """Every figure of the page, in order."""
        return [figure for section in self.sections for figure in _figures(section)]


def _figures(section: Section) -> list[Chart | HeatMap]:
    own: list[Chart | HeatMap] = [section.heat] if section.heat else []
    return own + list(section.charts) + [figure for part in section.parts for figure in _figures(part)]
