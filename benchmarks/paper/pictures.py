"""Figures 4 and 6 of the paper, from recordings of the second simulator."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import pneumo_ros as pn
from benchmarks.paper.bench import CLOSED
from pneumo_ros.identify.static_map import sliding_friction

BLUE, GREY, RED, GREEN = "#0b6fc2", "#8791a1", "#c2410c", "#2f855a"
DPI = 100


def figure_4(result: pn.IdentificationResult, printed: pn.Model, path: Path) -> None:
    """The static map: measured points, the identified curve and that of Table 2, with what is left below."""
    points, breaks = result.as_dict()["map"]["points"], result.as_dict()["breakaways"]
    speed, force, left = (np.array(points[key], float) for key in ("velocity", "force", "residual"))
    at = np.concatenate([sign * np.geomspace(1e-4, 1.05 * np.abs(speed).max(), 200) for sign in (-1.0, 1.0)])
    at.sort()
    figure, (map_, rest) = _panels(2, (3.0, 1.0))
    map_.plot(at, sliding_friction(printed, at), color=GREEN, linewidth=4.0, alpha=0.35, label="Table 2 as printed")
    map_.plot(at, sliding_friction(result.model, at), color=BLUE, linewidth=1.2, label="identified")
    map_.plot(speed, force, "o", color=GREY, markersize=4, label="windows of constant velocity")
    level = [one["direction"] * one["force_n"] for one in breaks]
    map_.plot(np.zeros(len(level)), level, "x", color=RED, markersize=6, label="breakaways from rest")
    map_.set_ylabel("friction force [N]")
    map_.legend(frameon=False, loc="lower right")
    rest.plot(speed, 1e3 * left, "o", color=GREY, markersize=3)
    rest.axhline(0.0, color=BLUE, linewidth=1.0)
    rest.set(xlabel="velocity [m/s]", ylabel="residual [mN]")
    figure.savefig(path, dpi=DPI)


def figure_6(recorded: pn.Recording, curves: Mapping[str, pn.Recording], path: Path) -> None:
    """The advance under 7 V: recorded, with identified friction dynamics and without; below, how far they are off."""
    figure, (whole, off) = _panels(2, (1.4, 1.0))
    time = recorded.time - CLOSED
    whole.plot(time, recorded.position, color=GREY, linewidth=4.0, label="(a) recorded")
    for (name, one), colour, dashes in zip(curves.items(), (BLUE, RED, GREEN), ("-", "-", "--"), strict=True):
        whole.plot(one.time - CLOSED, one.position, dashes, color=colour, linewidth=1.3, label=name)
        away = np.interp(recorded.time, one.time, one.position) - recorded.position
        off.plot(time, 1e3 * away, color=colour, linewidth=0.8)
    whole.set(ylabel="position [m]", xlim=(time[0], time[-1]))
    whole.legend(frameon=False, loc="lower right")
    off.set(xlabel="time since the step of 7 V [s]", ylabel="difference from (a) [mm]", ylim=(-0.6, 0.6))
    figure.savefig(path, dpi=DPI)


def _panels(rows: int, shares: tuple[float, ...]) -> tuple[Figure, Any]:
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    axes = figure.subplots(rows, 1, sharex=True, gridspec_kw={"height_ratios": shares})
    for one in axes:
        one.grid(color="#e6eaf0")
        one.spines[["top", "right"]].set_visible(False)
    return figure, axes
