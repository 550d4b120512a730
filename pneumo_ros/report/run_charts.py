"""The charts of one run over time, which zoom together: signals, equations, input and regimes."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.regimes import stretches
from pneumo_ros.compare.wording import EQUATIONS, REGIMES, SIGNALS, amount, percent, times
from pneumo_ros.report.chart import Chart, Panel, Role, Trace
from pneumo_ros.report.series import extremes
from pneumo_ros.units import shown

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import RunComparison

Array = NDArray[np.float64]

_FINER = 5.0  # the series are stored this much finer than their noise
_ROLES: dict[str, Role] = {"fill": "third", "exha": "third", "valv": "second"}  # by the first letters of a regime


def run_charts(run: "RunComparison", link: str, bucket: int) -> tuple[Chart, ...]:
    """A chart for every signal, one for the equations, one for input and regimes.

    Charts of one `link` zoom together; two samples of every `bucket` are kept (`series.extremes`).
    """
    signals = (_signal_chart(run, name, link, bucket) for name in run.error)
    return (*signals, _residual_chart(run, link), _regime_chart(run, link))


def _signal_chart(run: "RunComparison", name: str, link: str, bucket: int) -> Chart:
    words, unit, factor = SIGNALS[name]
    grid, found = run.motion.run, run.error[name]
    kept = extremes(run.predicted[name].astype(float), bucket)
    time, measured = grid.time[kept], factor * np.where(grid.measured, (grid.signals | grid.judged)[name], np.nan)[kept]
    error, free = (factor * series[name][kept].astype(float) for series in (run.predicted, run.free_errors))
    fine, level = factor * found.noise / _FINER, factor * found.noise
    ends = time[[0, -1]]
    top = Panel(f"{words} [{unit}]", (
        Trace("measured", "measured", "line", time, measured, resolution=fine),
        Trace("model", "model", "line", time, measured + error, resolution=fine),
        Trace("free run", "free", "line", time, measured + free, resolution=fine, hidden=True),
    ), share=1.6)  # fmt: skip
    bottom = Panel(f"error [{unit}]", (
        Trace("error", "error", "line", time, error, resolution=fine),
        Trace("2 x noise", "noise", "line", ends, np.array([2.0 * level] * 2)),
        Trace("2 x noise", "noise", "line", ends, np.array([-2.0 * level] * 2)),
    ))  # fmt: skip
    size = f"{amount(found.rms, name)} rms, {times(found.ratio)} the noise of {amount(found.noise, name)}"
    text = f"Error, model minus measured: {size}."
    return Chart(
        f"{link}-{name}",
        f"{run.name}: {words}",
        text,
        "time [s]",
        (top, bottom),
        link=link,
        span=(0.0, run.duration),
        height=430,
    )


def _residual_chart(run: "RunComparison", link: str) -> Chart:
    panels, said = [], []
    for name, residual in run.residuals.items():
        words, unit, factor = EQUATIONS[name]
        time, value, noise = _broken(residual.time, factor * residual.value, factor * residual.noise)
        fine = float(np.nanmedian(noise)) / _FINER if len(noise) else 1.0
        panels.append(Panel(f"{words} [{unit}]", (
            Trace("residual", "error", "line", time, value, resolution=fine),
            Trace("2 x noise", "noise", "line", time, 2.0 * noise, resolution=0.02 * fine),
            Trace("2 x noise", "noise", "line", time, -2.0 * noise, resolution=0.02 * fine),
        )))  # fmt: skip
        said.append(f"{words} {times(run.equations[name].ratio_to_noise)}")
    words = f"Measured minus model, along the measured signals; over noise: {', '.join(said)}."
    height = 100 + 130 * len(panels)
    return Chart(
        f"{link}-residuals",
        f"{run.name}: equations",
        words,
        "time [s]",
        tuple(panels),
        link=link,
        span=(0.0, run.duration),
        height=height,
    )


def _broken(time: Array, value: Array, noise: Array) -> tuple[Array, Array, Array]:
    """With a NaN after every stretch, so that no line is drawn where nothing was judged."""
    steps = np.diff(time)
    if not len(steps):
        return time, value, noise
    hop = float(steps.min())
    after = np.flatnonzero(steps > 1.5 * hop) + 1
    value, noise = (np.insert(column, after, np.nan) for column in (value, noise))
    return np.insert(time, after, time[after - 1] + hop), value, noise


def _regime_chart(run: "RunComparison", link: str) -> Chart:
    grid = run.motion.run
    words, unit = ("driving force", shown("N")) if grid.force_driven else ("valve voltage", "V")
    names = [name for name in REGIMES if name in run.masks and run.masks[name].any()]
    spans = []
    for row, name in enumerate(names):
        begin, end = stretches(run.masks[name])
        x = np.stack([begin, end, end], axis=1).astype(np.float64) * grid.sample_time
        y = np.tile([row, row, np.nan], len(begin)).astype(float)
        spans.append(Trace(REGIMES[name], _ROLES.get(name[:4], "first"), "spans", x.ravel(), y))
    ticks = tuple(REGIMES[name] for name in names)
    drive = Trace(words, "measured", "steps", grid.time, run.motion.input, resolution=1e-4 * _span(run.motion.input))
    shares = ", ".join(f"{REGIMES[n]} {percent(float(run.masks[n].mean()))}" for n in names)
    panels = (Panel(f"{words} [{unit}]", (drive,)), Panel("", tuple(spans), ticks=ticks, share=0.3 + 0.2 * len(ticks)))
    return Chart(
        f"{link}-regimes", f"{run.name}: input and regimes", f"Shares of the time: {shares}.", "time [s]", panels,
        link=link, span=(0.0, run.duration), height=200 + 26 * len(ticks), legend=False,
    )  # fmt: skip


def _span(values: Array) -> float:
    return float(np.ptp(values)) or 1.0
