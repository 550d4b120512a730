"""Every parameter of a refit, and those of the model itself that moved far beyond their priors."""

import math
from collections.abc import Mapping
from typing import Any

from pneumo_ros.compare.moved import BEYOND
from pneumo_ros.compare.wording import number
from pneumo_ros.wording.naming import interval, listed
from pneumo_ros.wording.table import Table


def moved_sentence(refit: Mapping[str, Any]) -> str:
    """Which parameters moved; `refit` is the part of that name in the JSON of a verb."""
    beyond = f"more than {BEYOND:g} standard deviations from what was known before"
    if not refit["moved"]:
        return f"The refit moved no parameter {beyond}."
    which = "this parameter" if len(refit["moved"]) == 1 else "these parameters"
    return f"The refit moved {which} {beyond}: {listed(refit['moved'])}."


def moved_table(refit: Mapping[str, Any]) -> Table | None:
    """A row for each parameter that moved; None where none did."""
    rows = []
    for name in refit["moved"]:
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
