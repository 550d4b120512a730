"""Where an error occurs: its size in each regime, its share of the whole, and the worst intervals."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BLOCK = 0.2  # s: the shortest worst interval
_WORST = 3  # intervals named
_HUGE = 1e100  # in any unit
_PRESENT = 0.3  # least share of an interval for which a regime is named with it


@dataclass(frozen=True)
class Share:
    """An error in one regime: rms in its unit and in noise deviations, seconds, and shares of squared error and time.

    Shares of stick and slide add up to 1; a sample in several regimes counts in each.
    """

    rms: float
    ratio_to_noise: float
    share: float
    time_share: float
    seconds: float

    def as_dict(self) -> dict[str, float]:
        """For JSON."""
        return dict(vars(self))


@dataclass(frozen=True)
class Interval:
    """A stretch of large errors, and the regimes that make up at least three tenths of it."""

    start: float  # s
    end: float
    rms: float
    ratio_to_noise: float
    share: float  # of all squared error of the run, in noise deviations
    regimes: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "start_s": self.start, "end_s": self.end, "rms": self.rms, "ratio_to_noise": self.ratio_to_noise,
            "share": self.share, "regimes": list(self.regimes),
        }  # fmt: skip


@dataclass(frozen=True)
class Errors:
    """Errors (n,) [unit] at times (n,) [s] `spacing` [s] apart, their noise (n,), and regime weights (n,), 0 to 1."""

    time: Array
    value: Array
    noise: Array
    spacing: float
    weights: Mapping[str, Array]

    @classmethod
    def of(
        cls, time: Array, value: Array, noise: Array | float, spacing: float, weights: Mapping[str, Array]
    ) -> "Errors":
        """Errors without the entries that are NaN; diverging ones are limited so that their squares can be added."""
        good, value = np.isfinite(value), np.clip(value, -_HUGE, _HUGE)
        level = np.broadcast_to(np.asarray(noise, dtype=float), value.shape)[good]
        return cls(time[good], value[good], level, spacing, {name: w[good] for name, w in weights.items()})


def pooled(parts: list[Errors]) -> Errors:
    """Several runs as one; a regime that a run does not have has weight 0 there."""
    names = dict.fromkeys(name for part in parts for name in part.weights)
    return Errors(
        np.concatenate([p.time for p in parts]),
        np.concatenate([p.value for p in parts]),
        np.concatenate([p.noise for p in parts]),
        parts[0].spacing,
        {n: np.concatenate([p.weights.get(n, np.zeros(len(p.time))) for p in parts]) for n in names},
    )


def by_regime(errors: Errors) -> dict[str, Share]:
    """Shares of every regime that occurs."""
    square, white = np.square(errors.value), np.square(errors.value / errors.noise)
    total, count = float(square.sum()), len(square)
    result = {}
    for name, weight in errors.weights.items():
        present = float(weight.sum())
        if present * errors.spacing < 1e-9 or not total > 0.0:
            continue
        inside = float(weight @ square)
        result[name] = Share(
            rms=float(np.sqrt(inside / present)),
            ratio_to_noise=float(np.sqrt(weight @ white / present)),
            share=inside / total,
            time_share=present / count,
            seconds=present * errors.spacing,
        )
    return result


def worst(errors: Errors, count: int = _WORST) -> list[Interval]:
    """The intervals of largest mean squared error, worst first, grown from blocks of 0.2 s.

    An interval grows over neighbouring blocks while their rms is above half that of its worst block.
    """
    if not len(errors.time):
        return []
    white = np.square(errors.value / errors.noise)
    block = np.floor((errors.time - errors.time[0]) / _BLOCK).astype(np.int64)
    size = np.bincount(block)
    level = np.bincount(block, white) / np.maximum(size, 1)
    left, found = level.copy(), []
    for _ in range(count):
        peak = int(np.argmax(left))
        if not left[peak] > 0.0:
            break
        first, last = _grow(left, peak)
        left[max(first - 1, 0) : last + 2] = 0.0  # blocks beside it belong to the same event
        found.append(_interval(errors, white, (block >= first) & (block <= last)))
    return found


def _grow(level: Array, peak: int) -> tuple[int, int]:
    first = last = peak
    while first > 0 and level[first - 1] > 0.25 * level[peak]:
        first -= 1
    while last + 1 < len(level) and level[last + 1] > 0.25 * level[peak]:
        last += 1
    return first, last


def _interval(errors: Errors, white: Array, inside: NDArray[np.bool_]) -> Interval:
    present = {name: float(weight[inside].mean()) for name, weight in errors.weights.items()}
    named = sorted((name for name in present if present[name] >= _PRESENT), key=lambda name: -present[name])
    half = 0.5 * errors.spacing
    return Interval(
        start=max(float(errors.time[inside][0]) - half, 0.0),
        end=float(errors.time[inside][-1]) + half,
        rms=float(np.sqrt(np.mean(np.square(errors.value[inside])))),
        ratio_to_noise=float(np.sqrt(np.mean(white[inside]))),
        share=float(white[inside].sum() / white.sum()),
        regimes=tuple(named),
    )


def window_share(signal: Array, sample_time: float, centre: Array, width: float) -> Array:
    """Means (m,) of `signal` (n,) over windows of `width` [s] about the times `centre` (m,) [s]."""
    sums = np.concatenate([[0.0], np.cumsum(signal, dtype=float)])
    half = 0.5 * width / sample_time
    first = np.clip(np.rint(centre / sample_time - half).astype(np.int64), 0, len(signal) - 1)
    last = np.clip(np.rint(centre / sample_time + half).astype(np.int64) + 1, first + 1, len(signal))
    return np.asarray((sums[last] - sums[first]) / (last - first))
