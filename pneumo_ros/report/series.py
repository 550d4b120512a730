"""Long series in few bytes: quantised well below the noise, differenced, deflated; thinned if that is still too much.

A page reads them back with `DecompressionStream("deflate")`, which browsers have had since 2023.
"""

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_LARGEST = 2**28  # of a quantised value: differences of differences stay within 32 bits
_PROBE = 1 << 14  # values from which the order is chosen


def encode(x: Array, y: Array, resolution: float) -> dict[str, Any]:
    """x, y (n,) as JSON: y in steps of `resolution` [unit of y], x as multiples of its smallest step; NaN are gaps."""
    steps = np.diff(x)
    step = float(steps.min()) if len(steps) else 1.0
    multiples = np.rint((x - x[0]) / step).astype(np.int64) if len(x) else np.empty(0, dtype=np.int64)
    uniform = bool(len(x) == 0 or multiples[-1] == len(x) - 1)
    found = np.isfinite(y)
    filled = _filled(y, found)
    scale = max(resolution, float(np.max(np.abs(filled), initial=0.0)) / _LARGEST)
    packed = {
        "count": len(x),
        "start": float(x[0]) if len(x) else 0.0,
        "step": step,
        "scale": scale,
        "gaps": _gaps(found),
    }
    packed["y"] = _shortest(np.rint(filled / scale).astype(np.int64))
    if not uniform:
        packed["x"] = _shortest(multiples)
    return packed


def _filled(y: Array, found: NDArray[np.bool_]) -> Array:
    """Gaps filled with the value before them, whose differences are zero."""
    if not found.any():
        return np.zeros(len(y))
    last = np.maximum.accumulate(np.where(found, np.arange(len(y)), -1))
    return np.asarray(np.where(last >= 0, y[np.maximum(last, 0)], y[np.argmax(found)]))


def _gaps(found: NDArray[np.bool_]) -> list[list[int]]:
    edges = np.diff(np.concatenate([[0], (~found).astype(np.int8), [0]]))
    return [[int(a), int(b)] for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)]


def _shortest(values: Index) -> dict[str, Any]:
    """Differences of first or second order, whichever deflates better: the second for smooth curves."""
    first = np.diff(values, prepend=0)
    choices = {1: first, 2: np.diff(first, prepend=0)}
    order = min(choices, key=lambda k: len(_deflated(choices[k][:_PROBE], 1)))
    return {"order": order, "data": base64.b64encode(_deflated(choices[order], 6)).decode("ascii")}


def _deflated(values: Index, effort: int) -> bytes:
    """Signs folded in (0, -1, 1, -2 ... become 0, 1, 2, 3 ...), as four planes of bytes, deflated."""
    folded = ((values << 1) ^ (values >> 63)).astype("<u4")
    return zlib.compress(folded.view(np.uint8).reshape(-1, 4).T.tobytes(), effort)


def extremes(error: Array, bucket: int) -> Index:
    """Two samples of every `bucket` of an error (n,): where it is smallest and where it is largest; ends are kept.

    Buckets of two samples or less keep everything, and so do buckets without a number.
    """
    count = len(error)
    if bucket <= 2:
        return np.arange(count)
    whole = count // bucket * bucket
    rows = error[:whole].reshape(-1, bucket)
    low, high = np.where(np.isnan(rows), np.inf, rows), np.where(np.isnan(rows), -np.inf, rows)
    start = np.arange(len(rows)) * bucket
    kept = [start + low.argmin(axis=1), start + high.argmax(axis=1), np.arange(whole, count), [0, count - 1]]
    return np.asarray(np.unique(np.concatenate(kept)), dtype=np.int64)
