"""Candidates as bars: their t on the fitted runs, and their gain on the held-out ones."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import GAIN_LEAST, T_LEAST
from pneumo_ros.report.bars import bars, guide, labels
from pneumo_ros.report.chart import Chart, Panel, Role, Trace
from pneumo_ros.wording.candidates import ADDED, REFUSED, RIVAL, STATES, CandidateWords
from pneumo_ros.wording.naming import sentence

Array = NDArray[np.float64]

COLOURS: dict[str, Role] = {ADDED: "first", RIVAL: "third", REFUSED: "measured"}
_DECADES = 8.0  # above this many times the least t, the axis is logarithmic
_ROOM = 0.2  # of the axis, for labels


def candidate_charts(found: Sequence[CandidateWords]) -> tuple[Chart, Chart]:
    """t and held-out gain of every candidate, in rows of the same order."""
    t = np.array([one.t for one in found])
    gain = np.array([100.0 * one.gain for one in found])
    names, states = [one.effect for one in found], [one.state for one in found]
    return _sureness(names, states, t), _gain(names, states, gain)


def _sureness(names: Sequence[str], states: Sequence[str], t: Array) -> Chart:
    highest = max(float(t.max()), T_LEAST)
    log = highest > _DECADES * T_LEAST
    begin = 1.0 if log else 0.0
    span = (begin, highest ** (1.0 + _ROOM) if log else (1.0 + _ROOM) * highest)
    said = [f"{value:.1f}" for value in t]
    words = f"Size over its standard deviation; dotted: the least required, {T_LEAST:g}. {_first(names, t, '{:.1f}')}"
    panel = _panel(names, states, np.full(len(t), begin), np.maximum(t, begin), said, T_LEAST)
    title = "How sure: t on the fitted recordings"
    return Chart("evidence-t", title, words, "t", (panel,), span=span, log_x=log, height=_height(names))


def _gain(names: Sequence[str], states: Sequence[str], gain: Array) -> Chart:
    least = 100.0 * GAIN_LEAST
    lowest, highest = min(float(gain.min()), 0.0), max(float(gain.max()), 2.0 * least)
    span = (lowest - 0.05 * (highest - lowest) * (lowest < 0.0), highest + _ROOM * (highest - lowest))
    said = [f"{value:.1f} %" for value in gain]
    words = (
        "Share of the squared residual of the equation it helps most that it removes on recordings it was not fitted "
        f"to; dotted: the least required, {least:g} %. {_first(names, gain, '{:.1f} %')}"
    )
    panel = _panel(names, states, np.zeros(len(gain)), gain, said, least)
    title = "What it brings: held-out gain"
    return Chart("evidence-gain", title, words, "held-out gain [%]", (panel,), span=span, height=_height(names))


def _panel(
    names: Sequence[str], states: Sequence[str], begin: Array, end: Array, said: Sequence[str], least: float
) -> Panel:
    traces: list[Trace] = []
    for state, role in COLOURS.items():
        rows = np.flatnonzero([one == state for one in states])
        if len(rows):
            traces.append(bars(STATES[state], role, begin[rows], rows, end[rows]))
    rows = np.arange(len(names))
    traces += [guide("least", least, len(names)), labels(np.maximum(end, least), rows, said)]
    return Panel("", tuple(traces), ticks=tuple(names))


def _first(names: Sequence[str], values: Array, style: str) -> str:
    """The two candidates with the largest values."""
    order = np.argsort(-values, kind="stable")[:2]
    return sentence(", then ".join(f"{names[k]} {style.format(values[k])}" for k in order)) + "."


def _height(names: Sequence[str]) -> int:
    return 100 + 27 * len(names)
