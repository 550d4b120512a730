"""Candidates as bars: their scores, and their gain on the held-out runs."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.score import MARGIN
from pneumo_ros.report.bars import bars, guide, labels
from pneumo_ros.report.chart import Chart, Panel, Role, Trace
from pneumo_ros.wording.candidates import ADDED, REFUSED, RIVAL, STATES, CandidateWords
from pneumo_ros.wording.naming import sentence

Array = NDArray[np.float64]

COLOURS: dict[str, Role] = {ADDED: "first", RIVAL: "third", REFUSED: "measured"}
_DECADES = 8.0  # above this many times the margin, the axis is logarithmic
_LEAST_SHOWN = 10.0  # %
_ROOM = 0.2  # of the axis, for labels


def candidate_charts(found: Sequence[CandidateWords]) -> tuple[Chart, Chart]:
    """Score and held-out gain of every candidate, in rows of the same order."""
    nats = np.array([one.nats for one in found])
    gain = np.array([100.0 * one.gain for one in found])
    names, states = [one.effect for one in found], [one.state for one in found]
    return _scores(names, states, nats), _gain(names, states, gain)


def _scores(names: Sequence[str], states: Sequence[str], nats: Array) -> Chart:
    highest = max(float(nats.max()), MARGIN)
    log = highest > _DECADES * MARGIN
    begin = 1.0 if log else 0.0
    span = (begin, highest ** (1.0 + _ROOM) if log else (1.0 + _ROOM) * highest)
    said = [f"{value:.0f}" for value in nats]
    words = (
        "Logarithm of how much more probable all recordings are with the effect than without it, in nats; dotted: the "
        f"least required, {MARGIN:g}. {_first(names, nats, '{:.0f}')}"
    )
    panel = _panel(names, states, np.full(len(nats), begin), np.maximum(nats, begin), said, MARGIN)
    title = "How sure: the score of all recordings"
    return Chart("evidence-nats", title, words, "nats", (panel,), span=span, log_x=log, height=_height(names))


def _gain(names: Sequence[str], states: Sequence[str], gain: Array) -> Chart:
    lowest, highest = min(float(gain.min()), 0.0), max(float(gain.max()), _LEAST_SHOWN)
    span = (lowest - 0.05 * (highest - lowest) * (lowest < 0.0), highest + _ROOM * (highest - lowest))
    said = [f"{value:.1f} %" for value in gain]
    words = (
        "Share of the squared residual of the equation it helps most that it removes on recordings it was not fitted "
        f"to. {_first(names, gain, '{:.1f} %')}"
    )
    panel = _panel(names, states, np.zeros(len(gain)), gain, said)
    title = "What it brings: held-out gain"
    return Chart("evidence-gain", title, words, "held-out gain [%]", (panel,), span=span, height=_height(names))


def _panel(
    names: Sequence[str],
    states: Sequence[str],
    begin: Array,
    end: Array,
    said: Sequence[str],
    least: float | None = None,
) -> Panel:
    traces: list[Trace] = []
    for state, role in COLOURS.items():
        rows = np.flatnonzero([one == state for one in states])
        if len(rows):
            traces.append(bars(STATES[state], role, begin[rows], rows, end[rows]))
    rows = np.arange(len(names))
    if least is not None:
        traces.append(guide("least", least, len(names)))
    traces.append(labels(np.maximum(end, least or 0.0), rows, said))
    return Panel("", tuple(traces), ticks=tuple(names))


def _first(names: Sequence[str], values: Array, style: str) -> str:
    """The two candidates with the largest values."""
    order = np.argsort(-values, kind="stable")[:2]
    return sentence(", then ".join(f"{names[k]} {style.format(values[k])}" for k in order)) + "."


def _height(names: Sequence[str]) -> int:
    return 100 + 27 * len(names)
