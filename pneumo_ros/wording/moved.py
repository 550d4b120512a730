"""Every parameter of a refit, and those of the model itself that moved far beyond their priors, or clearly within."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from pneumo_ros.compare.moved import BEYOND
from pneumo_ros.compare.wording import number
from pneumo_ros.wording.naming import interval, listed
from pneumo_ros.wording.table import Table

CHANGED = 0.1  # of a parameter: less matters little


def moved_sentence(refit: Mapping[str, Any], added: Collection[str] = ()) -> str:
    """Which parameters moved; `refit` is the part of that name in the JSON of a verb, `added` the effects it added."""
    beyond = f"more than {BEYOND:g} standard deviations from what was known before"
    within = changed(refit, added)
    further = (
        f" Within what the machine file leaves open, it changed {listed(within)} by {CHANGED:.0%} or more."
        if within
        else ""
    ).replace("%", " %")
    if not refit["moved"]:
        return f"The refit moved no parameter {beyond}.{further}"
    which = "this parameter" if len(refit["moved"]) == 1 else "these parameters"
    return f"The refit moved {which} {beyond}: {listed(refit['moved'])}.{further}"


def changed(refit: Mapping[str, Any], added: Collection[str] = ()) -> list[str]:
    """Parameters that changed by `CHANGED` and clearly, though their priors allow it: a worn machine's friction.

    A machine file that leaves a parameter open makes its prior wide, and no change of it is improbable.
    """
    found = []
    for name, one in refit["parameters"].items():
        distance = abs(one["value"] - one["before"])
        clear = one["std"] is not None and distance > max(BEYOND * one["std"], CHANGED * abs(one["before"]))
        if clear and one["before"] != 0.0 and name.partition(".")[0] not in added and name not in refit["moved"]:
            found.append(name)
    return found


def moved_table(refit: Mapping[str, Any], added: Collection[str] = ()) -> Table | None:
    """A row for each parameter that moved or changed; None where none did."""
    rows = []
    for name in (*refit["moved"], *changed(refit, added)):
        one = refit["parameters"][name]
        span = interval(one["value"], math.inf if one["std"] is None else one["std"])
        unit = "" if one["unit"] == "1" else one["unit"]
        rows.append((name, number(one["before"], 5), number(one["value"], 5), span, unit))
    head = ("Moved", "before", "after", "95 % interval", "unit")
    return Table("", head, tuple(rows), (1, 2)) if rows else None


def refit_table(refit: Mapping[str, Any]) -> Table:
    """A row for each parameter of a refit."""
    rows = []
    for name, one in refit["parameters"].items():
        span = interval(one["value"], math.inf if one["std"] is None else one["std"])
        moved = f"{one['priors_moved']:+.1f}" + (" !" if one["moved_beyond_prior"] else "")
        rows.append((name, number(one["before"], 5), number(one["value"], 5), span, moved, one["unit"]))
    head = ("parameter", "before", "after", "95 % interval", "moved [prior deviations]", "unit")
    return Table(f"Refitted to {', '.join(refit['runs'])}", head, tuple(rows), (1, 2, 4))
