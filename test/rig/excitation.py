"""The motions of a rig while it is recorded: the runs of a case, by name."""

import zlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .loop import SAMPLE

Rng = np.random.Generator
_LIMIT = 0.62  # m: beyond it the voltage is turned inwards
_NO_LIMIT = 10.0
_START_PRESSURE = 1.6e5


class Programme(NamedTuple):
    """One run: voltage (n,) [V], or position wanted (n,) [m] where not NaN; where and how full it starts; the guard."""

    voltage: np.ndarray
    wanted: np.ndarray
    position: float
    pressure: float
    limit: float


def _open_loop(
    voltage: np.ndarray, position: float, pressure: float = _START_PRESSURE, limit: float = _LIMIT
) -> Programme:
    return Programme(voltage, np.full(len(voltage), np.nan), position, pressure, limit)


def _time(seconds: float) -> np.ndarray:
    return np.arange(round(seconds / SAMPLE)) * SAMPLE


def constant(volts: float) -> Programme:
    """A voltage held from rest near the end it moves away from, after 0.3 s of closed valve; longer where it creeps."""
    slow = abs(volts)
    time = _time(25.0 if slow < 0.79 else 15.0 if slow < 0.85 else 8.0)
    return _open_loop(np.where(time < 0.3, 0.0, volts), -0.9 * np.sign(volts), 1.2e5, _NO_LIMIT)


def steps(rng: Rng, seconds: float = 20.0) -> Programme:
    """Random levels of 0.8 to 3 V for 0.25 to 1.6 s each, some of them pauses."""
    time, level, change = _time(seconds), 0.0, 0.0
    voltage = np.empty_like(time)
    for k, t in enumerate(time):
        if t >= change:
            change = t + rng.uniform(0.25, 1.6)
            level = 0.0 if rng.random() < 0.12 else rng.choice([-1.0, 1.0]) * rng.uniform(0.8, 3.0)
        voltage[k] = level
    return _open_loop(voltage, rng.uniform(-0.25, 0.25))


def sweep(rng: Rng, seconds: float = 20.0) -> Programme:
    """A sine of 2.2 to 3.4 V rising from about 0.1 to about 0.9 Hz."""
    time, first, last = _time(seconds), rng.uniform(0.08, 0.14), rng.uniform(0.6, 1.1)
    cycles = first * time + 0.5 * (last - first) / seconds * time**2
    voltage = rng.uniform(2.2, 3.4) * np.sin(2.0 * np.pi * (cycles + rng.uniform()))
    return _open_loop(voltage, rng.uniform(-0.25, 0.25))


def slow(rng: Rng, seconds: float = 20.0) -> Programme:
    """A sine of 1.0 to 1.25 V at 0.09 to 0.15 Hz: a little beyond the dead zone, slow reversals."""
    phase = rng.uniform(0.09, 0.15) * _time(seconds) + rng.uniform()
    return _open_loop(rng.uniform(1.0, 1.25) * np.sin(2.0 * np.pi * phase), rng.uniform(-0.3, 0.3))


def creep(rng: Rng, seconds: float = 20.0) -> Programme:
    """A position loop along ramps of 4 to 20 mm/s that turn every 1 to 3 s: stick-slip included."""
    time, start = _time(seconds), rng.uniform(-0.25, 0.25)
    rate, change, sign = np.empty_like(time), 0.0, rng.choice([-1.0, 1.0])
    speed = 0.0
    for k, t in enumerate(time):
        if t >= change:
            change, sign, speed = t + rng.uniform(1.0, 3.0), -sign, rng.uniform(4e-3, 20e-3)
        rate[k] = sign * speed
    return Programme(np.zeros_like(time), start + np.cumsum(rate) * SAMPLE, start, _START_PRESSURE, _LIMIT)


def moves(rng: Rng, seconds: float = 20.0) -> Programme:
    """A position loop along smooth moves of 0.05 to 0.4 m at 0.03 to 0.2 m/s, with pauses, as under a controller."""
    time, start = _time(seconds), rng.uniform(-0.25, 0.25)
    wanted, k, here = np.full_like(time, start), 0, start
    while k < len(time):
        k += round(rng.uniform(0.1, 0.8) / SAMPLE)  # a pause
        to = float(np.clip(here + rng.choice([-1.0, 1.0]) * rng.uniform(0.05, 0.4), -0.5, 0.5))
        samples = round(max(abs(to - here) / rng.uniform(0.03, 0.2), 0.2) / SAMPLE)
        way = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, samples))
        part = wanted[k : k + samples]
        part[:] = here + (to - here) * way[: len(part)]
        wanted[k + samples :] = to
        k, here = k + samples, to
    return Programme(np.zeros_like(time), wanted, start, _START_PRESSURE, _LIMIT)


