"""Horizontal bars, one row for each name, made of traces that the page and matplotlib both draw."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.report.chart import Role, Trace

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


def bars(
    name: str, role: Role, begin: Array, rows: Rows, end: Array, kind: Literal["bars", "removed"] = "bars"
) -> Trace:
    """A bar in each of `rows` (n,) from `begin` to `end` (n,)."""
    x = np.stack([begin, end, np.full(len(rows), np.nan)], axis=1).ravel()
    y = np.stack([rows, rows, np.full(len(rows), np.nan)], axis=1).ravel()
    return Trace(name, role, kind, x, y)


def guide(name: str, at: float, rows: int) -> Trace:
    """A dotted line across `rows` rows."""
    return Trace(name, "noise", "line", np.array([at, at]), np.array([-0.6, rows - 0.4]))


def labels(x: Array, rows: Rows, texts: Sequence[str]) -> Trace:
    """Texts on the right of each bar."""
    return Trace("labels", "quiet", "labels", x, rows.astype(float), texts=tuple(texts))
