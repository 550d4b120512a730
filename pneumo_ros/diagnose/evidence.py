"""The residuals of all equations along all runs, as one vector, which candidates have to explain.

Families: the momentum while the piston slides [N], in windows of 100 and 40 ms; the chambers [kg/s], in windows of
200 and 40 ms; and the breakaways [N], the force just before a slip minus that at which the model slips.
The equations are those of `equations.equations`; each residual has its noise from the sensors alone.
"""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import replace
from functools import cache, cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.binned import clusters
from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.families import Family, families
from pneumo_ros.diagnose.follow import Followed, Frame, adding_mass, follow, follow_each, frame_of, noisier
from pneumo_ros.equations.breakaway import UNSEEN
from pneumo_ros.equations.equations import Balance, MeasuredChamber, MeasuredMotion, added_mass, drive_along
from pneumo_ros.equations.slip import SLOWEST, SPEEDS, force_at_slip
from pneumo_ros.plant import Model
from pneumo_ros.runs.local_polynomial import weights
from pneumo_ros.runs.readings import reads_wrong
from pneumo_ros.runs.rests import REST
from pneumo_ros.runs.run import Run, check_position

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Measured = MeasuredMotion | MeasuredChamber | None  # None: of breakaways

BLOCK = 0.4  # s: errors within a block are correlated
AS_NOISY = "delay", "play"  # roles of parameters that leave the noise of a sensor as it is
BRISTLES = "bristle_stiffness", "bristle_damping", "breakaway_ratio"


