"""Idle parts of a run: a stuck piston, a sensor that repeats one value, commands that do not change.

The run stays usable, so these are notes. A pressure sensor that shows no motion at all is an error.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import holding_force
from pneumo_ros.equations.equations import drive_along
from pneumo_ros.equations.guess import resting_states
from pneumo_ros.plant import Model
from pneumo_ros.reading.steady import check_steady, travel
from pneumo_ros.runs.noise import noise_level, resolution
from pneumo_ros.runs.run import Run
from pneumo_ros.units import shown

Array = NDArray[np.float64]

LONG = 5.0  # s: a running axis breaks away sooner, except for voltages at the edge of the dead zone
_BLOCK = 0.05  # s
_STILL = 1e-4  # m: bristles and noise move a piston at rest by less
# fillings of a chamber from atmosphere to supply pressure: 0.3 breaks a piston away, but a valve that differs by
# 0.3 V from the model passes 0.13 more each second
_FILLS, _LATER, _FEWER = 1.2, 8.0, 0.6  # fillings after LONG; s, and fillings after them
_EDGE = 2e-3  # m from the end of the stroke
_HANGS, _SLOWEST = (
    1.0,
    5e-3,
)  # s of one value without noise; s between samples: slower ones do not show noise
_USUALLY = 0.999  # share of the steps from sample to sample that count as usual ones
_SETTLES, _JUMP = 3, 2.0  # samples over which a filter spreads a jump; times the usual steps in them
_BEFORE = 20  # samples before a hang that lasts to the end
_TRAVEL = 0.05  # m both ways
_UNITS = {"position_m": "m", "pressure_a_pa": "Pa", "pressure_b_pa": "Pa"}
_TOPICS = {"position_m": "the position", "pressure_a_pa": "chamber_a/pressure", "pressure_b_pa": "chamber_b/pressure"}


def idle_notes(model: Model, run: Run) -> list[str]:
    """Sentences on idle parts of `run`. Raises DataError for a pressure that does not change (see `check_steady`)."""
    if not run.force_driven or run.by_pressures:
        check_steady(model, run)
    known = {name: signal for name, signal in run.signals.items() if name not in run.assumed}
    hung = {name: found for name, signal in known.items() if (found := _hung(run, signal))}
    notes = [
        f"{_TOPICS[name]} repeats {run.signals[name][start]:.6g} {shown(_UNITS[name])} without any noise "
        f"{_span(run, start, stop)}: its sensor or driver hung; leave this part out, or expect errors there"
        for name, (start, stop) in hung.items()
    ]
    if model.imposed:
        return notes
    commands = _commands(run) if model.has_valve else ()
    return [*notes, *_rests(model, run, *hung.get("position_m", (0, 0))), *commands]


def _hung(run: Run, signal: Array) -> tuple[int, int] | None:
    """Start and stop of the longest stretch in which a signal repeats one value, although it has noise elsewhere."""
    changes = np.concatenate([[0], np.flatnonzero((np.diff(signal) != 0.0) | ~run.measured[1:]) + 1, [len(run)]])
    longest = int(np.argmax(np.diff(changes)))
    start, stop = int(changes[longest]), int(changes[longest + 1])
    if (stop - start) * run.sample_time < _HANGS or run.sample_time > _SLOWEST or stop - start == len(run):
        return None
    rest = np.delete(signal, slice(start, stop))
    floor = max(resolution(rest) / np.sqrt(12.0), 1e-6 * float(np.ptp(rest)))  # of a signal without noise
    return (start, stop) if noise_level(rest) > 1.5 * floor and _jumps(signal, start, stop) else None


def _jumps(signal: Array, start: int, stop: int) -> bool:
    """Whether a signal leaves the value that it repeats by more than it ever moves in a sample, or was moving before.

    A counter at rest repeats its value, too, and goes on from there.
    """
    steps = np.abs(np.diff(signal))
    largest = float(np.quantile(np.delete(steps, slice(max(start - 1, 0), stop)), _USUALLY))
    if stop < len(signal):
        after = signal[stop : stop + _SETTLES]
        return bool(np.abs(after - signal[start]).max() > _JUMP * len(after) * largest)
    before = signal[max(start - _BEFORE, 0) : start + 1]
    moved = np.abs(before[-1] - before[0]) / max(len(before) - 1, 1)
    return bool(moved > 0.1 * largest)


def _rests(model: Model, run: Run, since: int, until: int) -> Iterator[str]:
    """Notes on rests that are too long for a breakaway, and on a piston that never moves.

    Between the samples `since` and `until` the position sensor is known to hang.
    """
    width = min(max(round(_BLOCK / run.sample_time), 1), len(run))
    still = _STILL + 6.0 * run.noise["position_m"]
    blocks = run.position[: len(run) // width * width].reshape(-1, width).mean(axis=1)
    if np.ptp(blocks) < still:
        yield (
            f"the piston does not move: its position stays at {np.mean(blocks):.4g} {shown('m')} within "
            f"{1e3 * np.ptp(blocks):.2g} {shown('mm')} for {run.time[-1]:.3g} s, so friction "
            "cannot be judged; if it did move, "
            "look at the position sensor"
        )
        return
    for first, last in _quiet(blocks, still):
        start, stop = first * width, last * width
        hangs = min(stop, until) - max(start, since) > 0.8 * (stop - start)
        if hangs or (stop - start) * run.sample_time < LONG:
            continue
        if why := _pushed(model, run, start, stop):
            yield (
                f"the piston does not move {_span(run, start, stop)}, at "
                f"{run.position[start]:.4g} {shown('m')}, although {why}: "
                "it is stuck or held by something that the model lacks, or its position sensor hangs, or the valve "
                "does not open as in the model; this part is used like the rest"
            )


def _quiet(blocks: Array, still: float) -> Iterator[tuple[int, int]]:
    """Stretches (first, last + 1) of block means that stay within `still`, one after another."""
    first, low, high = 0, np.inf, -np.inf
    for at, value in enumerate([*blocks.tolist(), np.inf]):
        low, high = min(low, value), max(high, value)
        if high - low > still:
            yield first, at
            first, low, high = at, value, value


def _pushed(model: Model, run: Run, start: int, stop: int) -> str:
    """The force or flow that should have moved the piston during a rest, in words; empty if none."""
    if abs(run.position[start]) > 0.5 * model["piston.stroke"] - _EDGE:
        return ""
    static = model.parameters.get("lugre_friction.static_friction", np.inf)
    force = _force(model, run)[start:stop]
    pushing = float(np.sum(np.abs(force) > 1.5 * static)) * run.sample_time
    if pushing > 0.5 * LONG:
        return f"{np.max(np.abs(force)):.3g} {shown('N')} push it, against {static:.3g} {shown('N')} of static friction"
    fewest = _FILLS if (stop - start) * run.sample_time < _LATER else _FEWER
    if model.has_valve and (fills := _fills(model, run, start, stop)) > fewest:
        return f"the valve passes {fills:.1f} times the air that fills a chamber"
    return ""


def _force(model: Model, run: Run) -> Array:
    """Force that friction holds while the piston rests (n,) [N]."""
    if model.force_driven:
        return drive_along(model, run, resting_states(model, run))
    return holding_force(model, run)


def _fills(model: Model, run: Run, start: int, stop: int) -> float:
    """How often the valve would fill the largest chamber, and empty another, at half the supply's pressure in all."""
    supply, atmosphere = model["air.supply_pressure"], model["air.atmospheric_pressure"]
    half, y = 0.5 * (supply + atmosphere), float(run.position[start])
    states = np.tile(model.state(y=y, **{one.state: half for one in model.chambers}), (stop - start, 1))
    seen = model.outputs(states, run.sampled(model.inputs)[start:stop], sample_time=run.sample_time)
    flow = np.mean([one.way * seen[one.flow] for one in model.chambers], axis=0)
    passed = np.cumsum(flow) * run.sample_time
    largest = max(model[one.volume] + one.way * model[one.area] * y for one in model.chambers)
    gas = model["air.gas_constant"] * model["air.temperature"]
    return float(np.ptp(passed)) * gas / ((supply - atmosphere) * largest)


def _commands(run: Run) -> Iterator[str]:
    """A note if the piston moves both ways after the last change of the command."""
    changes = np.flatnonzero(np.diff(run.held)) + 1
    last = int(changes[-1]) if len(changes) else 0
    out, back = travel(run, last)
    if min(out, back) > _TRAVEL:
        when = f"after {run.time[last]:.3f} s" if last else "at all"
        yield (
            f"valve/command does not change {when}, held at {run.held[-1]:.4g} V, while the "
            f"piston travels {out:.3g} {shown('m')} "
            f"out and {back:.3g} {shown('m')} back: it may not drive the valve; flows and "
            "pressures cannot be judged then"
        )


def _span(run: Run, start: int, stop: int) -> str:
    return f"for {(stop - start) * run.sample_time:.1f} s from {run.time[start]:.3f} s on"
