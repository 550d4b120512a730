"""The momentum equation by itself: the machine driven by its measured pressures instead of its valve."""

from dataclasses import replace

import numpy as np

from pneumo_ros.identify.run import PARTS, Run
from pneumo_ros.identify.smooth import smooth
from pneumo_ros.plant import Effect, Model

_MECHANICAL = {
    "force", "friction", "resistance", "added_mass", "friction_scale", "friction_rise", "static_rise", "stribeck", "y_measured",
}  # fmt: skip
_HALF_WIDTH = 0.004  # s: takes most of the sensor noise out of the force and nothing out of its course


def momentum_model(model: Model) -> Model:
    """The force-driven twin of a model: piston and all that acts on it, without valve, chambers or what reads pressures."""
    if model.force_driven:
        return model
    kept = [name for name in model.effects if _mechanical(model.library.find(name))]
    frame = ("piston", "air")
    sections = {*frame, *kept}
    values = {name: value for name, value in model.parameters.items() if name.partition(".")[0] in sections}
    return Model.build(kept, values, name=model.name, library=model.library, frame=frame)


def _mechanical(effect: type[Effect]) -> bool:
    function = effect.functions.get("equations")
    if function is None:
        return False
    writes = {name for name in function.writes if not name.startswith(("der_", "rate_"))}
    return writes <= _MECHANICAL and not {"p_a", "p_b", "opening", "spool", "voltage", "U"} & set(function.reads)


def momentum_run(model: Model, run: Run) -> Run:
    """The same run, driven by the force A_a p_a - A_b p_b [N] of its measured pressures."""
    if run.force_driven:
        return run
    a, b = run.signals["pressure_a_pa"], run.signals["pressure_b_pa"]
    drive = smooth(model["piston.area_a"] * a - model["piston.area_b"] * b, run.sample_time, _HALF_WIDTH, 2)
    inner = (np.arange(PARTS) + 0.5) / PARTS
    cells = drive[:-1, None] + inner * np.diff(drive)[:, None]
    return replace(run, pressure_a=None, pressure_b=None, input=cells.ravel(), force_driven=True)
