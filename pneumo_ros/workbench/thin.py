"""Long series for a screen: the part in view, two samples for each pixel, the smallest and the largest."""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.report.series import extremes

Array = NDArray[np.float64]
Span = tuple[float, float]
ROOM = 1000  # width of a plot in pixels


def in_view(x: Array, y: NDArray[Any], span: Span | None, room: int = ROOM) -> tuple[Array, Array]:
    """The part of y (n,) over increasing x (n,) in `span`, with a neighbour on both sides; all of it if None.

    At most two samples for each of `room` pixels; all samples if they fit.
    """
    first, last = 0, len(x)
    if span is not None:
        first = max(int(np.searchsorted(x, span[0], side="left")) - 1, 0)
        last = min(int(np.searchsorted(x, span[1], side="right")) + 1, len(x))
    part = np.asarray(y[first:last], dtype=np.float64)
    if not len(part):
        return np.empty(0), np.empty(0)
    kept = extremes(part, -(-len(part) // room))
    return x[first:last][kept], part[kept]


def packed(values: Array) -> dict[str, str]:
    """An array in plotly's binary form: little-endian doubles in base64."""
    return {
        "dtype": "f8",
        "bdata": base64.b64encode(np.ascontiguousarray(values, dtype="<f8").tobytes()).decode("ascii"),
    }


def stretches_in(time: Array, inside: NDArray[np.bool_], span: Span | None) -> list[Span]:
    """Stretches of `time` within `span` where `inside` (n,) holds; those less than a pixel apart are joined."""
    edges = np.diff(np.concatenate([[False], inside, [False]]).astype(np.int8))
    begin, end = time[np.flatnonzero(edges == 1)], time[np.flatnonzero(edges == -1) - 1]
    low, high = span or (float(time[0]), float(time[-1]))
    pixel, found = (high - low) / ROOM, list[Span]()
    for first, last in zip(begin.tolist(), end.tolist(), strict=True):
        if last < low or first > high:
            continue
        if found and first - found[-1][1] < pixel:
            found[-1] = (found[-1][0], last)
        else:
            found.append((first, last))
    return found
