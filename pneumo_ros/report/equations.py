"""The residual of every equation over the variables it may depend on."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES, amount, percent, times
from pneumo_ros.report.chart import Chart, Panel, Section, Trace
from pneumo_ros.report.markup import tag
from pneumo_ros.wording.naming import listed

Array = NDArray[np.float64]


def equations_section(result: dict[str, Any]) -> Section:
    """A part for every equation; those that noise explains are folded."""
    text = (
        "Residual along the measured signals, all runs together: measured minus model, a force or flow that the "
        "model lacks. Means over bins of each variable, with their 95 % interval where a bin has at least four "
        "separate half seconds; dotted: the scatter of single windows by noise alone; below: the seconds in each bin. "
        "A share is the part of one half of the recordings that the bins of the other half predict, beyond a constant."
    )
    parts = tuple(_equation(name, found) for name, found in result["equations"].items())
    return Section("equations", "Equations", tag("p", text, class_="soft"), parts=parts)


def _equation(name: str, found: dict[str, Any]) -> Section:
    state = {True: "explained by noise", False: "fails", None: "not judged"}[found["explained_by_noise"]]
    size = f"{amount(found['residual_rms'], name)} rms, {times(found['ratio_to_noise'])} noise"
    order = sorted(found["against"], key=lambda variable: -found["against"][variable]["explained_share"])
    constant = max((one["constant_share"] for one in found["against"].values()), default=0.0)
    words = f"{size}. A constant explains {percent(constant)} of the squared residual."
    drawn = [variable for variable in order if len(found["against"][variable]["at"]) > 1]
    if empty := [variable for variable in order if variable not in drawn]:
        words += f" Too few windows for a plot against {listed([VARIABLES[one][0] for one in empty])}."
    return Section(
        f"equation-{name}",
        f"{EQUATIONS[name][0].capitalize()}: {state}",
        tag("p", words if order else f"{size}. Too few windows to look for a dependence."),
        charts=tuple(dependence_chart(name, variable, found["against"][variable]) for variable in drawn),
        folded=found["explained_by_noise"] is not False,
        columns=2,
    )


def dependence_chart(equation: str, variable: str, found: dict[str, Any]) -> Chart:
    """The residual of an equation over bins of a variable; `found` is their entry in the JSON of `compare`."""
    _, unit, factor = EQUATIONS[equation]
    words, x_unit, x_factor = VARIABLES[variable]
    at, mean, low, high, noise, seconds, begin, end = (
        np.array([np.nan if v is None else v for v in found[key]], dtype=float)
        for key in ("at", "mean", "low", "high", "noise", "seconds", "from", "to")
    )
    x, mean, low, high, noise = broken(x_factor * begin, x_factor * end, x_factor * at, mean, low, high, noise)
    traces = (
        Trace("95 % of the mean", "first", "band", x, factor * low, factor * high),
        Trace("mean residual", "first", "line", x, factor * mean),
        Trace("noise of a window", "noise", "line", x, factor * noise),
        Trace("noise of a window", "noise", "line", x, -factor * noise),
    )
    panels = (
        Panel(f"residual [{unit}]", traces, share=2.4),
        Panel("seconds", (coverage(x_factor * begin, x_factor * end, seconds),)),
    )
    share = f"{words.capitalize()} explains {percent(found['explained_share'])} of the squared residual."
    return Chart(
        f"{equation}-{variable}", f"Against {words}", share, f"{words} [{x_unit}]", panels, height=300, legend=False
    )


def broken(begin: Array, end: Array, x: Array, *columns: Array) -> list[Array]:
    """x and the columns with a NaN between bins that do not touch, where there are no data."""
    apart = np.flatnonzero(begin[1:] > end[:-1] + 1e-9 * np.ptp(x)) + 1 if len(x) else np.empty(0, dtype=np.int64)
    middle = 0.5 * (end[apart - 1] + begin[apart])
    return [np.insert(x, apart, middle), *(np.insert(column, apart, np.nan) for column in columns)]


def coverage(begin: Array, end: Array, seconds: Array) -> Trace:
    """A block over every bin, nothing between bins."""
    x = np.stack([begin, begin, end, end], axis=1).ravel()
    y = np.stack([0.0 * seconds, seconds, seconds, 0.0 * seconds], axis=1).ravel()
    return Trace("coverage", "quiet", "area", x, y)
