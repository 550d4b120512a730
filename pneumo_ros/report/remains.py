"""What no effect explains: its shape, or that there is none, and the experiment that would tell more."""

from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES, amount, machine_changed, number, percent, times
from pneumo_ros.report.chart import Chart, Section
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.report.naming import equation_words, listed, sentence, the
from pneumo_ros.report.residuals import FOLLOWS, curve, framed

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Outcome, Unexplained


def remains_section(outcome: "Outcome", experiment: str) -> Section:
    """The shape, the sentence that there is none, and the experiment."""
    left, title = outcome.unexplained, "What remains"
    if left is None:
        return Section("remains", title, Html(_nothing(outcome) + _advice(experiment)))
    text = (
        f"In {the(left.equation)}, {amount(left.rms, left.equation)} rms remain that no effect of the catalogue "
        "explains. A new effect has to reproduce this shape: it is a few lines of Python, and takes part in the search "
        "with --effects FILE.py."
    )
    more = tag("p", "Against the other variables: ", tag("a", "Equations", href="#equations"), ".")
    charts = (_chart(outcome, left),) if len(left.at) else ()
    return Section("remains", title, Html(tag("p", text) + _between(left) + more + _advice(experiment)), charts=charts)


def _between(left: "Unexplained") -> Html:
    """That the machine itself changed between the recordings, where most of what remains is that."""
    return tag("p", machine_changed(left.moved.share, left.moved.parameters)) if left.moved else Html()


def _nothing(outcome: "Outcome") -> Html:
    sizes = [
        f"{equation_words(name)} {times(judged.ratio_to_noise)}"
        for name, judged in outcome.after.equations.items()
        if judged.explained_by_noise is not None
    ]
    text = "Nothing of size remains: noise explains every equation of the final model, or comes close to it."
    return tag("p", f"{text} Over noise: {', '.join(sizes)}.")


def _chart(outcome: "Outcome", left: "Unexplained") -> Chart:
    found = outcome.after.dependences[left.equation][left.against]
    title = f"Unexplained in {the(left.equation)}, over {VARIABLES[left.against][0]}"
    traces = curve("mean of what remains", "second", found, left.equation)
    return framed("remains-shape", title, _words(outcome, left), left.equation, found, traces)


def _words(outcome: "Outcome", left: "Unexplained") -> str:
    """What there is to see, in a sentence or two."""
    _, unit, factor = EQUATIONS[left.equation]
    low, high = factor * float(np.min(left.mean)), factor * float(np.max(left.mean))
    shape = f"Bin means from {number(low)} to {number(high)} {unit}, over {number(float(left.seconds.sum()))} s"
    variable = VARIABLES[left.against][0]
    if left.share >= FOLLOWS:
        return f"{sentence(variable)} explains {percent(left.share)} of the squared residual. {shape}."
    others = listed([VARIABLES[name][0] for name in outcome.after.dependences[left.equation]], "or")
    share = f"{variable}, which explains most, explains {percent(left.share)} of the squared residual"
    return f"None of {others} explains much: {share}. {shape}."


def _advice(experiment: str) -> Html:
    if not experiment:
        return Html()
    return tag("p", tag("strong", "The experiment that would tell more: "), experiment, class_="advice")
