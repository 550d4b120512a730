"""The machine: parameters with units and meanings, and what a refit moved."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.wording import number
from pneumo_ros.plant.machine_file import machine_text
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag, worded
from pneumo_ros.wording.moved import refit_table

if TYPE_CHECKING:
    from pneumo_ros.plant import Model


def machine_section(model: "Model", refit: dict[str, Any] | None) -> Section:
    """Every parameter the comparison used, the refit where there was one, and the machine file to copy."""
    parts = [
        tag("p", f"Effects: {', '.join(model.effects)}."),
        *([worded(refit_table(refit))] if refit else []),
        _parameters(model),
    ]
    text = tag("pre", tag("code", machine_text(model)))
    parts.append(tag("details", tag("summary", "Machine file"), text))
    return Section("machine", "Parameters", Html("".join(parts)))


def _parameters(model: "Model") -> Html:
    rows: list[tuple[Content, ...]] = []
    for name, value in model.parameters.items():
        one = model.specification(name)
        rows.append((name, number(value, 6), one.unit, one.meaning, one.range_text()))
    return table(("parameter", "value", "unit", "meaning", "allowed"), rows, "Parameters of the model", numeric=(1,))
