"""The identified static map, friction force over velocity, with the residuals below (as the paper's Fig. 4)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import number
from pneumo_ros.report.chart import Chart, Panel, Section, Trace
from pneumo_ros.report.markup import tag
from pneumo_ros.units import shown
from pneumo_ros.wording.identification import before_and_after

Array = NDArray[np.float64]


def static_map_section(result: dict[str, Any]) -> Section:
    """Points, curves and residuals of an identification's JSON."""
    words = (
        f"Each dot is a window of {result['map']['window_s']:g} s of steady motion: mean velocity, and the friction "
        "force from the pressures there (drive - load - mass x acceleration). The line is the friction of the "
        "identified model at constant velocity, the dotted line is that of the machine file before."
    )
    return Section("static-map", "Static friction map", tag("p", words, class_="soft"), charts=(_chart(result),))


def _chart(result: dict[str, Any]) -> Chart:
    velocity, residual, spread = _arrays(result["map"]["points"], "velocity", "residual", "residual_std")
    order = np.argsort(velocity)
    below = (
        Trace("noise, 95 %", "quiet", "band", velocity[order], -1.96 * spread[order], 1.96 * spread[order]),
        Trace("measured - identified", "measured", "dots", velocity, residual),
    )
    panels = (_friction_panel(result), Panel(f"residual [{shown('N')}]", below))
    said = (
        f"{len(velocity)} windows at {number(np.abs(velocity).min())} to "
        f"{number(np.abs(velocity).max())} {shown('m/s')}; "
        f"residuals {number(result['map']['residual_rms_n'])} {shown('N')} rms."
    )
    return Chart("static-map", "Friction over velocity", said, f"velocity [{shown('m/s')}]", panels, height=560)


def before_after_chart(result: dict[str, Any]) -> Chart:
    """Friction alone, as low as the first page has room for: measured, before and identified."""
    words = before_and_after(result["map"])
    panels = (_friction_panel(result),)
    return Chart("before-after", "Friction before and after", words, f"velocity [{shown('m/s')}]", panels, height=280)


def _friction_panel(result: dict[str, Any]) -> Panel:
    """Points, the curves of the machine file before and of the identified model, and breakaways."""
    breaks = result["breakaways"]
    at, model, before = _arrays(result["map"]["curve"], "velocity", "friction", "before")
    velocity, force = _arrays(result["map"]["points"], "velocity", "force")
    traces = [
        Trace("before", "noise", "line", at, before),
        Trace("identified", "model", "line", at, model),
        Trace("measured", "measured", "dots", velocity, force),
    ]
    if breaks:
        level = np.array([b["direction"] * b["force_n"] for b in breaks])
        traces.append(Trace("breakaways, at rest", "second", "dots", np.zeros(len(breaks)), level))
    return Panel(f"friction force [{shown('N')}]", tuple(traces), share=2.0)


def _arrays(found: dict[str, Any], *keys: str) -> list[Array]:
    return [np.array(found[key], dtype=float) for key in keys]
