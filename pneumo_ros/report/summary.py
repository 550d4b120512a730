"""The first page: effect, size, how sure, what to do at the machine, and measured, before and after over time."""

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import SIGNALS, amount, times
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.markup import Html, tag, worded
from pneumo_ros.report.series import extremes
from pneumo_ros.wording.answers import answers_table
from pneumo_ros.wording.diagnosis import DiagnosisWords

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison, RunComparison
    from pneumo_ros.diagnose.outcome import Outcome

    Shown = tuple[str, Role, Comparison]  # a model's name in the plot, its colour, and its predictions

Array = NDArray[np.float64]
SHOWN = 10.0  # s around the worst error: more would hide it in the width of a page
_POINTS = 1500  # buckets of a curve, each with its smallest and largest error
_FINER = 5.0  # the curves are stored this much finer than their noise


def summary_text(said: DiagnosisWords) -> Html:
    """The table of effects, what to do at the machine and what to record next, in the report and the workbench."""
    table = worded(answers_table(said.answers), "Missing in the model") if said.answers else Html()
    experiment = tag("p", tag("strong", "What to record next: "), said.experiment) if said.experiment else Html()
    return Html(table + doing_list(said.doing) + experiment)


def doing_list(doing: Sequence[str]) -> Html:
    """What to do at the machine, a sentence each; nothing where there is nothing to do."""
    return tag("ul", [tag("li", text) for text in doing], class_="doing") if doing else Html()


def summary_section(said: DiagnosisWords, outcome: "Outcome") -> Section:
    """The words, and one plot of measured, before and after over time."""
    chart = before_after_chart(outcome.before, outcome.after, [one.effect for one in outcome.added])
    return Section("summary", "On one page", summary_text(said), charts=(chart,) if chart else ())


def what_next(words: str, then: str) -> Html:
    """What to do with the result, and the command line that does it, "" for none."""
    command = tag("pre", tag("code", then)) if then else Html()
    return Html(tag("p", tag("strong", "What to do next: "), words) + command)


def before_after_chart(
    refitted: "Comparison", final: "Comparison", added: Sequence[str], fitted: bool = False
) -> Chart | None:
    """The signal that the refitted model predicts worst, measured, before and after; None without one.

    `fitted`: whether the runs of both comparisons were fitted.
    """
    shown: tuple[Shown, ...] = (("refitted, nothing added", "second", refitted),)
    if added:
        shown += ((f"with {', '.join(added)}", "first", final),)
    return over_time_chart(shown, [one.name for one in refitted.runs] if fitted else [])


def over_time_chart(shown: "Sequence[Shown]", fitted: Collection[str] | None, height: int = 400) -> Chart | None:
    """Measured, and predicted by each comparison, of the signal that the first one predicts worst; None without one.

    Shown: name, role and comparison of each model; fitted: names of the runs that were fitted, None says nothing of it;
    height: in pixels.
    """
    found = worst(shown[0][2])
    if found is None:
        return None
    k, name = found
    before, runs = shown[0][2].runs[k], tuple((text, role, one.runs[k]) for text, role, one in shown)
    words, unit, _ = SIGNALS[name]
    span = _span(before, name)
    panels = (Panel(f"{words} [{unit}]", _curves(before, name, runs, span), share=1.4),
              Panel(f"error [{unit}]", _errors(before, name, runs, span)))  # fmt: skip
    which = "measured, before and after" if len(shown) > 1 else "measured and predicted"
    judged = "" if fitted is None else f", which was {'' if before.name in fitted else 'not '}fitted"
    title = f"{words.capitalize()} of '{before.name}'{judged}: {which}"
    said = [f"{text} {amount(run.error[name].rms, name)} rms, {times(run.error[name].ratio)} the noise"
            for text, _, run in runs]  # fmt: skip
    told = f"Error over {shown[-1][2].horizon:g} s: {'; '.join(said)}."
    return Chart("before-after", title, told, "time [s]", panels, link="before-after", span=span, height=height)


def worst(comparison: "Comparison") -> tuple[int, str] | None:
    """Index of the run and name of the signal with the largest error over noise; None where nothing was predicted."""
    ratios = {
        (k, name): one.ratio
        for k, run in enumerate(comparison.runs)
        for name, one in run.error.items()
        if one.ratio is not None and np.isfinite(one.ratio)
    }
    return max(ratios, key=lambda key: ratios[key]) if ratios else None


def _span(run: "RunComparison", name: str) -> tuple[float, float]:
    """The seconds around the worst error, at most `SHOWN`."""
    if run.duration <= SHOWN or not run.located[name].worst:
        return 0.0, min(run.duration, SHOWN)
    interval = run.located[name].worst[0]
    begin = min(max(0.5 * (interval.start + interval.end - SHOWN), 0.0), run.duration - SHOWN)
    return begin, begin + SHOWN


def _curves(
    run: "RunComparison", name: str, shown: "tuple[tuple[str, Role, RunComparison], ...]", span: tuple[float, float]
) -> tuple[Trace, ...]:
    """The measured signal, and the predictions of each model."""
    fine, factor = SIGNALS[name][2] * run.error[name].noise / _FINER, SIGNALS[name][2]
    curves: list[tuple[str, Role, RunComparison, Array]] = [("measured", "measured", run, _measured(run, name))]
    curves += [(text, role, one, _measured(one, name) + one.predicted[name]) for text, role, one in shown]
    return tuple(_trace(text, role, one, factor * values, span, fine) for text, role, one, values in curves)


def _measured(run: "RunComparison", name: str) -> Array:
    grid = run.motion.run
    return np.where(grid.measured, (grid.signals | grid.judged)[name], np.nan)


def _errors(
    run: "RunComparison", name: str, shown: "tuple[tuple[str, Role, RunComparison], ...]", span: tuple[float, float]
) -> tuple[Trace, ...]:
    """The error of each model, and twice the noise."""
    factor, level = SIGNALS[name][2], SIGNALS[name][2] * run.error[name].noise
    curves = [_trace(text, role, one, factor * one.predicted[name].astype(float), span, level / _FINER)
              for text, role, one in shown]  # fmt: skip
    noise = [
        Trace("2 x noise", "noise", "line", np.array(span), np.full(2, sign * 2.0 * level)) for sign in (1.0, -1.0)
    ]
    return (*curves, *noise)


def _trace(name: str, role: Role, run: "RunComparison", values: Array, span: tuple[float, float], fine: float) -> Trace:
    time = run.motion.run.time
    inside = (time >= span[0]) & (time <= span[1])
    x, y = time[inside], values[inside]
    kept = extremes(y, -(-len(y) // _POINTS))
    return Trace(name, role, "line", x[kept], y[kept], resolution=fine)
