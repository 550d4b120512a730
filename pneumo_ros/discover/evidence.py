"""The residuals of all equations along all runs, as one vector: what a candidate has to explain.

Families: the momentum while the piston slides [N], in windows of 100 and 40 ms; the chambers [kg/s], in windows of
200 and 40 ms; and the breakaways [N], the force at slip against the static friction the model claims there and then.
They are written as in `identify.weak`; each comes with the noise that the sensors alone give it.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_coeffs

from pneumo_ros.discover.course import Frame, follow, follow_each, frame_of
from pneumo_ros.identify.breakaway import REST, Breakaway, find_breakaways
from pneumo_ros.identify.bump import Bump
from pneumo_ros.identify.noise import noise_level, run_noise
from pneumo_ros.identify.run import Run, check_position
from pneumo_ros.identify.smooth import smooth
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]

WINDOWS = {"momentum": (0.1, 0.04), "chamber_a": (0.2, 0.04), "chamber_b": (0.2, 0.04)}  # s
SLIDING = 0.01  # m/s
BLOCK = 0.4  # s: errors within a block belong together
_CREEP = 1e-6  # m/s: hardly any velocity, but with a sign


@dataclass(frozen=True)
class Family:
    """Windows of one equation and width in one run; arrays (windows,)."""

    equation: str
    width: float  # s; 0 for breakaways
    run: int
    time: Array
    noise: Array
    usable: NDArray[np.bool_] = field(repr=False)
    bump: Bump | None = field(repr=False, default=None)
    breakaways: tuple[Breakaway, ...] = ()

    @property
    def name(self) -> str:
        """As `momentum 40 ms`, `breakaway`."""
        return f"{self.equation} {1e3 * self.width:.0f} ms" if self.width else self.equation


class Evidence:
    """Residual vectors of variants of a model along fixed runs.

    What does not depend on the variant is made once: windows, their noise, which of them count. Arrays (residuals,):
    family (index into `names`), run and block index of each entry, its time [s], and the noise in the entry's unit.
    """

    def __init__(self, model: Model, runs: Sequence[Run]) -> None:
        self._index([Course(model, run, i) for i, run in enumerate(runs)])

    def only(self, chosen: Sequence[int]) -> tuple["Evidence", NDArray[np.bool_]]:
        """The evidence of some of the runs, by index, and which residuals are theirs."""
        part = object.__new__(Evidence)
        part._index([self.courses[i] for i in sorted(chosen)])
        return part, np.isin(self.run, chosen)

    def _index(self, courses: list["Course"]) -> None:
        self.courses = courses
        self.runs = tuple(course.run for course in courses)
        families = [f for course in self.courses for f in course.families]
        self.noise = np.concatenate([f.noise[f.usable] for f in families])
        counts = [int(f.usable.sum()) for f in families]
        self.names = tuple(dict.fromkeys(f.name for f in families))
        self.family = np.repeat([self.names.index(f.name) for f in families], counts)
        self.run = np.repeat([f.run for f in families], counts)
        self.time = np.concatenate([f.time[f.usable] for f in families])
        self.block = np.unique((self.run * 100000 + self.time / BLOCK).astype(np.int64), return_inverse=True)[1]

    def __len__(self) -> int:
        return len(self.noise)

    def residual(self, model: Model) -> Array:
        """What is measured minus what `model` claims, over noise (residuals,)."""
        return np.asarray(self.residuals(model, model.values[None])[0])

    def residuals(self, model: Model, parameters: Array, threads: int = 2) -> Array:
        """The same for many parameter vectors (variants, parameters) of one model: (variants, residuals)."""
        with ThreadPoolExecutor(threads) as pool:
            parts = list(pool.map(lambda course: course.values(model, parameters), self.courses))
        whole = np.concatenate(parts, axis=1) / self.noise
        return np.asarray(np.nan_to_num(whole, nan=1e9, posinf=1e9, neginf=-1e9))


class Course:
    """One run's part of the evidence."""

    def __init__(self, model: Model, run: Run, index: int) -> None:
        check_position(model, run)
        self.run, self.frame = run, frame_of(run, model.force_driven)
        self.families = _families(model, self.frame, index)
        self.held = np.append(run.held, run.held[-1])
        last = self.families[-1]
        self.breakaways = last.breakaways
        width, reach = max(round(REST / run.sample_time), 2), max(round(0.008 / run.sample_time), 2)
        self.kernel = savgol_coeffs(2 * reach + 1, 2)  # a parabola over +-8 ms
        self.spans = [
            np.arange(max(b.index - width - 2 * reach, 0), min(b.index + 2 * reach + 1, len(run)))
            for b in self.breakaways
        ]
        self.inner = [
            slice(max(b.index - width, 0) - span[0], b.index - span[0] + 1)
            for b, span in zip(self.breakaways, self.spans, strict=True)
        ]
        back = max(round(0.02 / run.sample_time), 1)
        self.rested = np.array([max(b.index - back, 0) for b in self.breakaways], dtype=np.int64)
        self.direction = np.array([b.direction for b in self.breakaways], dtype=float)

    def values(self, model: Model, parameters: Array) -> Array:
        """Residuals (variants, usable windows) in their units, family after family."""
        result = np.empty((len(parameters), sum(int(f.usable.sum()) for f in self.families)))
        for k, states, claimed in follow_each(model, self.frame, parameters):
            parts = [self._value(model, parameters[k], states, claimed, f)[f.usable] for f in self.families]
            result[k] = np.concatenate(parts)
        return result

    def _value(self, model: Model, q: Array, states: Array, claimed: Array, family: Family) -> Array:
        if family.equation == "momentum":
            return self._momentum(model, q, states, claimed, family)
        if family.equation == "breakaway":
            return self._slips(model, q, states)
        return self._chamber(model, states, claimed, family)

    def _see(self, model: Model, q: Array, states: Array, rows: Index) -> dict[str, Array]:
        """What the model with parameters `q` shows at the given states (rows, states) of these samples."""
        out = np.empty((len(rows), len(model.composition.observed)))
        model.kernel.observe(np.ascontiguousarray(states), q, self.held[rows], self.run.time[rows], out)
        return {name: out[:, i] for i, name in enumerate(model.composition.observed)}

    def _momentum(self, model: Model, q: Array, states: Array, claimed: Array, family: Family) -> Array:
        bump = _bump(family)
        rows = bump.centres(len(states))
        mass = model["piston.mass"] + self._see(model, q, states[rows], rows)["added_mass"]
        return np.asarray(mass * (bump.apply(bump.second, states[:, 0]) - bump.apply(bump.phi, claimed[:, 0])))

    def _chamber(self, model: Model, states: Array, claimed: Array, family: Family) -> Array:
        bump, gamma = _bump(family), model["air.heat_capacity_ratio"]
        column, slope, volume, content = _gas(model, family.equation[-1], states[:, 0])
        p = states[:, column]
        rate = claimed[:, column - 1] / p + gamma * slope * states[:, 1] / volume
        value = bump.apply(-bump.first, np.log(p) + gamma * np.log(volume)) - bump.apply(bump.phi, rate)
        return np.asarray(bump.apply(bump.phi, content * p) * value)

    def _slips(self, model: Model, q: Array, states: Array) -> Array:
        """Largest force that friction held before each slip, minus the static friction claimed there and then."""
        if not self.breakaways:
            return np.empty(0)
        rows = np.concatenate(self.spans)
        seen = self._see(model, q, states[rows], rows)
        load = np.split(seen["drive"] - seen["force"], np.cumsum([len(s) for s in self.spans])[:-1])
        largest = [
            max(float((d * np.convolve(part, self.kernel, "same")[inner]).max()), 0.0)
            for part, inner, d in zip(load, self.inner, self.direction, strict=True)
        ]
        there = states[self.rested].copy()
        there[:, 1] = self.direction * _CREEP
        return np.asarray(np.array(largest) - self._see(model, q, there, self.rested)["static_level"])


