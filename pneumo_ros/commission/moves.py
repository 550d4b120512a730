"""Moves that a commissioning may choose from, and machines as they may be."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.experiment import constant_voltage, excitation, telling
from pneumo_ros.experiment.beside import counted_from
from pneumo_ros.experiment.programme import MAX_VOLTAGE, Programme
from pneumo_ros.experiment.room import dead_zone
from pneumo_ros.experiment.voltages import Constant, Ramps, Steps, Sweep, Voltage
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import centred, closed_signal
from pneumo_ros.shooting.physical import physical

Array = NDArray[np.float64]
Dead = tuple[float, float]  # V from closed at which the valve begins to open, right and left, both positive

SECONDS = 8.0  # of a move
CREEP, SLOW, MODERATE, FAST, WIDE_OPEN = 0.015, 0.12, 0.5, 1.5, 6.2  # V beyond the dead zone
DRAWN = 4  # machines, as they may be, that a move is rehearsed on
VAGUE = 0.3  # of its value: a deviation beyond which a positive parameter is known by a factor only
TIED = 0.9  # correlation beyond which parameters are known together only
REDRAWN = 20  # times that a machine which cannot be is drawn anew
PATIENCE = 6.0  # s until a piston breaks away


def static(model: Model) -> Programme:
    """Constant voltages both ways, from slow to moderate: friction, dead zone and flow, before anything fast."""
    right, left = dead_zone(centred(model))
    made = constant_voltage.constant_voltage(
        centred(model), [round(0.5 * (right + left) + beyond, 3) for beyond in (0.25, MODERATE, 1.0)], 2.5
    )
    trials = tuple(replace(trial, patience=PATIENCE) for trial in made.trials)
    return counted_from(replace(made, experiment="static", trials=trials), closed_signal(model))


def dynamic(model: Model, seed: int = 0) -> Programme:
    """Random levels and pauses, and cosines of rising frequency."""
    plain = centred(model)
    steps, sweep = excitation.steps(plain, SECONDS, seed), excitation.sweep(plain, SECONDS)
    trials = (steps.trials[0], sweep.trials[0])
    return counted_from(replace(steps, experiment="dynamic", trials=trials), closed_signal(model))


def candidates(model: Model, seed: int) -> list[Programme]:
    """The moves to choose from, each of a few seconds; `seed` draws the random ones anew."""
    plain, closed = centred(model), closed_signal(model)
    made = [
        replace(excitation.steps(plain, SECONDS, seed), experiment="steps"),
        excitation.sweep(plain, SECONDS),
        excitation.slow_reversals(plain, 1.5 * SECONDS),
        telling.fast_reversals(plain, SECONDS),
        _constant(plain, closed, "creep", CREEP),
        _constant(plain, closed, "slow-strokes", SLOW),
        _constant(plain, closed, "strokes", MODERATE),
        _constant(plain, closed, "wide-strokes", MODERATE, wide=True),
        _constant(plain, closed, "fast-strokes", FAST),
        _constant(plain, closed, "wide-open", WIDE_OPEN),
    ]
    single = [one if one.trials[0].direction else replace(one, trials=one.trials[:1]) for one in made]
    return [counted_from(one, closed) for one in single]


def _constant(model: Model, closed: float, name: str, beyond: float, wide: bool = False) -> Programme:
    """A stroke each way at a voltage `beyond` [V] the dead zone of its side; `wide`: all the way between the limits."""
    most, seconds = MAX_VOLTAGE - abs(closed), (1.0 if wide else 0.4) * SECONDS
    volts = [round(min(edge + beyond, most), 3) for edge in dead_zone(model)]
    to_right, to_left = (constant_voltage.constant_voltage(model, [one], seconds) for one in volts)
    trials = tuple(
        replace(trial, patience=PATIENCE, travel=2.0 * to_right.high if wide else trial.travel)
        for trial in (to_right.trials[0], to_left.trials[1])
    )
    return replace(to_right, experiment=name, trials=trials)


def drawn(
    model: Model, deviations: dict[str, float], count: int, seed: int = 0, correlation: Array | None = None
) -> list[Model]:
    """Machines as they may be: parameters drawn within their deviations, inside their ranges.

    correlation (parameters, parameters), in the order of `deviations`: where a valve opens may be known to a millivolt,
    and the width of its dead zone and its null offset, which together say so, each to a tenth of a volt.
    """
    random = np.random.default_rng(seed)
    names = tuple(deviations)
    middle = np.array([model[name] for name in names])
    wide = np.array([deviations[name] for name in names])
    low, high = (np.array([getattr(model.specification(n), side) for n in names]) for side in ("low", "high"))
    together = np.eye(len(names)) if correlation is None else correlation
    strength, ways = np.linalg.eigh(together)
    tied = np.max(np.abs(together - np.eye(len(names))), axis=0, initial=0.0) > TIED
    found: list[Model] = []
    for _ in range(REDRAWN * count):
        share = ways @ (np.sqrt(np.maximum(strength, 0.0)) * random.normal(size=len(names)))
        values = _around(middle, wide, share, low, tied)
        inside = np.clip(values, low, high)
        if np.any((inside != values) & tied):  # what goes with it would have to stay inside, too
            continue
        inside = physical(model, names, inside)
        one = model.with_parameters(dict(zip(names, inside.tolist(), strict=True)))
        try:
            one.state()
        except UsageError:  # a chamber without volume at its end
            continue
        found.append(one)
        if len(found) == count:
            break
    return found


def _around(middle: Array, wide: Array, share: Array, low: Array, tied: NDArray[np.bool_]) -> Array:
    """Values `share` deviations away; what is positive, hardly known and not tied is drawn by its logarithm."""
    by_factor = (low >= 0.0) & (middle > 0.0) & (wide > VAGUE * middle) & ~tied
    factor = np.exp(share * np.log1p(wide / np.where(by_factor, middle, 1.0)))
    return np.where(by_factor, middle * factor, middle + wide * share)


def narrowest(machines: Sequence[Model]) -> Dead:
    """The narrowest dead zone of all machines, each side by itself: less than that moves none of them."""
    right, left = zip(*(dead_zone(centred(one)) for one in machines), strict=True)
    return min(right), min(left)


def smaller(programme: Programme, dead: Dead, share: float) -> Programme:
    """The programme with `share` of each voltage beyond the dead zone."""
    return programme if share == 1.0 else returning(_gentler(programme, dead, share), dead, share)


def reaching(programme: Programme, dead: Dead, most: float) -> Programme:
    """The programme with voltages of its trials of at most `most` [V] beyond the dead zone."""
    beyond = max(one.voltage.largest for one in programme.trials) - min(dead)
    return programme if beyond <= most else _gentler(programme, dead, most / beyond)


def _gentler(programme: Programme, dead: Dead, share: float) -> Programme:
    """The programme with `share` of the voltages of its trials beyond the dead zone, the way back as it is."""
    trials = tuple(replace(one, voltage=_less(one.voltage, dead, share)) for one in programme.trials)
    return replace(programme, trials=trials)


def returning(programme: Programme, dead: Dead, share: float) -> Programme:
    """The programme with `share` of the voltages beyond the dead zone that take the piston back, trials as they are."""
    right = _less(Constant(programme.return_right), dead, share).largest
    left = _less(Constant(-programme.return_left), dead, share).largest
    most = MAX_VOLTAGE - abs(programme.closed)
    return replace(programme, return_right=min(right, most), return_left=min(left, most))


def _less(voltage: Voltage, dead: Dead, share: float) -> Voltage:
    def less(volts: float) -> float:
        edge = dead[0] if volts > 0.0 else dead[1]
        beyond = abs(volts) - edge
        return volts if beyond <= 0.0 else float(np.copysign(round(edge + share * beyond, 4), volts))

    if isinstance(voltage, Constant):
        return Constant(less(voltage.volts))
    if isinstance(voltage, Steps):
        return Steps(tuple((seconds, less(volts)) for seconds, volts in voltage.levels))
    if isinstance(voltage, Sweep):
        return replace(voltage, amplitude=less(voltage.amplitude))
    assert isinstance(voltage, Ramps)
    return replace(voltage, volts=less(voltage.volts))
