"""How long a stroke takes: predicted by a machine, and the band that the intervals of its figures leave."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.parts import assemble
from pneumo_ros.parts.design import Design
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import SECOND, mirrored

Array = NDArray[np.float64]
ALMOST = 0.98  # of the stroke counts as the whole: what remains is the end's affair
LIMIT = 5.0  # s; a longer stroke counts as infinite
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


def drawn(made: Design, count: int, seed: int = 0) -> Array:
    """Parameter vectors (count, parameters) of machines whose figures lie anywhere in the intervals of their sources.

    The parameters of a machine are drawn together: a valve of published flow that opens more steeply has less of it at
    signals beyond the full one. Their deviations by themselves do not say so.
    """
    names, random = list(made.model.parameters), np.random.default_rng(seed)
    ends = [(made.model.specification(n).low, made.model.specification(n).high) for n in names]
    low, high = np.array(ends).T
    found = np.tile(made.model.values, (count, 1))
    for row in found:
        figures = {key: float(random.uniform(one.low, one.high)) for key, one in made.order.figures.items()}
        for name, value in assemble.parameters(made.order, made.order.nominal | figures).items():
            if name in made.model.uncertainty:
                row[names.index(name)] = value
    return np.clip(found, low, high)


def band(made: Design, signal: float, count: int = 400, seed: int = 0) -> tuple[float, float, float]:
    """Predicted stroke time [s] at a full `signal` [V], and the ends of the band that holds 95 % of `drawn`."""
    times = np.sort(stroke_times(made.model, signal, drawn(made, count, seed)))
    low, high = times[round(0.025 * (count - 1))], times[round(0.975 * (count - 1))]
    return float(stroke_times(made.model, signal)[0]), float(low), float(high)


def _closed(model: Model) -> float:
    return -model.parameters.get("valve_null_offset.offset", 0.0)