def _bump(family: Family) -> Bump:
    assert family.bump is not None
    return family.bump


def _families(model: Model, frame: Frame, index: int) -> list[Family]:
    states, claimed = follow(model, frame)
    noise = run_noise(frame.run)
    found = [_momentum_family(model, frame, states, noise, index, width) for width in WINDOWS["momentum"]]
    if not model.force_driven:
        for chamber in ("a", "b"):
            for width in WINDOWS[f"chamber_{chamber}"]:
                found.append(_chamber_family(model, frame, states, claimed, noise, index, chamber, width))
    breakaways = tuple(find_breakaways(model, frame.run)) if "z" in model.states else ()
    spread = np.array([b.spread for b in breakaways])
    time = np.array([b.time for b in breakaways])
    found.append(Family("breakaway", 0.0, index, time, spread, np.ones(len(time), dtype=bool), None, breakaways))
    return found


def _momentum_family(
    model: Model, frame: Frame, states: Array, noise: dict[str, float], index: int, width: float
) -> Family:
    run, bump = frame.run, Bump.of(width, frame.run.sample_time)
    mass, ones = model["piston.mass"], np.ones(len(run))
    by_velocity = _sensitivity(model, run, states, 1, 1e-3)[:, 1]
    parts = [noise["position_m"] * mass * bump.noise([(bump.second, ones), (bump.first, by_velocity)])]
    if model.force_driven:
        parts.append(noise_level(run.force) * bump.noise([(bump.phi, ones)]))
        drive = np.append(run.held, run.held[-1])
    else:
        for area, name in (("area_a", "pressure_a_pa"), ("area_b", "pressure_b_pa")):
            parts.append(noise[name] * model[f"piston.{area}"] * bump.noise([(bump.phi, ones)]))
        drive = model.effort(states)
    parts.append(bump.coarseness(0.12) * np.sqrt(bump.apply(bump.phi, drive**2)))
    slow = np.abs(smooth(run.position, run.sample_time, 0.012, 3, 1)) < SLIDING
    reach = 0.5 * model["piston.stroke"] - 1e-3
    bad = slow | ~run.measured | (np.abs(run.position) > reach)
    usable = bump.apply(np.ones(bump.width), bad.astype(float)) < 0.5
    total = np.broadcast_to(np.sqrt(np.sum([p**2 for p in parts], axis=0)), usable.shape)
    return Family("momentum", width, index, bump.apply(bump.phi, run.time), total, usable, bump)


