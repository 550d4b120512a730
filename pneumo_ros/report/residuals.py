"""Residuals of the refitted base and of the final model over the variable that explains them best."""

from typing import TYPE_CHECKING

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES, amount, percent, times
from pneumo_ros.report.chart import Chart, Panel, Role, Section, Trace
from pneumo_ros.report.equations import broken, coverage
from pneumo_ros.report.markup import tag
from pneumo_ros.wording.naming import equation_words, sentence
from pneumo_ros.wording.remains import FOLLOWS

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison
    from pneumo_ros.compare.dependence import Dependence
    from pneumo_ros.diagnose.outcome import Outcome

_HEIGHT = 400
_TIED = 0.8  # of the best share: variables this close cannot be distinguished here


def residuals_section(outcome: "Outcome") -> Section:
    """A chart for each equation that failed after the refit."""
    title = "Before and after"
    if not outcome.added:
        text = "Nothing was added, so there is nothing to compare. The residuals of the refitted model are under "
        return Section("residuals", title, tag("p", text, tag("a", "Equations", href="#equations"), "."))
    names = [name for name in outcome.failing if name in outcome.before.dependences]
    if not names:
        text = "No equation failed after the refit along the held-out recordings: see the held-out error instead."
        return Section("residuals", title, tag("p", text))
    text = (
        "Measured minus model, along the held-out recordings, over the variable that explains most of it: means over "
        "bins with their 95 % interval. The grey band is the scatter of single windows by noise; below: the seconds in "
        "each bin."
    )
    return Section("residuals", title, tag("p", text, class_="soft"), parts=tuple(_part(outcome, n) for n in names))


def _part(outcome: "Outcome", equation: str) -> Section:
    """One equation: its residual before and after, over the variables that explain it."""
    before, after = (_size(one, equation) for one in (outcome.before, outcome.after))
    charts = tuple(_chart(outcome, equation, variable) for variable in best(outcome.before, equation))
    words = tag("p", f"Refitted {before}; final model {after}.")
    return Section(f"residual-{equation}", sentence(equation_words(equation)), words, charts=charts, columns=2)


def best(comparison: "Comparison", equation: str) -> list[str]:
    """The variable that explains most of an equation's residual, and the next one if it explains nearly as much."""
    found = {name: one for name, one in comparison.dependences[equation].items() if len(one.bins.centre) > 1}
    if not found:
        return []
    first, *others = sorted(found, key=lambda name: -found[name].explained_share)
    least = max(_TIED * found[first].explained_share, FOLLOWS)
    return [first, *(name for name in others[:1] if found[name].explained_share >= least)]


def _chart(outcome: "Outcome", equation: str, variable: str) -> Chart:
    shown: tuple[tuple[str, Role, Comparison], ...] = (
        ("refitted", "second", outcome.before),
        ("final model", "first", outcome.after),
    )
    curves = [curve(name, role, one.dependences[equation][variable], equation) for name, role, one in shown]
    shares = [percent(one.dependences[equation][variable].explained_share) for _, _, one in shown]
    said = f"{VARIABLES[variable][0]} explains {shares[0]} of the squared residual, and {shares[1]} in the final model"
    title = f"{sentence(EQUATIONS[equation][0])} over {VARIABLES[variable][0]}"
    found = outcome.after.dependences[equation][variable]
    traces = tuple(trace for curve in curves for trace in curve)
    return framed(f"residual-{equation}-{variable}", title, f"{sentence(said)}.", equation, found, traces)


def _size(comparison: "Comparison", equation: str) -> str:
    judged = comparison.equations[equation]
    return f"{amount(judged.residual_rms, equation)} rms, {times(judged.ratio_to_noise)} the noise"


def curve(name: str, role: Role, found: "Dependence", equation: str) -> tuple[Trace, Trace]:
    """Mean and band."""
    factor, x_factor, bins = EQUATIONS[equation][2], VARIABLES[found.variable][2], found.bins
    x, mean, low, high = broken(
        x_factor * bins.low, x_factor * bins.high, x_factor * bins.centre, factor * bins.mean, factor * bins.below,
        factor * bins.above,
    )  # fmt: skip
    return Trace(f"{name}, 95 %", role, "band", x, low, high), Trace(name, role, "line", x, mean)


def framed(name: str, title: str, words: str, equation: str, found: "Dependence", traces: tuple[Trace, ...]) -> Chart:
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
