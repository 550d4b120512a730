"""Where a piston crosses the play before its sensor, which rests meanwhile: what the reading tells of it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.smooth import HALF_WIDTH, smooth

Array = NDArray[np.float64]

_NEAR = 3.0  # deviations of single readings: a mean reading within so many of its extreme rests
_MOVES = 4.0  # deviations of single readings from where it rested, beyond which a sensor has moved
_FAR = 40.0  # deviations of single readings: over so much way its velocity is read
_FEWEST, _LONG = 6, 0.2  # samples and s of that way


@dataclass(frozen=True)
class Crossing:
    """A sensor comes to rest at `begin`, and at `end` (samples) is taken along in a `direction` at `speed`."""

    begin: int
    end: float
    direction: float
    speed: float  # [unit of the reading / sample], of the piston that takes up its play; infinite: not known


def crossings(reading: Array, sample_time: float, noise: float, rests: NDArray[np.bool_]) -> list[Crossing]:
    """Where a reading (n,) begins to move the other way, first from its start, or goes on after one of its `rests`.

    noise: deviation of single samples; rests (n,): where the sensor is known to rest.
    """
    smoothed = smooth(reading, sample_time, HALF_WIDTH, 1)  # a mean: a parabola swings back before each kink
    near = _NEAR * noise
    found = [
        _crossing(reading, smoothed, near, at, direction, noise, sample_time)
        for at, direction in _reversals(smoothed, near)
    ]
    for at in _middles(rests):
        far = np.flatnonzero(np.abs(smoothed[at:] - smoothed[at]) > near)
        if len(far) and not any(one.begin <= at <= one.end for one in found):
            direction = float(np.sign(smoothed[at + far[0]] - smoothed[at]))
            found.append(_crossing(reading, smoothed, near, at, direction, noise, sample_time))
    return sorted(found, key=lambda one: one.end)


def _middles(rests: NDArray[np.bool_]) -> list[int]:
    """The middle of each stretch of `rests` (n,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rests, [False]]).astype(int)))
    return [int(first + last) // 2 for first, last in edges.reshape(-1, 2)]


def play_of(found: list[Crossing], width: float, bent: Array, most: float) -> Array:
    """How far (n,) the piston is from the middle of a play of this width.

    bent (n,): how far its bristles are at rest, `most` where it stops. While the sensor rests, its reading fits any way
    of the piston within the play. A piston that rests gives way as its bristles do. Then it slips, and takes the sensor
    along at the speed v at which that goes on: the least that can is a constant acceleration, by which a way g is
    crossed in 2 g / v before.
    """
    half, side, last = 0.5 * width, 0.0, 0
    play = np.zeros(len(bent))
    for one in found:
        first, end = max(one.begin, last), min(math.ceil(one.end), len(bent))
        play[last:first] = side
        rows, after = np.arange(first, end), half * one.direction
        stopped = most * np.sign(side) if side else bent[min(first, len(bent) - 1)]
        rested = np.clip(side + bent[first:end] - stopped, -half, half)
        way = abs(after - float(rested[-1])) if len(rested) else abs(after - side)
        lasts = min(2.0 * way / one.speed, one.end - one.begin)
        share = np.clip((rows - (one.end - lasts)) / max(lasts, 1e-9), 0.0, 1.0)
        slips = rested[np.argmax(share > 0.0)] if len(rested) else side
        play[first:end] = np.where(share > 0.0, slips + (after - slips) * share**2, rested)
        side, last = after, max(end, last)
    play[last:] = side
    return play


def _reversals(smoothed: Array, near: float) -> list[tuple[int, float]]:
    """Extremes, as a sample and the direction (1 or -1) in which the signal then goes farther than `near`."""
    turns = np.flatnonzero(np.diff(np.sign(np.diff(smoothed)))) + 1
    found, direction, low, high = list[tuple[int, float]](), 0.0, 0, 0
    for i in (*turns.tolist(), len(smoothed) - 1):
        low, high = (i if smoothed[i] < smoothed[low] else low), (i if smoothed[i] > smoothed[high] else high)
        if direction >= 0.0 and smoothed[high] - smoothed[i] > near:
            found.append((high, -1.0))
            direction, low = -1.0, i
        elif direction <= 0.0 and smoothed[i] - smoothed[low] > near:
            found.append((low, 1.0))
            direction, high = 1.0, i
    return found


def _crossing(
    reading: Array, smoothed: Array, near: float, at: int, direction: float, noise: float, sample_time: float
) -> Crossing:
    """The crossing of which the reading tells around an extreme `at` a sample."""
    away = np.abs(smoothed - smoothed[at]) > near
    before, after = np.flatnonzero(away[:at]), np.flatnonzero(away[at:])
    begin = int(before[-1]) + 1 if len(before) else 0
    leaves = at + int(after[0]) if len(after) else len(reading) - 1
    blurred = round(HALF_WIDTH / sample_time)
    level = float(np.mean(reading[begin : max(leaves - blurred, at, begin + 1)]))
    way = direction * (reading - level)
    longest = leaves + blurred + round(_LONG / sample_time)
    still = np.flatnonzero(way[at : leaves + blurred] < _MOVES * noise)
    first = at + int(still[-1]) + 1 if len(still) else leaves
    far = np.flatnonzero(way[first:longest] > _FAR * noise)
    last = first + max(int(far[0]) if len(far) else longest - first, _FEWEST)
    rows = np.arange(first, min(last, len(reading)))
    if len(rows) < _FEWEST:  # at the end of the recording
        return Crossing(begin, first, direction, np.inf)
    curve, slope, here = np.polyfit(rows - first, way[rows], 2)
    if slope <= 0.0 or slope**2 <= 4.0 * curve * here:  # from rest, as it seems: with the mean velocity
        curve, (slope, here) = 0.0, np.polyfit(rows - first, way[rows], 1)
    if slope <= 0.0:
        return Crossing(begin, first, direction, np.inf)
    speed = float(np.sqrt(slope**2 - 4.0 * curve * here))
    return Crossing(begin, max(first - 2.0 * here / (slope + speed), float(begin)), direction, speed)
