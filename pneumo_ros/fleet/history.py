"""Changes from campaign to campaign: parameters that left their intervals, effects that appeared."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from statistics import NormalDist, median
from typing import Any

Examined = dict[str, Any]  # machine, campaign, date, and the result of `examine`

ALARM = 0.01  # probability of any false alarm in a fleet without drift
MATERIAL = 0.03  # of a value: an unchanged machine repeats its friction no better (EMPS: 3 %)
ENOUGH = 8  # fewest changes from campaign to campaign, over the fleet, that show the scatter of machines
_NORMAL, _MAD = 1.96, 1.4826  # deviations: of half a 95 % interval, and of a median of magnitudes


def history(campaigns: Sequence[Examined]) -> list[dict[str, Any]]:
    """For each machine: parameters over time, drifts and their start, effects and their first campaign.

    campaigns: in the order of time. A parameter drifted when it left its first value significantly (Bonferroni over all
    comparisons in the fleet) and by more than MATERIAL of it, and stayed away. The standard deviation includes the
    intervals and the scatter of the fleet's machines from campaign to campaign beyond them.
    """
    machines: dict[str, list[Examined]] = {}
    for one in campaigns:
        machines.setdefault(one["machine"], []).append(one)
    tracks = {name: _tracks(ours) for name, ours in machines.items()}
    compared = sum(max(len(points) - 1, 0) for mine in tracks.values() for points in mine.values())
    limit = NormalDist().inv_cdf(1.0 - 0.5 * ALARM / max(compared, 1))
    keys = {key for mine in tracks.values() for key in mine}
    scatter = {key: unrepeated([mine[key] for mine in tracks.values() if key in mine]) for key in keys}
    return [_machine(name, ours, tracks[name], limit, scatter) for name, ours in machines.items()]


def unrepeated(tracks: Sequence[Sequence[dict[str, Any]]]) -> float:
    """Scatter of one parameter from campaign to campaign beyond its intervals: a relative standard deviation.

    From the median of all successive changes, which drifts or jumps of some machines do not affect; 0 with fewer than
    ENOUGH.
    """
    pairs = [pair for points in tracks for pair in pairwise(points)]
    if len(pairs) < ENOUGH:
        return 0.0
    sizes = [max(abs(first["value"]), abs(second["value"]), 1e-300) for first, second in pairs]
    changes = [abs(second["value"] - first["value"]) / size for (first, second), size in zip(pairs, sizes, strict=True)]
    known = [_spread(first, second) / size for (first, second), size in zip(pairs, sizes, strict=True)]
    return math.sqrt(max((_MAD * median(changes)) ** 2 - median(known) ** 2, 0.0) / 2.0)


def _machine(
    name: str,
    ours: Sequence[Examined],
    tracks: Mapping[str, Sequence[dict[str, Any]]],
    limit: float,
    scatter: Mapping[str, float],
) -> dict[str, Any]:
    drifted = {key: moved for key, points in tracks.items() if (moved := drift(points, limit, scatter[key]))}
    effects = {effect: since(effect, ours) for one in ours for effect in _names(one)}
    return {
        "machine": name,
        "campaigns": [{key: one[key] for key in ("campaign", "date", "verdict", "problem")} for one in ours],
        "parameters": tracks,
        "drifted": drifted,
        "effects": effects,
    }


def _tracks(ours: Sequence[Examined]) -> dict[str, list[dict[str, Any]]]:
    """Values with intervals over time, by parameter."""
    tracks: dict[str, list[dict[str, Any]]] = {}
    for one in ours:
        for name, known in one["parameters"].items():
            tracks.setdefault(name, []).append({"campaign": one["campaign"], "date": one["date"], **known})
    return tracks


def drift(points: Sequence[dict[str, Any]], limit: float, scatter: float = 0.0) -> dict[str, Any] | None:
    """Drift of a parameter from its first value, and its start; None within `limit` deviations.

    scatter: from campaign to campaign, relative, beyond intervals; see `unrepeated`.
    """
    first, away = points[0], None
    for point in points[1:]:
        gone = _left(first, point, limit, scatter)
        away = (away or point) if gone else None
    if away is None:
        return None
    last = points[-1]
    return {
        "since": away["campaign"], "date": away["date"], "first": first["value"], "last": last["value"],
        "low": last["low"], "high": last["high"], "unit": last["unit"],
        "deviations": abs(last["value"] - first["value"]) / _spread(first, last, scatter),
    }  # fmt: skip


def _left(first: dict[str, Any], point: dict[str, Any], limit: float, scatter: float) -> bool:
    change = abs(point["value"] - first["value"])
    return bool(change > limit * _spread(first, point, scatter) and change > MATERIAL * abs(first["value"]))


def _spread(first: dict[str, Any], point: dict[str, Any], scatter: float = 0.0) -> float:
    """Standard deviation of a difference."""
    halves = [0.5 * (one["high"] - one["low"]) / _NORMAL for one in (first, point)]
    return max(math.hypot(*halves, *(scatter * one["value"] for one in (first, point))), 1e-300)


def since(effect: str, ours: Sequence[Examined]) -> dict[str, Any]:
    """First campaign in which a machine has an effect; `steady` is false if a later diagnosed campaign lacks it.

    An effect also counts as present when one of its rivals was found.
    """
    judged = [one for one in ours if one["verdict"] is not None]
    there = [effect in _names(one) for one in judged]
    begin = there.index(True)
    return {
        "since": judged[begin]["campaign"], "date": judged[begin]["date"], "from_the_start": begin == 0,
        "steady": all(there[begin:]), "campaigns": sum(there),
    }  # fmt: skip


def _names(one: Examined) -> list[str]:
    """Effects found in a campaign, and those that explain as much."""
    return [name for added in one["added"] for name in (added["effect"], *added["rivals"])]
