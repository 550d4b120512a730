"""What changed from campaign to campaign: parameters beyond what their intervals allow, effects that appeared."""

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import Any

Examined = dict[str, Any]  # machine, campaign, date, and the result of `examine`

ALARM = 0.01  # chance that anything is said to drift in a fleet where nothing does
MATERIAL = 0.01  # of a value: intervals hold the noise of sensors, not how well a machine repeats itself
_NORMAL = 1.96


def history(campaigns: Sequence[Examined]) -> list[dict[str, Any]]:
    """A machine each: its parameters over time, what drifted and since when, which effect appeared when.

    campaigns: in the order of time. A parameter drifted when it left its first interval by more than chance explains,
    over all that is compared in the fleet (Bonferroni), and by more than MATERIAL of its value, and stayed away.
    """
    machines: dict[str, list[Examined]] = {}
    for one in campaigns:
        machines.setdefault(one["machine"], []).append(one)
    compared = sum(max(len(points) - 1, 0) for ours in machines.values() for points in _tracks(ours).values())
    limit = NormalDist().inv_cdf(1.0 - 0.5 * ALARM / max(compared, 1))
    return [_machine(name, ours, limit) for name, ours in machines.items()]


def _machine(name: str, ours: Sequence[Examined], limit: float) -> dict[str, Any]:
    tracks = _tracks(ours)
    drifted = {key: moved for key, points in tracks.items() if (moved := drift(points, limit))}
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


def drift(points: Sequence[dict[str, Any]], limit: float) -> dict[str, Any] | None:
    """How a parameter left its first value, and since when; None when it did not, beyond `limit` deviations."""
    first, away = points[0], None
    for point in points[1:]:
        gone = _left(first, point, limit)
        away = (away or point) if gone else None
    if away is None:
        return None
    last = points[-1]
    return {
        "since": away["campaign"], "date": away["date"], "first": first["value"], "last": last["value"],
        "low": last["low"], "high": last["high"], "unit": last["unit"],
        "deviations": abs(last["value"] - first["value"]) / _spread(first, last),
    }  # fmt: skip


def _left(first: dict[str, Any], point: dict[str, Any], limit: float) -> bool:
    change = abs(point["value"] - first["value"])
    return bool(change > limit * _spread(first, point) and change > MATERIAL * abs(first["value"]))


def _spread(first: dict[str, Any], point: dict[str, Any]) -> float:
    """Standard deviation of a difference."""
    halves = [0.5 * (one["high"] - one["low"]) / _NORMAL for one in (first, point)]
    return max(math.hypot(*halves), 1e-300)


def since(effect: str, ours: Sequence[Examined]) -> dict[str, Any]:
    """From which campaign on a machine has an effect: in all that were diagnosed, or only in some (`steady` false).

    An effect that another one explains as well counts as there when that one was found.
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
