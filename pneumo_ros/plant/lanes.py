"""Packing of independent lanes into the blocks that the vectorised kernel advances together."""

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _blocks(rows: NDArray[Any], width: int) -> NDArray[Any]:
    """(lanes, n) -> (blocks, n, width), the last block filled up with copies of the last lane."""
    lanes = np.arange(-(-len(rows) // width) * width)
    filled: NDArray[Any] = rows[np.minimum(lanes, len(rows) - 1)]
    return np.asarray(filled.reshape(-1, width, rows.shape[1]).transpose(0, 2, 1))


def run_lanes(
    kernel: ModuleType, states: Array, parameters: Array, voltage: Array, first: NDArray[np.int64], start: Array,
    h: float, stride: int, parts: int, samples: int, threads: int, columns: Sequence[int] | None = None,
) -> Array:  # fmt: skip
    """Run `kernel.run_lanes` over all lanes, on `threads` threads; returns (lanes, samples, states or columns)."""
    width, count = kernel.LANES, len(states)
    n = states.shape[1]
    if not count:
        return np.empty((0, samples, n if columns is None else len(columns)))
    x = np.ascontiguousarray(_blocks(states, width)).reshape(-1, n * width)
    q = np.ascontiguousarray(_blocks(parameters, width)).reshape(len(x), -1)
    f = np.ascontiguousarray(_blocks(first[:, None], width)[:, 0, :])
    t = np.ascontiguousarray(_blocks(start[:, None], width)[:, 0, :])
    out = np.empty((len(x), samples, n * width))

    def part(which: slice) -> None:
        kernel.run_lanes(x[which], q[which], voltage, f[which], t[which], h, stride, parts, out[which])

    share = -(-len(x) // max(threads, 1))
    shares = [slice(i, i + share) for i in range(0, len(x), share)]
    if len(shares) == 1:
        part(shares[0])
    else:
        from concurrent.futures import ThreadPoolExecutor  # slow to import

        with ThreadPoolExecutor(len(shares)) as pool:
            list(pool.map(part, shares))
    kept = out.reshape(len(x), samples, n, width)
    kept = kept if columns is None else kept[:, :, list(columns)]  # before lanes are put in order, which takes longest
    return np.asarray(kept.transpose(0, 3, 1, 2).reshape(-1, samples, kept.shape[2])[:count])
