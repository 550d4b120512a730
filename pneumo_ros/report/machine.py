"""The machine: parameters with units and meanings, and what a refit moved."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.wording import number
from pneumo_ros.plant.machine_file import machine_text
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag

if TYPE_CHECKING:
    from pneumo_ros.plant import Model


def machine_section(model: "Model", refit: dict[str, Any] | None) -> Section:
    """Every parameter the comparison used, the refit where there was one, and the machine file to copy."""
    parts = [tag("p", f"Effects: {', '.join(model.effects)}."), *([_refit(refit)] if refit else []), _parameters(model)]
    text = tag("pre", tag("code", machine_text(model)))
    parts.append(tag("details", tag("summary", "Machine file"), text))
    return Section("machine", "Parameters", Html("".join(parts)))


def _parameters(model: "Model") -> Html:
    rows: list[tuple[Content, ...]] = []
    for name, value in model.parameters.items():
        one = model.specification(name)
        rows.append((name, number(value, 6), one.unit, one.meaning, one.range_text()))
    return table(("parameter", "value", "unit", "meaning", "allowed"), rows, "Parameters of the model", numeric=(1,))


def _refit(refit: dict[str, Any]) -> Html:
    rows: list[tuple[Content, ...]] = []
    for name, one in refit["parameters"].items():
        known = one["determined"] and one["low"] is not None
        interval = f"{number(one['low'], 5)} to {number(one['high'], 5)}" if known else "not determined by the data"
        moved = f"{one['priors_moved']:+.1f}" + (" beyond what was known" if one["moved_beyond_prior"] else "")
        rows.append((name, number(one["before"], 5), number(one["value"], 5), interval, moved, one["unit"]))
    head = ("parameter", "before", "after", "95 % interval", "moved [prior deviations]", "unit")
    return table(head, rows, f"Refitted to {', '.join(refit['runs'])}", numeric=(1, 2))
