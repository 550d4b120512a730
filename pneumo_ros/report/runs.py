"""Run by run: errors, worst intervals, and measured and predicted signals over time, which zoom together."""

from typing import TYPE_CHECKING, Any

import numpy as np

from pneumo_ros.compare.wording import REGIMES, TARGETS, amount, percent, times
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Html, table, tag
from pneumo_ros.report.regimes import regime_table
from pneumo_ros.report.run_charts import run_charts

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison, RunComparison

BUDGET = 3_600_000  # characters for the series of a page; plotly and tables take the rest of ten megabytes
# Characters per value, rounded up from recordings with 10 um and 300 Pa of noise: with all values, and thinned
_WHOLE, _THINNED = 0.6, 1.1


def thinning(comparison: "Comparison") -> int:
    """Size of the buckets of which two samples are kept, so that the page stays small; 2 keeps all samples."""
    values = sum(4 * len(one.error) * one.samples for one in comparison.runs)
    return 2 if values * _WHOLE <= BUDGET else max(int(np.ceil(2.0 * values * _THINNED / BUDGET)), 3)


def runs_section(result: dict[str, Any], comparison: "Comparison", bucket: int) -> Section:
    """A part for every run."""
    every = "every sample" if bucket == 2 else f"two of every {bucket} samples, those of smallest and largest error"
    text = (
        f"Measured, predicted over windows of {result['horizon_s']:g} s that each start from an estimated state, and "
        f"simulated freely from the first sample (dashed; a click on its name shows it). Drawn from {every}. Drag "
        "across a plot to zoom all plots of the run; double click to see the whole run again."
    )
    parts = tuple(
        _run(k, one, run, bucket) for k, (one, run) in enumerate(zip(result["runs"], comparison.runs, strict=True), 1)
    )
    return Section("runs", "Runs", tag("p", text, class_="soft"), parts=parts)


def _run(k: int, one: dict[str, Any], run: "RunComparison", bucket: int) -> Section:
    link = f"run-{k}"
    rate = 1.0 / one["sample_time_s"]
    size = f"{one['duration_s']:.1f} s, {one['samples']} samples at {rate:.0f} Hz, {one['windows']} windows. "
    back = tag("a", "Back to the overview", href="#overview")
    charts = run_charts(run, link, bucket)
    body = Html(tag("p", size, back) + _errors(one) + _regimes(one) + _jumps(one, link))
    return Section(link, one["name"], body, charts=charts)


def _errors(one: dict[str, Any]) -> Html:
    head = ("", "rms", "rms / noise", "noise", "largest", "fit", "share", "free run")
    rows = []
    for name, e in one["error"].items():
        fit = "-" if e["fit_percent"] is None else f"{e['fit_percent']:.1f} %"
        free = amount(one["free_run"][name]["rms"], name)
        rows.append((TARGETS[name][0], amount(e["rms"], name), times(e["ratio_to_noise"]), amount(e["noise"], name),
                     amount(e["max"], name), fit, percent(e["share"]), free))  # fmt: skip
    for name, e in one["equations"].items():
        row = (TARGETS[name][0], amount(e["residual_rms"], name), times(e["ratio_to_noise"]), "", "", "")
        rows.append((*row, percent(e["share"]), ""))
    return table(
        head,
        rows,
        "Errors of the predictions and residuals of the equations; share: of the squared error of all runs",
        numeric=range(1, 8),
    )


def _regimes(one: dict[str, Any]) -> Html:
    inner = regime_table({**one["error"], **one["equations"]}, one["regimes"], one["name"])
    return tag("details", tag("summary", "In which regime"), inner)


def _jumps(one: dict[str, Any], link: str) -> Html:
    """Buttons that zoom the plots of a run to its worst intervals."""
    buttons = [tag("button", "Whole run", type="button", data_link=link)]
    for name, e in {**one["error"], **one["equations"]}.items():
        for interval in e["worst"][:1]:
            margin = 0.3 * (interval["end_s"] - interval["start_s"]) + 0.1
            span = (max(interval["start_s"] - margin, 0.0), interval["end_s"] + margin)
            text = f"{TARGETS[name][0]} {interval['start_s']:.1f}-{interval['end_s']:.1f} s"
            where = ", ".join(REGIMES[r] for r in interval["regimes"])
            buttons.append(
                tag(
                    "button",
                    text,
                    type="button",
                    data_link=link,
                    data_from=f"{span[0]:.3f}",
                    data_to=f"{span[1]:.3f}",
                    title=f"{times(interval['ratio_to_noise'])} noise; {where}",
                )
            )
    return tag("p", tag("span", "Worst intervals:", class_="soft"), buttons, class_="jumps")
