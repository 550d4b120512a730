"""The pressure of a supply that several axes share, from what all of them draw along their measured motion.

tau d' = R q - d (a tank behind a resistance, Beater 2007), with the flow q that the models' valves let pass at the
measured chamber pressures. That flow depends on the drop d, so d is the fixed point of this loop.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.multiaxis.drawing import DRAWN, MEASURED, drawing_model
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.sensors import driven

Array = NDArray[np.float64]
ROUNDS = 40  # of the fixed point, at most
ENOUGH = 20.0  # Pa: less than any sensor of such a supply shows
SURE = 1e-3  # of the supply pressure: a difference of the start that no longer matters


@dataclass(frozen=True)
class Timed:
    """The run of one axis and when it begins [s], on a clock that all axes of its recording share."""

    begin: float
    run: Run
    model: Model

    @property
    def time(self) -> Array:
        """Times of the samples (n,) on the common clock [s]."""
        return self.begin + self.run.time

    @property
    def pressure(self) -> float:
        """The supply pressure of this axis without a drop [Pa]."""
        return self.model["air.supply_pressure"]

    def supplied(self, drop: Array) -> "Timed":
        """The same with `drop` (n,) [Pa] below its supply pressure as the supply's measured pressure."""
        held = self.pressure - np.repeat(0.5 * (drop[:-1] + drop[1:]), PARTS)
        further = {**self.run.further, MEASURED: held}
        return replace(self, run=replace(self.run, further=further, computed=frozenset({MEASURED})))

    def measured_from(self, time: float) -> "Timed":
        """The same with the samples before `time` [s] as not measured; itself where there are none."""
        late = self.time >= time
        return self if late.all() else replace(self, run=replace(self.run, measured=self.run.measured & late))

    def drawn(self) -> Array:
        """Mean mass flow (n - 1,) that this axis draws in each interval [kg/s], at its supply pressure as held."""
        model = drawing_model(self.model)
        _, rates = driven(model, measured_frame(self.run, model.chambers), self.run)
        return np.asarray(rates[1:, model.states.index(DRAWN)])


def supplied(axes: Mapping[str, Timed], line: Mapping[str, float], first: Array | None = None) -> dict[str, Timed]:
    """The axes of one recording with the supply's pressure that `line` gives; `first` (n,): a guess of the drop.

    line: resistance_supply [Pa s/kg] and time_constant [s]. The drop begins with that of the flow at the start. Where
    that is no rest, what the axes drew before is not known: samples count as not measured until it does not matter.
    """
    grid = next(iter(axes.values()))
    drop = np.zeros(len(grid.run)) if first is None else first
    damping = 1.0
    for _ in range(ROUNDS):
        now = {name: one.supplied(np.interp(one.time, grid.time, drop)) for name, one in axes.items()}
        new = drop_of(drawn_together(now, grid), grid.run.sample_time, line)
        change = float(np.abs(new - drop).max())
        if change < ENOUGH:
            break
        if damping == 1.0 and change > 0.0 and not drop.any():  # the loop's gain R dq/dp, by its first round
            damping = 1.0 / (1.0 + line["resistance_supply"] * _slope(axes, now, new, grid))
        drop = drop + damping * (new - drop)
    found = {name: one.supplied(np.interp(one.time, grid.time, drop)) for name, one in axes.items()}
    sure = _sure_from(found, drop, grid, line)
    return {name: one.measured_from(sure) for name, one in found.items()}


def _sure_from(axes: Mapping[str, Timed], drop: Array, grid: Timed, line: Mapping[str, float]) -> float:
    """The time [s] from which a start at any other drop of the recording gives the same, within SURE of the supply.

    A difference d of the drop decays as tau d' = -(1 + R s) d, where the axes draw s less per pascal.
    """
    sure, spread = SURE * grid.pressure, float(drop.max() - drop.min())
    if drop[0] < sure or spread < sure:  # it begins at rest: the supply is full
        return float(grid.time[0])
    more = {name: one.supplied(np.interp(one.time, grid.time, drop) + sure) for name, one in axes.items()}
    slope = np.maximum(drawn_together(axes, grid) - drawn_together(more, grid), 0.0) / sure
    rate = (1.0 + line["resistance_supply"] * slope) / line["time_constant"]
    left = spread * np.exp(-np.cumsum(rate) * grid.run.sample_time)
    index = min(int(np.argmax(left < sure)) if (left < sure).any() else len(left), len(left) // 2)
    return float(grid.time[index + 1])


def _slope(axes: Mapping[str, Timed], full: Mapping[str, Timed], drop: Array, grid: Timed) -> float:
    """By how much less all axes draw, per pascal that the supply drops [kg/(s Pa)], at the largest drop."""
    size = 0.1 * float(drop.max())
    lower = {name: one.supplied(np.full(len(one.run), size)) for name, one in axes.items()}
    less = drawn_together(full, grid) - drawn_together(lower, grid)
    return max(float(less.max()), 0.0) / size


def drawn_together(axes: Mapping[str, Timed], grid: Timed) -> Array:
    """Mass flow (n - 1,) of all axes in the intervals of `grid` [kg/s]."""
    middle = 0.5 * (grid.time[:-1] + grid.time[1:])
    return np.asarray(
        sum(np.interp(middle, 0.5 * (one.time[:-1] + one.time[1:]), one.drawn()) for one in axes.values())
    )


def drop_of(flow: Array, step: float, line: Mapping[str, float]) -> Array:
    """Drop (n,) [Pa] for mean flows (n - 1,) between samples `step` [s] apart."""
    from scipy.signal import lfilter  # slow to import, and seldom needed

    stays = float(np.exp(-step / line["time_constant"]))
    target = line["resistance_supply"] * flow
    later, _ = lfilter([1.0 - stays], [1.0, -stays], target, zi=[stays * target[0]])
    return np.concatenate([target[:1], later])
