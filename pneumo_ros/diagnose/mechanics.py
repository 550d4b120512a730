"""The mechanics alone: piston, friction and load driven by the measured pressures.

Without the chambers' equations a short simulation from rest through a breakaway or a reversal depends on friction and
load only. It shows the millimetre between sticking and sliding, which no equation along the motion shows.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.sensors import corrected
from pneumo_ros.shooting.segments import Segments, cut

Array = NDArray[np.float64]

LENGTH = 0.3  # s
MOST_EVENTS = 40  # segments: more take longer, and change friction by less than its deviation
_SLOW, _MOVED = 0.004, 3e-4  # m/s and m: the slowest speed of an event is smaller, its travel is larger
_LAG = 0.025  # s


def mechanical(model: Model) -> Model | None:
    """The model without valve and chambers, driven by a force; None where its mechanics need the valve or the gas."""
    if model.force_driven:
        return model
    kept: list[str] = []
    for name in model.effects:
        try:
            Model.build(
                [*kept, name], {}, library=model.library, frame=("piston", "air"), name=model.name, defaults=True
            )
        except PneumoError:
            if moves(model, name):
                return None
            continue
        if moves(model, name):
            kept.append(name)
    values = {k: v for k, v in model.parameters.items() if k.partition(".")[0] in (*kept, "piston", "air")}
    stated = {k: v for k, v in model.uncertainty.items() if k in values}
    return Model.build(
        kept, values, library=model.library, frame=("piston", "air"), name=model.name, uncertainty=stated
    )


def moves(model: Model, name: str) -> bool:
    """Whether an effect acts on the piston or on its position sensor."""
    mechanics = {
        "force", "friction", "added_mass", "friction_scale", "friction_rise", "static_scale", "static_rise", "slip",
        "stribeck", "y_measured", "resistance",
    }  # fmt: skip
    functions = model.library.find(name).functions.values()
    return any(signal in mechanics for function in functions for signal in function.writes)


def moving_mass(model: Model) -> float:
    """Mass that moves with the piston at once [kg]."""
    return model["piston.mass"] + float(model.outputs(model.state()[None])["added_mass"][0])


def driven_by_pressures(model: Model, run: Run) -> Run:
    """The run as that of an axis driven by its measured pressures, corrected for the model's pressure sensors."""
    if model.force_driven:
        return run
    pressures = corrected(model, measured_frame(run, force_driven=False), run)[:, 2:4]
    force = model["piston.area_a"] * pressures[:, 0] - model["piston.area_b"] * pressures[:, 1]
    n = len(force)
    cells = np.repeat(np.arange(n - 1), PARTS) + np.tile((np.arange(PARTS) + 0.5) / PARTS, n - 1)
    held, p_a, p_b = (np.interp(cells, np.arange(n), one) for one in (force, pressures[:, 0], pressures[:, 1]))
    further = {**run.further, "p_a": p_a, "p_b": p_b}
    return replace(run, input=held, further=further, force_driven=True, pressure_a=None, pressure_b=None)


def event_rows(model: Model, runs: Sequence[Run], most: int = MOST_EVENTS) -> NDArray[np.int64]:
    """Which of the side-by-side segments of `runs` hold a breakaway, a stop or a reversal; spread evenly."""
    segments = cut(model, runs, LENGTH)
    y, lag = segments.measured[:, :, 0], max(round(_LAG / segments.sample_time), 1)
    speed = np.abs(y[:, lag:] - y[:, :-lag]) / (lag * segments.sample_time)
    found = np.flatnonzero((speed.min(axis=1) < _SLOW) & (np.ptp(y, axis=1) > _MOVED))
    if len(found) > most:
        found = found[np.linspace(0, len(found) - 1, most).astype(int)]
    return found


def events(model: Model, runs: Sequence[Run], rows: NDArray[np.int64]) -> Segments:
    """Those segments, with first guesses by `model`."""
    return cut(model, runs, LENGTH, rows)
