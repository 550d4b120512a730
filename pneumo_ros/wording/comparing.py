"""A comparison on one page, from the JSON of `compare`: what fails, where, with what it goes, and what to do next."""

from collections.abc import Mapping
from typing import Any, Literal

from pneumo_ros.compare.findings import explained, findings
from pneumo_ros.compare.wording import TARGETS
from pneumo_ros.wording.table import Table

Step = Literal["diagnose", "refit", "use"]
_KINDS = ("where", "follows")  # of a finding's details
NEXT: dict[Step, str] = {
    "diagnose": "Noise does not explain the error: parameters are off, or the model lacks a physical effect. "
    "Let every effect of the catalogue be tried, refitted, and judged by recordings that are not fitted.",
    "refit": "The equations hold along the measured signals, but predictions drift: refit the parameters.",
    "use": "The model explains these recordings: use it.",
}


def failing_table(result: Mapping[str, Any]) -> Table:
    """A row for each equation and signal that noise does not explain, and for each that could not be judged."""
    rows = []
    for one in findings(result):
        if one.level != "good":
            said = dict(detail.split(": ", 1) for detail in one.details)
            rows.append((TARGETS[one.target][0], one.verdict, *(said.get(kind, "-") for kind in _KINDS)))
    return Table("", ("what", "how much", "in which regime", "follows"), tuple(rows))


def next_step(result: Mapping[str, Any]) -> Step:
    """What this result asks for."""
    if any(one["explained_by_noise"] is False for one in result["equations"].values()):
        return "diagnose"
    if explained(result):
        return "use"
    return "diagnose" if "refit" in result else "refit"