def _chamber_family(
    model: Model, frame: Frame, states: Array, claimed: Array, noise: dict[str, float], index: int, chamber: str,
    width: float,
) -> Family:  # fmt: skip
    run, bump = frame.run, Bump.of(width, frame.run.sample_time)
    column, slope, volume, content = _gas(model, chamber, run.position)
    p, gamma = states[:, column], model["air.heat_capacity_ratio"]
    rate = claimed[:, column] / p + gamma * slope * states[:, 1] / volume
    steep = _sensitivity(model, run, states, column, 100.0)[:, column] / p - claimed[:, column] / p**2
    by_pressure = noise[f"pressure_{chamber}_pa"] * bump.noise([(-bump.first, 1.0 / p), (-bump.phi, steep)])
    by_position = noise["position_m"] * bump.noise([(-bump.first, gamma * slope / volume)])
    by_sums = bump.coarseness(4.0) * np.sqrt(bump.apply(bump.phi, rate**2))
    usable = bump.apply(np.ones(bump.width), (~run.measured).astype(float)) < 0.5
    total = bump.apply(bump.phi, content * p) * np.sqrt(by_pressure**2 + by_position**2 + by_sums**2)
    return Family(f"chamber_{chamber}", width, index, bump.apply(bump.phi, run.time), total, usable, bump)


def _gas(model: Model, chamber: str, position: Array) -> tuple[int, float, Array, Array]:
    """State column, dV/dy [m2], volume (n,) [m3], and mass per pressure and per unit of ln p (n,) [kg/Pa]."""
    slope = model["piston.area_a"] if chamber == "a" else -model["piston.area_b"]
    volume = model[f"chambers.volume_{chamber}"] + slope * position
    R_T = model["air.gas_constant"] * model["air.temperature"]
    return model.states.index(f"p_{chamber}"), slope, volume, volume / (model["air.heat_capacity_ratio"] * R_T)


def _sensitivity(model: Model, run: Run, states: Array, column: int, probe: float) -> Array:
    """Change of all derivatives (n, states) per unit of the state in `column`."""
    held = np.append(run.held, run.held[-1])
    pushed = states.copy()
    pushed[:, column] += probe
    return np.asarray((model.derivatives(pushed, held, run.time) - model.derivatives(states, held, run.time)) / probe)
