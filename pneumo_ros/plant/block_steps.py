"""Parts of a step of a block of lanes that are alike for all effects, copied into every kernel (see `staged`).

cells: the variables of a block, LANES entries each, of which `width` are used. Arguments that are indices of cells
(`begin`, `slope` and so on) stand for the first of a row of states; moves (states,): which states move in this block;
`first`: the first state that is not measured, `last`: the one after the last. They do what `stepping` writes for one
lane, to the bit: where a state has no rate, its rate is 0, and all weights are 1.
"""

from typing import Any

from pneumo_ros.plant.entries import LANES
from pneumo_ros.plant.maths import damped, relaxation


def interpolate(cells: Any, width: int, to: int, begin: int, end: int, count: int, share: float) -> None:
    """`count` measured states, a share of the way from one sample to the next."""
    for i in range(LANES * (count - 1) + width):
        cells[to + i] = cells[begin + i] + share * (cells[end + i] - cells[begin + i])


def half_steps(
    cells: Any, width: int, moves: Any, first: int, last: int, to: int, begin: int, slope: int, rate: int, half: float
) -> None:
    """States after half a step."""
    for k in range(first, last):
        if moves[k]:
            for i in range(LANES * k, LANES * k + width):
                cells[to + i] = cells[begin + i] + half * damped(cells[rate + i] * half) * cells[slope + i]


def kicks(
    cells: Any, width: int, moves: Any, swings: Any, first: int, last: int, to: int, middle: int, begin: int,
    slope: int, rate: int, h: float,
) -> None:  # fmt: skip
    """Velocities after a whole step, and their means over it as states at mid step."""
    for k in range(first, last):
        if moves[k] and swings[k]:
            for i in range(LANES * k, LANES * k + width):
                x, r = cells[begin + i], cells[rate + i]
                after = x + h * damped(r * h) * (cells[slope + i] + r * (cells[middle + i] - x))
                cells[to + i] = after
                cells[middle + i] = 0.5 * (x + after)


def whole_steps(
    cells: Any, width: int, moves: Any, swings: Any, first: int, last: int, to: int, middle: int, begin: int,
    slope: int, rate: int, h: float,
) -> None:  # fmt: skip
    """All other states after a whole step."""
    for k in range(first, last):
        if moves[k] and not swings[k]:
            for i in range(LANES * k, LANES * k + width):
                x, r = cells[begin + i], cells[rate + i]
                cells[to + i] = x + h * relaxation(r * h) * (cells[slope + i] + r * (cells[middle + i] - x))


def add(cells: Any, width: int, moves: Any, first: int, last: int, to: int, slope: int) -> None:
    """Sums of derivatives over steps."""
    for i in range(LANES * (first - 1) + width):
        cells[to + i] += cells[slope + i]
    for k in range(first, last):
        if moves[k]:
            for i in range(LANES * k, LANES * k + width):
                cells[to + i] += cells[slope + i]


def copy(cells: Any, width: int, moves: Any, first: int, last: int, to: int, other: int, given: int) -> None:
    """States into two other rows."""
    for k in range(first, last):
        if moves[k]:
            for i in range(LANES * k, LANES * k + width):
                x = cells[given + i]
                cells[to + i] = x
                cells[other + i] = x
