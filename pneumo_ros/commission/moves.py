"""Moves that a commissioning may choose from, made safe for what is not known yet of the machine."""

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.experiment import constant_voltage, excitation, telling
from pneumo_ros.experiment.beside import counted_from
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.rehearsal import rehearse
from pneumo_ros.experiment.room import dead_zone
from pneumo_ros.experiment.voltages import Constant, Ramps, Steps, Sweep, Voltage
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import centred, closed_signal
from pneumo_ros.shooting.physical import physical

Array = NDArray[np.float64]
Dead = tuple[float, float]  # V from closed at which the valve begins to open, right and left, both positive

SECONDS = 8.0  # of a move
SLOW, MODERATE, FAST = 0.12, 0.5, 1.5  # V beyond the dead zone
MORE = 1.8  # factor of the voltages beyond the dead zone where the piston did not move
DRAWN = 4  # machines, as they may be, that a move is rehearsed on
LESS, FEWEST = 0.6, 0.05  # a move that would leave the limits is tried with this share of its voltages; smallest share
ROOMS = (1.0, 0.6, 0.35)  # of the way between the limits, where less voltage does not help: a jump takes its way
VAGUE = 0.3  # of its value: a deviation beyond which a positive parameter is known by a factor only
REDRAWN = 20  # times that a machine which cannot be is drawn anew
CLEAR = 0.95  # of the way to the end stop, beyond which no rehearsed piston may come
LATE = 0.012  # s between two decisions of a rehearsal: a rig's commands come as late
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
    right, left = dead_zone(plain)
    edge = 0.5 * (right + left)
    made = [
        replace(excitation.steps(plain, SECONDS, seed), experiment="steps"),
        excitation.sweep(plain, SECONDS),
        excitation.slow_reversals(plain, 1.5 * SECONDS),
        telling.fast_reversals(plain, SECONDS),
        *(
            replace(_constant(plain, edge + beyond), experiment=name)
            for name, beyond in (("slow-strokes", SLOW), ("strokes", MODERATE), ("fast-strokes", FAST))
        ),
    ]
    single = [one if one.trials[0].direction else replace(one, trials=one.trials[:1]) for one in made]
    return [counted_from(one, closed) for one in single]


def _constant(model: Model, volts: float) -> Programme:
    made = constant_voltage.constant_voltage(model, [round(volts, 3)], 0.4 * SECONDS)
    return replace(made, trials=tuple(replace(trial, patience=PATIENCE) for trial in made.trials))


def drawn(model: Model, deviations: dict[str, float], count: int, seed: int = 0) -> list[Model]:
    """Machines as they may be: parameters drawn within their deviations, inside their ranges."""
    random = np.random.default_rng(seed)
    names = tuple(deviations)
    middle = np.array([model[name] for name in names])
    wide = np.array([deviations[name] for name in names])
    low, high = (np.array([getattr(model.specification(n), side) for n in names]) for side in ("low", "high"))
    found: list[Model] = []
    for _ in range(REDRAWN * count):
        values = _around(middle, wide, random.normal(size=len(names)), low, high)
        values = physical(model, names, values)
        one = model.with_parameters(dict(zip(names, values.tolist(), strict=True)))
        try:
            one.state()
        except UsageError:  # a chamber without volume at its end
            continue
        found.append(one)
        if len(found) == count:
            break
    return found


def _around(middle: Array, wide: Array, share: Array, low: Array, high: Array) -> Array:
    """Values `share` deviations away; what is positive and hardly known is drawn by its logarithm."""
    by_factor = (low >= 0.0) & (middle > 0.0) & (wide > VAGUE * middle)
    factor = np.exp(share * np.log1p(wide / np.where(by_factor, middle, 1.0)))
    return np.clip(np.where(by_factor, middle * factor, middle + wide * share), low, high)


def safe(programme: Programme, machines: Sequence[Model]) -> Programme | None:
    """The programme with voltages small enough that none of `machines` reaches an end stop; None where none are.

    They keep clear of it if they can. A piston whose friction at rest is a multiple of that in motion jumps as far at
    any voltage, and hardly open valves brake it less: it turns nearer to mid stroke.
    """
    dead = narrowest(machines)
    shares = [LESS**k for k in range(1 + int(np.log(FEWEST) / np.log(LESS)))]
    for clear, room, share in itertools.product((CLEAR, 1.0), ROOMS, shares):
        tried = replace(smaller(programme, dead, share), low=room * programme.low, high=room * programme.high)
        if not any(_reaches_end(tried, machine, clear) for machine in machines):
            return tried
    return None


def _reaches_end(programme: Programme, machine: Model, clear: float) -> bool:
    """Whether the piston goes beyond a share of the way to an end stop, where commands come late as on a rig."""
    turns = max(abs(programme.low), abs(programme.high))  # where a trial turns: short of the end, however near
    nearer = replace(programme, end=max(clear * programme.end, 0.5 * (turns + programme.end)))
    try:
        return "end stop" in rehearse(nearer, machine, sample=LATE).aborted
    except NumericalError:  # stiffer than the steps of the integration: no machine to plan for
        return False


def narrowest(machines: Sequence[Model]) -> Dead:
    """The narrowest dead zone of all machines, each side by itself: less than that moves none of them."""
    right, left = zip(*(dead_zone(centred(one)) for one in machines), strict=True)
    return min(right), min(left)


def smaller(programme: Programme, dead: Dead, share: float) -> Programme:
    """The programme with `share` of each voltage beyond the dead zone."""
    if share == 1.0:
        return programme
    trials = tuple(replace(one, voltage=_less(one.voltage, dead, share)) for one in programme.trials)
    right = _less(Constant(programme.return_right), dead, share).largest
    left = _less(Constant(-programme.return_left), dead, share).largest
    return replace(programme, trials=trials, return_right=right, return_left=left)


def other(reason: str) -> float | None:
    """The share of its voltages with which to try a programme again that was ended for `reason`; None: not at all."""
    return LESS if "end stop" in reason else MORE if "stays at" in reason else None


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
