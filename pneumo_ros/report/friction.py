"""The friction map: measured friction force over velocity, both directions, with the model's."""

from typing import Any

import numpy as np

from pneumo_ros.compare.wording import number
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.markup import tag
from pneumo_ros.units import shown

_ROLES: dict[str, Role] = {"extending": "first", "retracting": "second"}


def friction_section(result: dict[str, Any]) -> tuple[Section, ...]:
    """The map of all sliding in all runs; nothing without sliding."""
    directions = result["friction_map"]["directions"]
    if not directions:
        return ()
    text = (
        "Friction force by Newton's law from the measured signals (drive - load - mass x acceleration, weak form over "
        "100 ms) while the piston slides one way, with the 95 % interval of each mean. Lines: the model's friction in "
        "the same windows. Retracting is shown with both signs turned."
    )
    return (Section("friction", "Friction map", tag("p", text, class_="soft"), charts=(_chart(directions),)),)


def _chart(directions: dict[str, Any]) -> Chart:
    force: list[Trace] = []
    gap: list[Trace] = []
    said = []
    for name, found in directions.items():
        columns = [found[key] for key in ("velocity", "force", "low", "high", "model")]
        v, f, low, high, model = (
            np.array([np.nan if x is None else x for x in column], dtype=float) for column in columns
        )
        role = _ROLES[name]
        force += [
            Trace(f"{name}, 95 %", role, "band", v, low, high),
            Trace(f"{name}, measured", role, "dots", v, f),
            Trace(f"{name}, model", role, "line", v, model),
        ]
        gap += [Trace(f"{name}, 95 %", role, "band", v, low - model, high - model),
                Trace(f"{name}, measured", role, "dots", v, f - model)]  # fmt: skip
        worst = int(np.nanargmax(np.abs(f - model)))
        said.append(
            f"{name} by up to {number(f[worst] - model[worst])} {shown('N')} at {number(v[worst])} {shown('m/s')}"
        )
    panels = (
        Panel(f"friction force [{shown('N')}]", tuple(force), share=1.5),
        Panel(f"measured - model [{shown('N')}]", tuple(gap)),
    )
    words = f"Measured differs from the model {', '.join(said)}."
    return Chart(
        "friction-map", "Friction over velocity", words, f"speed [{shown('m/s')}]", panels, log_x=True, height=480
    )
