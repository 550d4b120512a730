"""The residual that no effect explains: its shape, if any, and the experiment that shows more of it."""

from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES, number
from pneumo_ros.report.chart import Chart, Section
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.report.residuals import curve, framed
from pneumo_ros.wording.diagnosis import DiagnosisWords
from pneumo_ros.wording.naming import the

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Outcome, Unexplained


def remains_section(said: DiagnosisWords, outcome: "Outcome") -> Section:
    """The sentences, the shape of what remains, and the experiment."""
    left, body = outcome.unexplained, remains_text(said)
    if left is None:
        return Section("remains", "What remains", body)
    more = tag("p", "Against the other variables: ", tag("a", "Equations", href="#equations"), ".")
    charts = (_chart(outcome, left),) if len(left.at) else ()
    return Section("remains", "What remains", Html(body + more), charts=charts)


def remains_text(said: DiagnosisWords) -> Html:
    """The sentences on what remains, and what to record next."""
    parts = [tag("p", text) for text in said.remains]
    if said.experiment:
        parts.append(tag("p", tag("strong", "What to record next: "), said.experiment, class_="advice"))
    return Html("".join(parts))


def _chart(outcome: "Outcome", left: "Unexplained") -> Chart:
    found = outcome.after.dependences[left.equation][left.against]
    title = f"Unexplained in {the(left.equation)}, over {VARIABLES[left.against][0]}"
    traces = curve("mean of what remains", "second", found, left.equation)
    return framed("remains-shape", title, _words(left), left.equation, found, traces)


def _words(left: "Unexplained") -> str:
    """The chart in words."""
    _, unit, factor = EQUATIONS[left.equation]
    low, high = factor * float(np.min(left.mean)), factor * float(np.max(left.mean))
    return f"Bin means from {number(low)} to {number(high)} {unit}, over {number(float(left.seconds.sum()))} s."
