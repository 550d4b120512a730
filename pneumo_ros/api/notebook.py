"""Results in a notebook: a verdict, bars, tables, as HTML that needs no library and no script."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from pneumo_ros.report.markup import Content, Html, tag, worded
from pneumo_ros.wording.errors import StepWords
from pneumo_ros.wording.table import Table

_GOOD, _BAD, _BAR, _FLOOR = "#2f855a", "#c2410c", "#0b6fc2", "#9aa5b5"
_WIDTH = 320  # pixels of the longest bar


def page(headline: str, good: bool, *parts: Content) -> str:
    """A sentence in the colour of its verdict, and what stands below it."""
    style = f"border-left: 4px solid {_GOOD if good else _BAD}; padding-left: 0.6em; font-weight: 600"
    return str(tag("div", tag("p", headline, style=style), *parts))


def paragraph(text: str) -> Html:
    """A sentence; nothing where it is empty."""
    return tag("p", text) if text else Html("")


def table(found: Table | None) -> Html:
    """A table of the wording; nothing where it has no rows."""
    return worded(found) if found is not None and found.rows else Html("")


def rows_table(rows: Sequence[Mapping[str, Any]], title: str) -> Html:
    """Rows of one set of keys; numbers with four digits."""
    if not rows:
        return Html("")

    def shown(value: Any) -> str:
        return f"{value:.4g}" if isinstance(value, float) else "-" if value is None else str(value)

    cells = tuple(tuple(shown(value) for value in row.values()) for row in rows)
    return worded(Table(title, tuple(rows[0]), cells, tuple(range(1, len(rows[0])))))


def waterfall(steps: Sequence[StepWords]) -> Html:
    """A bar for each step of a course, and the noise floor: logarithmic, as errors fall over decades."""
    longest = max([one.error for one in steps if math.isfinite(one.error)] + [2.0])

    def bar(name: str, text: str, error: float, colour: str) -> Html:
        share = math.log(max(error, 0.7) / 0.7) / math.log(longest / 0.7) if math.isfinite(error) else 1.0
        block = tag("div", "", style=f"background: {colour}; height: 0.9em; width: {_WIDTH * share:.0f}px")
        left = "text-align: left"
        return tag("tr", tag("td", name, style=left), tag("td", block, style=left), tag("td", text, style=left))

    rows = [bar(one.name, one.text, one.error, _BAR) for one in steps]
    caption = tag("caption", "Typical held-out error, in noise floors (logarithmic)")
    return tag("table", caption, rows, bar("noise floor", "1 x", 1.0, _FLOOR))