def ends(rng: Rng, seconds: float = 48.0) -> Programme:
    """From end to end at 1.5 to 4 V, held against the end for a while."""
    time, change, level = _time(seconds), 0.0, rng.choice([-1.0, 1.0])
    voltage = np.empty_like(time)
    for k, t in enumerate(time):
        if t >= change:
            change, level = t + rng.uniform(15.0, 18.0), -np.sign(level) * rng.uniform(1.5, 4.0)
        voltage[k] = level
    return _open_loop(voltage, -0.5 * np.sign(voltage[0]), limit=_NO_LIMIT)


_DRAWN: dict[str, Callable[[Rng], Programme]] = {
    "train_steps": steps,
    "train_sweep": sweep,
    "train_slow": slow,
    "train_creep": creep,
    "holdout_steps": steps,
    "holdout_sweep": lambda rng: sweep(rng, 15.0),
    "holdout_slow": lambda rng: slow(rng, 15.0),
    "train_moves": moves,
    "holdout_moves": moves,
    "holdout_creep": creep,
    "train_ends": ends,
    "holdout_ends": ends,
}
STAIRCASE = (0.785, 0.8, 0.83, 0.88, 0.95, 1.1, 1.5, 7.0)


def constant_name(volts: float) -> str:
    """constant_p1100 for +1.100 V, constant_m1100 for -1.100 V."""
    return f"constant_{'p' if volts > 0.0 else 'm'}{abs(round(1000.0 * volts)):04d}"


_CONSTANT = {constant_name(sign * volts): sign * volts for volts in STAIRCASE for sign in (1.0, -1.0)}
ALL_RUNS = (*_CONSTANT, *_DRAWN)
RUNS = (
    *(constant_name(sign * volts) for volts in (0.83, 1.1, 7.0) for sign in (1.0, -1.0)),
    *("train_steps", "train_sweep", "train_slow", "train_creep", "holdout_steps", "holdout_sweep", "holdout_slow"),
)


def _several(*given: str) -> tuple[str, ...]:
    """`steps4` is train_steps, train_steps2, ..., holdout_steps and holdout_steps2: a third is held out."""
    found = []
    for text in given:
        kind, count = text[:-1], int(text[-1])
        found += [f"train_{kind}{k or ''}" for k in (0, *range(2, count + 1))]
        found += [f"holdout_{kind}{k or ''}" for k in (0, *range(2, count // 2 + 1))]
    return tuple(found)


EXCITATIONS = {  # kind of recordings -> their runs
    "usual": RUNS,
    "campaign": (*_CONSTANT, *RUNS[6:]),
    "constants": tuple(_CONSTANT),
    "steps": _several("steps5"),
    "sines": _several("sweep3", "slow3"),
    "moves": _several("moves5"),
    "creeps": _several("creep5"),
    "mixture": ("constant_p0880", "constant_m1500", *_several("steps1", "moves2", "slow1")),
}
_HELD_CONSTANTS = (0.83, 1.5)  # V, held out where nothing but constant voltages is recorded


def held_out(name: str, names: tuple[str, ...]) -> bool:
    """Whether a run of a recording is held out."""
    if any(other.startswith("holdout") for other in names):
        return name.startswith("holdout")
    return abs(_CONSTANT[name]) in _HELD_CONSTANTS


def run_rng(seed: int, name: str) -> Rng:
    """The random numbers of one run of one seed, independent of other runs."""
    return np.random.default_rng([seed, zlib.crc32(name.encode())])


def programme(name: str, rng: Rng) -> Programme:
    """The run of that name, drawn from `rng`; KeyError with the known names if there is none."""
    if name in _CONSTANT:
        return constant(_CONSTANT[name])
    name = name.rstrip("0123456789")  # train_steps2 differs from train_steps by its random numbers alone
    if name not in _DRAWN:
        raise KeyError(f"no run is called {name!r}; known: {', '.join(ALL_RUNS)}")
    return _DRAWN[name](rng)
