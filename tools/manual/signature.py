"""A picture of what an effect leaves: the residuals of the default machine along the motion of one that has the effect.

The effect has its usual size. Each equation is drawn over the variable that explains most of its residual, as `pneumo
compare` finds it; an equation that noise explains stays empty but for its zero.
"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import pneumo_ros as pn
from pneumo_ros.compare.compare import Comparison
from pneumo_ros.compare.dependence import UNITS, Dependence
from pneumo_ros.plant.reach import owners_read
from pneumo_ros.plant.usual import usual_size

SECONDS, RATE = 16.0, 1000.0
NOISE = {"position": 5e-6, "pressure_a": 300.0, "pressure_b": 300.0}  # m and Pa, standard deviations of the sensors
EQUATIONS = {"momentum": ("N", 1.0), "chamber_a": ("mg/s", 1e6), "chamber_b": ("mg/s", 1e6)}
SCALES = {"Pa": ("bar", 1e-5), "m": ("mm", 1e3), "m/s": ("mm/s", 1e3)}
PLAIN = 1.5  # times the noise, below which a residual is drawn as one that noise explains


def base_of(effect: type[pn.Effect]) -> pn.Model:
    """The default machine, with the effects whose parameters this one reads."""
    machine = pn.load_model("axis")
    listed = {name.partition(".")[0] for name in machine.parameters}
    return machine.with_effects([*machine.effects, *(owner for owner in owners_read(effect) if owner not in listed)])


def with_effect(machine: pn.Model, effect: type[pn.Effect]) -> pn.Model:
    """The machine with an effect of usual size. Raises UsageError for one that does not fit it."""
    sizes = {}
    for key, one in effect.parameters.items():
        if one.neutral is not None:
            size = usual_size(effect, key)
            sizes[f"{effect.name}.{key}"] = one.neutral + (size if one.neutral + size <= one.high else -size)
    return machine.with_effects([*machine.effects, effect.name], sizes)


def voltage() -> Any:
    """Slow and fast sines, then steps, in both directions [V]."""
    time = np.arange(round(SECONDS * RATE)) / RATE
    sines = 1.1 * np.sin(2.0 * np.pi * 0.31 * time) + 1.3 * np.sin(2.0 * np.pi * 0.83 * time)
    steps = np.repeat(np.random.default_rng(3).uniform(-3.0, 3.0, len(time)), 700)[: len(time)]
    return np.where(time < 0.5 * SECONDS, sines, steps)


def draw(effect: type[pn.Effect], path: Path) -> None:
    """Write the picture of an effect as PNG. Raises PneumoError for an effect that fits no simulated machine."""
    machine = base_of(effect)
    recording = pn.simulate(with_effect(machine, effect), voltage(), seconds=SECONDS, noise=NOISE)
    found = pn.compare(recording, machine).detail
    figure = Figure(figsize=(9.0, 2.3), layout="constrained")
    for axes, name in zip(figure.subplots(1, 3), EQUATIONS, strict=True):
        panel(axes, found, name)
    figure.savefig(path, dpi=100)


def panel(axes: Any, found: Comparison, name: str) -> None:
    """One equation: the residual over the variable that explains most of it."""
    unit, scale = EQUATIONS[name]
    ratio = found.equations[name].ratio_to_noise
    axes.axhline(0.0, color="0.7", linewidth=0.8)
    title = f"{ratio:.1f} x noise" if np.isfinite(ratio) else "not judged, it did not move"
    axes.set_title(f"{name.replace('_', ' ')}: {title}", fontsize=9)
    axes.tick_params(labelsize=7)
    if not found.dependences[name]:
        return
    best: Dependence = max(found.dependences[name].values(), key=lambda one: one.explained_share)
    known = UNITS[best.variable]
    of, factor = SCALES.get(known, (known, 1.0))
    bins = best.bins
    low, high = scale * (bins.mean - bins.below), scale * (bins.above - bins.mean)
    colour = "C0" if ratio < PLAIN else "C3"
    axes.errorbar(
        factor * bins.centre, scale * bins.mean, np.abs(np.array([low, high])), fmt="o-", markersize=3, linewidth=1.0,
        color=colour,
    )  # fmt: skip
    axes.set_xlabel(f"{best.variable.replace('_', ' ')} [{of}]", fontsize=8)
    axes.set_ylabel(f"residual [{unit}]", fontsize=8)
