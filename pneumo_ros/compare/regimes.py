"""Regimes of a motion, as masks on the grid of a run: from the measured signals and the model's parameters alone.

A sample may be in several regimes. Stick and slide together cover all samples once; the others overlap.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.along import Along

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

SHORTEST_REST = 0.02  # s: a shorter stop is a velocity passing through zero
REVERSAL = 0.05  # s before and after the change of direction
LONGEST_STOP = 0.2  # s: a longer stop is a rest that ends with a breakaway
BREAKAWAY = (0.02, 0.1)  # s before and after a rest ends
NEAR_STOP = 0.02  # of the stroke
NEAR_NULL = 0.1  # V of opening beyond the dead zone
NO_FLOW = 0.02  # of the run's largest flow

MEANING = {
    "stick": "the piston rests: its velocity cannot be distinguished from zero for 20 ms or longer",
    "breakaway": "from 20 ms before to 100 ms after a rest ends",
    "slide": "the piston moves: all that is not stick",
    "reversal": "50 ms around a change of direction with less than 0.2 s of rest in it",
    "near_end_stop": "within 2 % of the stroke from either end",
    "filling_a": "the model's valve lets more than 2 % of its largest flow into chamber a",
    "exhausting_a": "the model's valve lets more than 2 % of its largest flow out of chamber a",
    "filling_b": "the model's valve lets more than 2 % of its largest flow into chamber b",
    "exhausting_b": "the model's valve lets more than 2 % of its largest flow out of chamber b",
    "valve_near_null": "the valve is inside its dead zone or opened by less than 0.1 V beyond",
}


def regimes(motion: Along) -> dict[str, Mask]:
    """Masks (n,) by name, in the order of `MEANING`; those of valve and chambers only where the model has them."""
    rest = _rest(motion)
    masks = {
        "stick": rest,
        "breakaway": _breakaway(motion, rest),
        "slide": ~rest,
        "reversal": _reversal(motion),
        "near_end_stop": np.abs(motion.run.position) > motion.reach * (1.0 - 2.0 * NEAR_STOP),
    }
    for chamber in motion.chambers:
        if chamber.flow in motion.seen:
            flow = motion.seen[chamber.flow]
            limit = NO_FLOW * float(np.max(np.abs(flow), initial=0.0))
            masks[f"filling_{chamber.side}"], masks[f"exhausting_{chamber.side}"] = flow > limit, flow < -limit
    if "opening" in motion.seen:
        masks["valve_near_null"] = np.abs(motion.seen["opening"]) <= NEAR_NULL
    return masks


def _rest(motion: Along) -> Mask:
    """Slow for long enough."""
    slow = np.abs(motion.velocity) < motion.rest_below
    begin, end = stretches(slow)
    result = np.zeros(len(slow), dtype=bool)
    for b, e in zip(begin, end, strict=True):
        result[b:e] = (e - b) * motion.run.sample_time >= SHORTEST_REST
    return result


def _breakaway(motion: Along, rest: Mask) -> Mask:
    before, after = (round(span / motion.run.sample_time) for span in BREAKAWAY)
    _, end = stretches(rest)
    return _around(len(rest), end[end < len(rest)], before, after)


def _reversal(motion: Along) -> Mask:
    """Around pairs of neighbouring sliding samples with opposite directions."""
    direction = _direction(motion)
    sliding = np.flatnonzero(direction)
    turns = np.flatnonzero(direction[sliding[1:]] != direction[sliding[:-1]])
    begin, end = sliding[turns], sliding[turns + 1]
    short = (end - begin) * motion.run.sample_time <= LONGEST_STOP
    reach = round(REVERSAL / motion.run.sample_time)
    result = np.zeros(len(direction), dtype=bool)
    for b, e in zip(begin[short], end[short], strict=True):
        result[max(b - reach, 0) : e + reach] = True
    return result


def _direction(motion: Along) -> Array:
    """1, -1 or 0; a direction kept for less than 20 ms is the filter's response to a sudden stop, and counts as 0."""
    result = np.zeros(len(motion.velocity))
    for sign in (1.0, -1.0):
        begin, end = stretches(sign * motion.velocity >= motion.rest_below)
        for b, e in zip(begin, end, strict=True):
            if (e - b) * motion.run.sample_time >= SHORTEST_REST:
                result[b:e] = sign
    return result


def _around(samples: int, at: NDArray[np.int64], before: int, after: int) -> Mask:
    result = np.zeros(samples, dtype=bool)
    for k in at:
        result[max(k - before, 0) : k + after] = True
    return result


def stretches(mask: Mask) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where the true stretches of a mask (n,) begin, and where they end (exclusive)."""
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
