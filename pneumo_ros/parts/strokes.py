"""How long a stroke takes: predicted by a machine, and the band that its stated uncertainty leaves."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import SECOND, mirrored

Array = NDArray[np.float64]
ALMOST = 0.98  # of the stroke counts as the whole: what remains is the end's affair
LIMIT = 5.0  # s; a longer stroke counts as infinite
LEAST = 0.1  # of its value: friction may be far less than a rule says, but it does not vanish
SAMPLE, STEP = 1e-3, 1e-4  # s


def stroke_times(model: Model, signal: float, parameters: Array | None = None) -> Array:
    """Seconds (lanes,) of a stroke at a full `signal` [V] from the end where the opposite one has held the piston.

    parameters (lanes, parameters): by default those of the model. Infinite where the piston does not arrive within 5 s.
    """
    q = model.values[None, :] if parameters is None else np.asarray(parameters, dtype=float)
    out = signal > _closed(model)
    names = list(model.parameters)
    supply, stroke = q[:, names.index("air.supply_pressure")], q[:, names.index("piston.stroke")]
    x = np.tile(model.state(), (len(q), 1))
    side = -1.0 if out else 1.0
    x[:, model.states.index("y")] = side * 0.5 * stroke
    x[:, model.states.index("p_b" if out else "p_a")] = supply
    samples = round(LIMIT / SAMPLE)
    voltage = np.full(samples, signal)
    if SECOND in model.inputs:
        voltage = np.column_stack([voltage, mirrored(model, voltage)])
    column = [model.states.index("y")]
    y = model.simulate_lanes(voltage, x, q, sample_time=SAMPLE, step=STEP, columns=column)[:, :, 0]
    way = -side * y / stroke[:, None] + 0.5
    arrived = way >= ALMOST
    return np.where(arrived.any(axis=1), (arrived.argmax(axis=1) + 1) * SAMPLE, np.inf)


def drawn(model: Model, count: int, seed: int = 0) -> Array:
    """Parameter vectors (count, parameters) drawn from normal distributions of the model's stated uncertainty.

    A size that cannot be negative keeps at least a tenth of its value, a chamber of its volume beyond the end of the
    stroke; what leaves its range is put at the end.
    """
    names, random = list(model.parameters), np.random.default_rng(seed)
    q = np.tile(model.values, (count, 1))
    for name, deviation in model.uncertainty.items():
        one, value, k = model.specification(name), model[name], names.index(name)
        least = max(one.low, _least(model, name)) if one.low >= 0.0 else one.low
        q[:, k] = np.clip(value + deviation * random.standard_normal(count), least, one.high)
    return q


def _least(model: Model, name: str) -> float:
    swept = 0.0
    for chamber in model.chambers:
        if name == chamber.volume:
            swept = 0.5 * model["piston.stroke"] * model[chamber.area]
    return swept + LEAST * (model[name] - swept)


def band(model: Model, signal: float, count: int = 400, seed: int = 0) -> tuple[float, float, float]:
    """Predicted stroke time [s] at a full `signal` [V], and the ends of its 95 % band."""
    times = np.sort(stroke_times(model, signal, drawn(model, count, seed)))
    low, high = times[round(0.025 * (count - 1))], times[round(0.975 * (count - 1))]
    return float(stroke_times(model, signal)[0]), float(low), float(high)


def _closed(model: Model) -> float:
    return -model.parameters.get("valve_null_offset.offset", 0.0)