class Evidence:
    """Residual vectors of variants of a model along fixed runs.

    Windows, their noise and which of them count do not depend on the variant and are made once. Arrays (residuals,):
    family (index into `names`), run and block index of each entry, its time [s], and the noise in the entry's unit.
    `by_mass`: the share of its deviation that the moving mass amplifies. `drive`: root mean square of the drive force
    on the piston [N].
    """

    def __init__(self, model: Model, runs: Sequence[Run]) -> None:
        self.piston = model["piston.mass"]
        self.mass = self.piston + added_mass(model)
        self._index([RunEvidence(model, run, i) for i, run in enumerate(runs)])

    def _index(self, by_run: list["RunEvidence"]) -> None:
        self.by_run = by_run
        self._amplified = WeakKeyDictionary[Model, Array]()  # a candidate's is needed several times
        self.runs = tuple(part.run for part in by_run)
        families = [f for part in self.by_run for f in part.families]
        self.noise = np.concatenate([f.noise[f.usable] for f in families])
        by_mass = [np.zeros(len(f.time)) if f.by_mass is None else f.by_mass for f in families]
        self.by_mass = np.concatenate([m[f.usable] for m, f in zip(by_mass, families, strict=True)]) / self.noise
        counts = [int(f.usable.sum()) for f in families]
        self.names = tuple(dict.fromkeys(f.name for f in families))
        self.family = np.repeat([self.names.index(f.name) for f in families], counts)
        self.run = np.repeat([f.run for f in families], counts)
        self.time = np.concatenate([f.time[f.usable] for f in families])
        self.drive = float(np.sqrt(np.mean(np.concatenate([part.drive**2 for part in self.by_run]))))
        self.block = clusters(self.time, self.run, BLOCK)

    def __len__(self) -> int:
        return len(self.noise)

    def with_breakaways(self, noise: Sequence[Array]) -> "Evidence":
        """The same with another noise of the breakaways (breakaways,) [N] of each run; infinite: it does not count."""
        other = copy(self)
        other._index([part.with_breakaways(own) for part, own in zip(self.by_run, noise, strict=True)])
        return other

    def noise_of(self, model: Model) -> Array:
        """Noise (residuals,) with what `model` adds to the moving mass, which amplifies the noise of the position.

        States of effects are driven along the measured motion: they may ring with its noise, or take it in, as a load
        behind a play that does not follow it (`amplification`).
        """
        noise = self.noise * self.by_load(self.load(model))
        return np.asarray(noise * self.amplification(model)[self.run, self.family])

    def load(self, model: Model) -> float:
        """Mass that moves with the piston at once in `model`, over that in the model of the windows."""
        return (self.piston + added_mass(without_states(model))) / self.mass

    def by_load(self, load: float) -> Array:
        """Factor (residuals,) by which the noise grows where the mass that moves at once is `load` times as large."""
        return np.asarray(np.sqrt(1.0 + self.by_mass**2 * (load**2 - 1.0)))

    def amplification(self, model: Model) -> Array:
        """Factor (runs, families) by which the states of effects in `model` amplify the sensors' noise in each run."""
        if model not in self._amplified:
            self.amplify([model])
        return self._amplified[model]

    def amplify(self, models: Sequence[Model]) -> None:
        """Measure the amplification of models that differ in values only: together they take hardly longer than one.

        It is measured on each run, to which its noise is added once more: a load behind a play follows the rod in one
        run and not in another. In its usual window, as the median says: where such a load knocks, earlier or later with
        the noise, a few windows change so much that their mean square says nothing of all others. Breakaways are no
        windows.
        """
        shape = len(self.by_run), len(self.names)
        pairs = [(model, plain) for model in models if (plain := without_states(model)) is not model]
        factors = np.ones((len(pairs), *shape))
        if pairs:
            both = np.stack([one.values for pair in pairs for one in pair])
            before, after = (self.residuals(models[0], both, noisier=again) for again in (False, True))
            change = np.abs(after - before).reshape(len(pairs), 2, len(self))
            for run, family in np.ndindex(shape):
                own = (self.run == run) & (self.family == family)
                if own.any() and self.names[family] != "breakaway":
                    grown, usual = np.median(change[:, :, own], axis=-1).T
                    factors[:, run, family] = np.divide(grown, usual, out=np.ones(len(pairs)), where=usual > 0.0)
        self._amplified.update({model: np.ones(shape) for model in models})
        self._amplified.update(zip((model for model, _ in pairs), factors, strict=True))

    def residual(self, model: Model) -> Array:
        """Measured minus claimed by `model`, over noise (residuals,)."""
        return np.asarray(self.residuals(model, model.values[None])[0])

    def residuals(
        self, model: Model, parameters: Array, threads: int = 2, ranking: bool = False, noisier: bool = False
    ) -> Array:
        """The same for many parameter vectors (variants, parameters) of one model: (variants, residuals).

        `ranking`: only as exact as the ranking of candidates needs, in less time. `noisier`: with the noise of all
        sensors added once more.
        """
        longest_first = sorted(self.by_run, key=lambda part: -len(part.run))  # else a long run ends last, alone
        pool = _pool(os.getpid(), threads)
        made = {part: pool.submit(part.values, model, parameters, ranking, noisier) for part in longest_first}
        whole, at = np.empty((len(parameters), len(self.noise))), 0
        try:
            for part in self.by_run:  # each is let go when it is copied: many variants of long recordings are large
                values = made.pop(part).result()
                whole[:, at : at + values.shape[1]] = values
                at += values.shape[1]
        finally:
            for rest in made.values():  # after an error or at the end of the time
                rest.cancel()
        whole /= self.noise
        return np.asarray(np.nan_to_num(whole, copy=False, nan=1e9, posinf=1e9, neginf=-1e9))


@cache
def _pool(process: int, threads: int) -> ThreadPoolExecutor:
    """Threads that are kept, as each new one leaves memory behind; each process has its own.

    Not those of `plant.lanes`: these wait for them, and a pool whose threads wait for it stands still.
    """
    return ThreadPoolExecutor(threads)


def without_states(model: Model) -> Model:
    """The model with the effects that have states of their own switched off; itself if it has none, or none acts.

    But for sensors that read late, or behind a play: their noise is the same, at another time. Measured on 20 s of it,
    that would seem to be 5 % more or less.
    """
    effects = [effect for effect in model.composition.effects if effect.states]
    own = [(c, reads_wrong(effect) and c.role in AS_NOISY) for effect in effects for c in coordinates(effect)]
    off = {c.name: c.neutral for c, as_noisy in own if c.neutral is not None and not as_noisy}
    return model.with_parameters(off) if any(model[name] != value for name, value in off.items()) else model


