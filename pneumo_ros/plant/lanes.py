"""Independent lanes, in blocks that the vectorised kernel advances together, shared among threads."""

import os
from collections.abc import Callable, Sequence
from functools import cache
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.reach import fades

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

Array = NDArray[np.float64]

# A block of lanes takes as long however few of them are filled, as long as three runs do; but it passes over effects
# that do not act. So many lanes at most run alone, where at least this share of the effects acts.
ALONE, MOST_ACT = 2, 0.5


def _blocks(rows: NDArray[Any], width: int) -> NDArray[Any]:
    """(lanes, n) -> (blocks, n, width), the last block filled up with copies of the last lane."""
    lanes = np.arange(-(-len(rows) // width) * width)
    filled: NDArray[Any] = rows[np.minimum(lanes, len(rows) - 1)]
    return np.asarray(filled.reshape(-1, width, rows.shape[1]).transpose(0, 2, 1))


def _share(part: Callable[[slice], None], count: int, threads: int) -> None:
    """Call `part` with slices that cover `count` blocks of lanes, on `threads` threads."""
    share = -(-count // max(threads, 1))
    shares = [slice(i, i + share) for i in range(0, count, share)]
    if len(shares) == 1:
        part(shares[0])
        return
    others = [_pool(os.getpid()).submit(part, one) for one in shares[1:]]
    part(shares[0])
    for other in others:
        other.result()


@cache
def _pool(process: int) -> "ThreadPoolExecutor":
    """Threads kept for thousands of short calls; each process has its own, because a forked one inherits none."""
    from concurrent.futures import ThreadPoolExecutor  # slow to import

    return ThreadPoolExecutor(os.cpu_count())


def run_lanes(
    kernel: ModuleType, states: Array, parameters: Array, inputs: Array, first: NDArray[np.int64], start: Array,
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
        kernel.run_lanes(x[which], q[which], inputs, f[which], t[which], h, stride, parts, out[which])

    _share(part, len(x), threads)
    kept = out.reshape(len(x), samples, n, width)
    kept = kept if columns is None else kept[:, :, list(columns)]  # before the lanes are reordered, the slowest part
    return np.asarray(kept.transpose(0, 3, 1, 2).reshape(-1, samples, kept.shape[2])[:count])


def fitting(
    measured: ArrayLike, rest: ArrayLike, parameters: ArrayLike, frame: int, others: int, width: int
) -> tuple[Array, Array, Array]:
    """Arguments of `follow_lanes`: measured (lanes or 1, samples, frame), rest (lanes, others), q (lanes, width).

    An array that all lanes share may lack its first axis. Raises UsageError for shapes that do not fit.
    """
    # the kernel would be compiled again for arrays that are read-only or not contiguous
    given, tail, q = (np.require(a, float, ["C", "W"]) for a in (measured, rest, parameters))
    lanes = q.shape[:1]
    fits = given.ndim in (2, 3) and given.shape[:-2] in ((), lanes) and given.shape[-1] == frame
    if not (fits and given.shape[-2] and q.shape == (*lanes, width) and tail.shape in ((others,), (*lanes, others))):
        raise UsageError(
            f"lanes do not fit: measured {given.shape}, rest {tail.shape}, parameters {q.shape}; needed are "
            f"(samples, {frame}), ({others},), each with or without lanes before, and (lanes, {width})"
        )
    return given.reshape(-1, *given.shape[-2:]), np.array(np.broadcast_to(tail, (*lanes, others)), order="C"), q


def acting_in(effects: Sequence[type[Effect]], parameters: Array) -> NDArray[np.bool_]:
    """In which lanes each effect that fades acts (lanes, effects), by the parameters (lanes, parameters) of all."""
    found, first = list[NDArray[np.bool_]](), 0
    for effect in effects:
        own = [(first + k, p.neutral) for k, p in enumerate(effect.parameters.values()) if p.neutral is not None]
        first += len(effect.parameters)
        if fades(effect):
            columns, neutral = zip(*own, strict=True)
            found.append(np.any(parameters[:, columns] != np.array(neutral), axis=1))
    return np.asarray(np.array(found).reshape(len(found), len(parameters)).T, dtype=bool)


def follow_one(
    kernel: ModuleType, measured: Array, inputs: Array, rest: Array, parameters: Array,
    start: float, h: float, stride: int, parts: int,
) -> tuple[Array, Array]:  # fmt: skip
    """Run `kernel.follow` along measured (samples, m) from rest (states - m,); returns states and derivatives.

    Both are (samples, states); row 0 of the derivatives is left alone.
    """
    frame = measured.shape[1]
    X = np.empty((len(measured), frame + len(rest)))
    X[:, :frame], X[0, frame:] = measured, rest
    out = np.empty_like(X)
    kernel.follow(X, parameters, inputs, start, h, stride, parts, out)
    return X, out


def follow_lanes(
    kernel: ModuleType, measured: Array, inputs: Array, rest: Array, parameters: Array,
    acting: NDArray[np.bool_], owners: NDArray[np.int64], effects: int, kept: NDArray[np.int64],
    wanted: NDArray[np.int64], start: float, h: float, stride: int, parts: int, threads: int,
) -> tuple[Array, Array]:  # fmt: skip
    """Run `kernel.follow_lanes` over all lanes, on `threads` threads; returns the kept states, wanted derivatives.

    measured (lanes or 1, samples, m), rest (lanes, states - m), parameters (lanes, parameters); acting (lanes,
    fading): by `acting_in`, or all True; owners (states,): its column for the effect of each state, -1 where that does
    not fade; `effects`: how many there are in all; kept, wanted: indices of states; `start` [s]: time of the first
    sample. Both results are (lanes, samples, indices); row 0 of the derivatives repeats row 1. One or two lanes beyond
    the last whole block, in which most effects act, are run by `kernel.follow`: to the same bit, if all of them act.
    """
    count, samples, width = len(parameters), measured.shape[1], kernel.LANES
    X, out = np.empty((count, samples, len(kept))), np.empty((count, samples, len(wanted)))
    alone = count % width if count % width <= ALONE else 0
    alone = alone if (~acting[count - alone :]).sum() <= MOST_ACT * alone * effects else 0
    together = count - alone
    some = np.array([acting[k : k + width].any(axis=0) for k in range(0, together, width)])

    def part(blocks: slice) -> None:
        which = slice(blocks.start * width, min(blocks.stop * width, together))
        given, q = measured if len(measured) == 1 else measured[which], parameters[which]
        how = start, h, stride, parts
        kernel.follow_lanes(given, q, rest[which], inputs, some[blocks], *how, kept, X[which], wanted, out[which])

    if together:
        _share(part, -(-together // width), threads)
    for lane in range(together, count):
        given = measured[min(lane, len(measured) - 1)]
        states, rates = follow_one(kernel, given, inputs, rest[lane], parameters[lane], start, h, stride, parts)
        X[lane], out[lane] = states[:, kept], rates[:, wanted]
        still = [k for k, state in enumerate(kept) if owners[state] >= 0 and not acting[lane, owners[state]]]
        X[lane][:, still] = X[lane][0, still]
    out[:, 0] = out[:, 1] if samples > 1 else 0.0
    return X, out
