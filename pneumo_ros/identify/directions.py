"""One static map for each direction of motion: seals may rub differently in the two directions."""

from collections.abc import Sequence
from typing import Any

from pneumo_ros.errors import DataError
from pneumo_ros.identify.campaign import Identification
from pneumo_ros.identify.friction_map import fit_map

DIRECTIONS = {"extending": 1, "retracting": -1}


def by_direction(found: Identification, free: Sequence[str]) -> dict[str, Any]:
    """Fits of the `free` friction parameters to the points and breakaways of each direction, and their differences.

    Returns plain data: for each direction `points`, `breakaways`, `parameters` (name: value, low, high, unit) and
    `undetermined` (name: sentence); `compared` are the parameters determined in both, `differ` those whose 95 %
    intervals do not overlap. A direction without enough points has a `problem`, a sentence.
    """
    sides: dict[str, Any] = {name: _side(found, sign, free) for name, sign in DIRECTIONS.items()}
    first, second = (side["parameters"] for side in sides.values())
    compared = [name for name in first if name in second]
    apart = [n for n in compared if first[n]["low"] > second[n]["high"] or second[n]["low"] > first[n]["high"]]
    return {**sides, "compared": compared, "differ": apart}


def _side(found: Identification, sign: int, free: Sequence[str]) -> dict[str, Any]:
    points = [p for p in found.points if p.velocity * sign > 0.0]
    breakaways = [b for b in found.breakaways if b.direction == sign]
    side: dict[str, Any] = {"points": len(points), "breakaways": len(breakaways), "parameters": {}, "undetermined": {}}
    if found.segments:
        return side | {"problem": f"there is no static map: {found.why_motion[0].lower()}{found.why_motion[1:]}"}
    try:
        fit = fit_map(found.model, points, breakaways, free)
    except DataError as problem:
        return side | {"problem": str(problem)}
    for name, (low, high) in fit.intervals.items():
        unit = found.model.specification(name).unit
        side["parameters"][name] = {"value": fit.values[name], "low": low, "high": high, "unit": unit}
    return side | {"undetermined": fit.undetermined}