class RunEvidence:
    """One run's part of the evidence."""

    def __init__(self, model: Model, run: Run, index: int) -> None:
        check_position(model, run)
        self.run, self.frame = run, frame_of(run, model.chambers)
        self.piston = model["piston.mass"]  # weight of the momentum in every model: those compared share one scale
        self.families = families(model, self.frame, index)
        self.held = np.append(run.held, run.held[-1])
        along = follow(model, self.frame)[0] if model.self_driven else self.frame.states
        self.drive = drive_along(model, run, along)
        last = self.families[-1]
        self.breakaways = last.breakaways
        width, reach = max(round(REST / run.sample_time), 2), max(round(0.008 / run.sample_time), 2)
        self.kernel = weights(2 * reach + 1, 2)  # a parabola over +-8 ms
        self.spans = [
            np.arange(max(b.index - width - 2 * reach, 0), min(b.index + 2 * reach + 1, len(run)))
            for b in self.breakaways
        ]
        ends = [b.index - round(t / run.sample_time) for b, t in zip(self.breakaways, last.slip_times, strict=True)]
        self.inner = [
            slice(max(b.index - width, 0) - span[0], end - span[0] + 1)
            for b, end, span in zip(self.breakaways, ends, self.spans, strict=True)
        ]
        least = max(round(UNSEEN / run.sample_time), 1)
        rested = [max(min(end, b.index - least), 0) for b, end in zip(self.breakaways, ends, strict=True)]
        self.rested = np.array(rested, dtype=np.int64)
        self.direction, self.ramp, self.slip = (
            np.array([getattr(b, key) for b in self.breakaways], dtype=float) for key in ("direction", "ramp", "slip")
        )
        # a slip is certain between two samples
        back = [b.index - 0.5 - end for b, end in zip(self.breakaways, ends, strict=True)]
        self.before = np.array(back) * run.sample_time
        self._kept = dict[bool, tuple[list[float], list[Measured]]]()  # of a model, along the frame and the noisier one

    def with_breakaways(self, noise: Array) -> "RunEvidence":
        """The same with another noise of the breakaways (breakaways,) [N]."""
        other = copy(self)
        other.families = [*self.families[:-1], replace(self.families[-1], noise=noise, usable=np.isfinite(noise))]
        return other

    @cached_property
    def noisier(self) -> Frame:
        """Its frame with the noise of all sensors added once more."""
        return noisier(self.frame)

    def values(self, model: Model, parameters: Array, ranking: bool = False, noisier: bool = False) -> Array:
        """Residuals (variants, usable windows) in their units, family after family; along its frame or `noisier`."""
        frame = self.noisier if noisier else self.frame
        result = np.empty((len(parameters), sum(int(f.usable.sum()) for f in self.families)))
        own = measured = self._along(model, noisier)
        along: int | None = None
        late, loaded = np.zeros(len(self.breakaways)), adding_mass(model, parameters)
        for variant in follow_each(model, frame, parameters, ranking):
            if variant.along != along:
                along = variant.along
                late = self._late(frame.states[:, 0], variant.frame[:, 0])
                own = [
                    _weighed(self._measured(model, f, variant.frame), m)
                    for f, m in zip(self.families, measured, strict=True)
                ]
            q = parameters[variant.index]
            parts = [
                self._value(model, q, variant, m, late, loaded[variant.index])[f.usable]
                for f, m in zip(self.families, own, strict=True)
            ]
            result[variant.index] = np.concatenate(parts)
        return result

    def _along(self, model: Model, noisier: bool) -> list[Measured]:
        """The measured parts of all families along its frame or the noisier one; those of equal chambers are kept."""
        own = ["air.heat_capacity_ratio", "air.gas_constant", "air.temperature"] if model.chambers else []
        own += [name for chamber in model.chambers for name in (chamber.volume, chamber.area)]
        key = [model[name] for name in own]
        if noisier not in self._kept or self._kept[noisier][0] != key:
            states = (self.noisier if noisier else self.frame).states
            self._kept[noisier] = key, [self._measured(model, family, states) for family in self.families]
        return self._kept[noisier][1]

    def _measured(self, model: Model, family: Family, states: Array) -> Measured:
        """The part of an equation's residual that depends on the frame's states alone."""
        if family.equation == "breakaway":
            return None
        if family.equation == "momentum":
            return MeasuredMotion.of(family.window, states[:, 0])
        chamber = next(one for one in model.chambers if one.equation == family.equation)
        return Balance(model, chamber).measured(family.window, states)

    def _late(self, measured: Array, corrected: Array) -> Array:
        """By how many samples (breakaways,) each slip is late in the measured position (n,), and not in the corrected.

        A low-pass shows a slip after a sample or more, and before its time constant: it is read at the distance at
        which a slip is certain.
        """
        width, found = max(round(REST / self.run.sample_time), 2), list[float]()
        for b, span, inner in zip(self.breakaways, self.spans, self.inner, strict=True):
            first = b.index - round(b.rest / self.run.sample_time)
            rested, rows = slice(first, first + width), span[inner.start :]
            shown, true = (
                _departs(y[rows], float(np.median(y[rested])), b.direction, b.slip) for y in (measured, corrected)
            )
            found.append(shown - true)
        return np.array(found)

    def _value(self, model: Model, q: Array, variant: Followed, measured: Measured, late: Array, loaded: bool) -> Array:
        if measured is None:
            return self._slips(model, q, variant, late)
        if isinstance(measured, MeasuredChamber):
            return measured.value(variant.claimed[:, measured.column - 1])
        mass: Array | float = self.piston
        if loaded:
            rows = measured.bump.centres(len(variant.frame))
            mass = mass + self._see(model, q, variant.states(rows), rows)["added_mass"]
        return measured.value(mass, variant.claimed[:, 0])

    def _see(self, model: Model, q: Array, states: Array, rows: Index) -> dict[str, Array]:
        """Outputs of the model with parameters `q` at the given states (rows, states) of these samples."""
        out = np.empty((len(rows), len(model.composition.observed)))
        held = self.run.sampled(model.inputs)[rows]
        model.kernel.observe(np.ascontiguousarray(states), q, held, self.run.time[rows], out)
        return {name: out[:, i] for i, name in enumerate(model.composition.observed)}

    def _slips(self, model: Model, q: Array, variant: Followed, late: Array) -> Array:
        """Largest force that friction held before each slip, minus that of the model; each is shown `late`."""
        if not self.breakaways:
            return np.empty(0)
        rows = np.concatenate(self.spans)
        seen = self._see(model, q, variant.states(rows), rows)
        load = np.split(seen["drive"] - seen["force"], np.cumsum([len(s) for s in self.spans])[:-1])
        largest = [
            max(_largest(d * np.convolve(part, self.kernel, "same"), inner, before), 0.0)
            for part, inner, d, before in zip(load, self.inner, self.direction, late, strict=True)
        ]
        return np.array(largest) - self._holds(model, q, variant)

    def _holds(self, model: Model, q: Array, variant: Followed) -> Array:
        """Force that the model with parameters `q` holds before each slip, up to where that of the recording is read.

        That is the force at which its slip is certain, less the rise of the force from where the recording is read.
        """
        there = np.repeat(variant.states(self.rested), len(SPEEDS), axis=0)
        there[:, 1] = np.outer(self.direction, SPEEDS).ravel()
        seen = self._see(model, q, there, np.repeat(self.rested, len(SPEEDS)))
        level, added = (seen[name].reshape(-1, len(SPEEDS)) for name in ("friction_level", "added_mass"))
        names = model.composition.parameters
        stiffness, damping, ratio = (float(q[names.index(f"lugre_friction.{key}")]) for key in BRISTLES)
        force = force_at_slip(self.ramp, self.slip, self.piston + added[:, 0], stiffness, damping, ratio, level)
        return np.asarray(force - np.maximum(self.ramp, SLOWEST) * self.before)


def _largest(force: Array, inner: slice, late: float) -> float:
    """The largest of the samples `inner` before a slip that was `late` samples earlier; at least the first of them."""
    end = max(inner.stop - 1 - late, inner.start)
    at_end = np.interp(end, np.arange(len(force)), force)
    return max(float(force[inner.start : int(end) + 1].max()), float(at_end))


def _departs(y: Array, rested: float, direction: float, slip: float) -> float:
    """Sample from which on a position (n,) is farther than `slip` in a direction from where it `rested`."""
    away = direction * (y - rested) - slip
    inside = np.flatnonzero(away < 0.0)
    last = int(inside[-1]) if len(inside) else 0
    if last + 1 == len(y) or not len(inside):
        return float(last)
    return float(last - away[last] / (away[last + 1] - away[last]))


def _weighed(corrected: Measured, measured: Measured) -> Measured:
    """The corrected states of a chamber with the gas content as measured.

    Else a sensor that is said to read twice the pressure would halve every residual, and explain what it only scales.
    """
    if isinstance(corrected, MeasuredChamber) and isinstance(measured, MeasuredChamber):
        return replace(corrected, content=measured.content)
    return corrected
