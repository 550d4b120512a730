"""Residuals of the refitted base and of the final model over the variable that explains them best, and what remains."""

from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.diagnose.wording import EQUATIONS, VARIABLES, amount, number, percent, times
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.equations import broken, coverage
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.report.naming import equation_words, listed, sentence

if TYPE_CHECKING:
    from pneumo_ros.diagnose.compare import Comparison
    from pneumo_ros.diagnose.dependence import Dependence
    from pneumo_ros.discover.outcome import Outcome

_HEIGHT = 400
_FOLLOWS = 0.1  # share from which on a variable is worth naming
_TIED = 0.8  # of the best share: variables this close cannot be told apart here


def residuals_section(outcome: "Outcome") -> Section:
    """A chart for each equation that failed after the refit."""
    title = "Before and after"
    if not outcome.added:
        text = "Nothing was added, so there is nothing to compare. The residuals of the refitted model stand under "
        return Section("residuals", title, tag("p", text, tag("a", "Equations", href="#equations"), "."))
    names = [name for name in outcome.failing if outcome.before.dependences.get(name)]
    if not names:
        text = "No equation failed after the refit along the held-out recordings: see the held-out error instead."
        return Section("residuals", title, tag("p", text))
    text = (
        "What was measured minus what the model claims, along the held-out recordings, over the variable that explains "
        "most of it: means over bins with their 95 % interval. The grey band is what noise scatters single windows by; "
        "below, the seconds each bin rests on."
    )
    charts = tuple(_chart(outcome, name, variable) for name in names for variable in best(outcome.before, name))
    return Section("residuals", title, tag("p", text, class_="soft"), charts=charts, columns=min(len(charts), 2))


def best(comparison: "Comparison", equation: str) -> list[str]:
    """The variable that explains most of an equation's residual, and the next one if it explains nearly as much."""
    found = comparison.dependences[equation]
    first, *others = sorted(found, key=lambda name: -found[name].explained_share)
    least = max(_TIED * found[first].explained_share, _FOLLOWS)
    return [first, *(name for name in others[:1] if found[name].explained_share >= least)]


def _chart(outcome: "Outcome", equation: str, variable: str) -> Chart:
    shown: tuple[tuple[str, Role, Comparison], ...] = (
        ("refitted", "second", outcome.before),
        ("final model", "first", outcome.after),
    )
    curves = [_curve(name, role, one.dependences[equation][variable], equation) for name, role, one in shown]
    said = "; ".join(f"{name}: {_size(one, equation)}, {_share(one, equation, variable)}" for name, _, one in shown)
    title = f"{sentence(EQUATIONS[equation][0])} over {VARIABLES[variable][0]}"
    found = outcome.after.dependences[equation][variable]
    traces = tuple(trace for curve in curves for trace in curve)
    return _framed(f"residual-{equation}-{variable}", title, f"{sentence(said)}.", equation, found, traces)


def _share(comparison: "Comparison", equation: str, variable: str) -> str:
    share = comparison.dependences[equation][variable].explained_share
    return f"of whose square {VARIABLES[variable][0]} explains {percent(share)}"


def _size(comparison: "Comparison", equation: str) -> str:
    judged = comparison.equations[equation]
    return f"{amount(judged.residual_rms, equation)} rms, {times(judged.ratio_to_noise)} the noise"


def _curve(name: str, role: Role, found: "Dependence", equation: str) -> tuple[Trace, Trace]:
    """Mean and band."""
    factor, x_factor, bins = EQUATIONS[equation][2], VARIABLES[found.variable][2], found.bins
    x, mean, low, high = broken(
        x_factor * bins.low, x_factor * bins.high, x_factor * bins.centre, factor * bins.mean, factor * bins.below,
        factor * bins.above,
    )  # fmt: skip
    return Trace(f"{name}, 95 %", role, "band", x, low, high), Trace(name, role, "line", x, mean)


def _framed(name: str, title: str, words: str, equation: str, found: "Dependence", traces: tuple[Trace, ...]) -> Chart:
    """Curves over the band of the noise, coverage below."""
    _, unit, factor = EQUATIONS[equation]
    variable, x_unit, x_factor = VARIABLES[found.variable]
    begin, end = x_factor * found.bins.low, x_factor * found.bins.high
    x, noise = broken(begin, end, x_factor * found.bins.centre, factor * found.noise)
    edges = tuple(Trace("noise of a window", "noise", "line", x, sign * noise) for sign in (-1.0, 1.0))
    band = Trace("noise", "noise", "band", x, -noise, noise)
    panels = (
        Panel(f"residual [{unit}]", (band, *edges, *traces), share=3.2),
        Panel("seconds", (coverage(begin, end, found.seconds),)),
    )
    return Chart(name, title, words, f"{variable} [{x_unit}]", panels, height=_HEIGHT)


def remains_section(outcome: "Outcome", experiment: str) -> Section:
    """The shape of what no effect explains, or that there is none; and the experiment that would tell more."""
    title = "What remains"
    advice = _advice(experiment)
    left = outcome.unexplained
    if left is None:
        text = "Nothing of size remains: every equation of the final model is explained by noise, or close to it."
        sizes = [f"{equation_words(n)} {times(e.ratio_to_noise)}" for n, e in outcome.after.equations.items()
                 if e.explained_by_noise is not None]  # fmt: skip
        return Section("remains", title, Html(tag("p", f"{text} Over noise: {', '.join(sizes)}.") + advice))
    found = outcome.after.dependences[left.equation][left.against]
    words = _remaining(outcome)
    shape = f"Unexplained in the {equation_words(left.equation)}, over {VARIABLES[left.against][0]}"
    curve = _curve("mean of what remains", "second", found, left.equation)
    chart = _framed("remains-shape", shape, words, left.equation, found, curve)
    text = (
        f"In the {equation_words(left.equation)}, {amount(left.rms, left.equation)} rms remain that no effect of the "
        "catalogue explains. Its shape is what a new effect has to reproduce: an effect of your own is a few lines of "
        "Python, and takes part in the search with --effects FILE.py."
    )
    more = tag("p", "Against the other variables: ", tag("a", "Equations", href="#equations"), ".")
    return Section("remains", title, Html(tag("p", text) + more + advice), charts=(chart,))


def _remaining(outcome: "Outcome") -> str:
    """What there is to see, in a sentence or two."""
    left = outcome.unexplained
    assert left is not None
    factor = EQUATIONS[left.equation][2]
    low, high = factor * float(np.nanmin(left.mean)), factor * float(np.nanmax(left.mean))
    unit = EQUATIONS[left.equation][1]
    shape = f"Bin means from {number(low)} to {number(high)} {unit}, over {number(float(left.seconds.sum()))} s"
    variable = VARIABLES[left.against][0]
    if left.share >= _FOLLOWS:
        return f"{sentence(variable)} explains {percent(left.share)} of its square. {shape}."
    others = listed([VARIABLES[name][0] for name in outcome.after.dependences[left.equation]], "or")
    return f"It follows none of {others}: {variable} explains {percent(left.share)} of its square, the most. {shape}."


def _advice(experiment: str) -> Html:
    if not experiment:
        return Html()
    return tag("p", tag("strong", "The experiment that would tell more: "), experiment, class_="advice")
