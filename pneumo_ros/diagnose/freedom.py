"""Freedom of shape: a machine's law may differ from the catalogue's, and the difference must not pass for an effect.

A seal's friction grows less than in proportion to the pressures, a spring hardens, a leak is an orifice. So an added
effect a may deviate from its law with position, speed, pressures and input: a (1 + sum of e_k x_k), x_k the measured
conditions minus their mean, in standard deviations, and their squares minus 1. The e_k are free together with the base
parameters while further candidates are judged; the model that is refitted and predicts keeps the catalogue's law.
Sensor effects are not free in shape: an offset is an offset.

No machine's friction is the same all along its stroke, either. So every model has each profile that it lacks, each of
its sizes known to be zero to a tenth of its usual size: only more than that is an effect. Where a profile is the
candidate, its points are known to a usual size: training may not pass all the places that held-out runs pass.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate, coordinates, profile
from pneumo_ros.diagnose.evidence import Evidence, RunEvidence
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis, vectors
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import SIDES
from pneumo_ros.plant.reach import owners_read
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.runs.readings import reads_wrong

Array = NDArray[np.float64]

PRESSURES = tuple(f"p_{side}" for side in SIDES)
LAW_SPREAD = 0.1  # standard deviation of e_k: a law is known to 10 % over the usual range of its variables


def conditions(evidence: Evidence, inputs: Sequence[str] = ()) -> Array:
    """Conditions of each residual in the middle of its window: position, speed, pressures, magnitude of the input.

    (residuals, 3 to 5). `inputs`: those of a force-driven model; measured pressures among them are conditions, too.
    """
    pressures = tuple(name for name in PRESSURES if name in inputs)
    columns = 3 + (len(pressures) or len(evidence.by_run[0].frame.chambers))
    values = np.zeros((len(evidence.time), columns))
    for part in evidence.by_run:
        own = evidence.run == part.families[0].run
        values[own] = _seen(part, evidence.time[own], pressures)
    return values


def relative(values: Array, others: Array) -> Array:
    """Deviations x from the mean of `others`, in their standard deviations, and x^2 - 1; constants are left out."""
    middle, spread = others.mean(axis=0), others.std(axis=0)
    moving = spread > 1e-9 * np.maximum(np.abs(middle), 1e-12)
    x = (values[:, moving] - middle[moving]) / spread[moving]
    return np.concatenate([x, x**2 - 1.0], axis=1)


def freed(fit: BaseFit, added: Sequence[str], seen: Array) -> BaseFit:
    """The fit with the e_k of each added effect as further base parameters; seen: `relative` conditions."""
    added = [name for name in added if not reads_wrong(fit.model.library.find(name))]
    if not added:
        return fit
    columns = np.concatenate([LAW_SPREAD * _acting(fit, effect)[:, None] * seen for effect in added], axis=1)
    return _bent(fit, tuple(f"{effect} {k}" for effect in added for k in range(seen.shape[1])), columns)


def uneven(fit: BaseFit, columns: Mapping[str, Array]) -> BaseFit:
    """The fit with the points of every profile that its model lacks as further base parameters, by their `columns`."""
    for name, own in columns.items():
        if _lacks_profile(fit.model, name):
            bent = _bent(fit, tuple(f"{name} {k}" for k in range(own.shape[1])), own)
            fit = replace(bent, uneven=fit.uneven + own.shape[1])
    return fit


def _lacks_profile(model: Model, name: str) -> bool:
    """Whether the model has not the effect `name`, or another form of it than its profile."""
    points = profile(coordinates(model.library.find(name)))
    return name not in model.effects or not model.idle(name).isdisjoint(c.name for c in points)


def points_of(fit: BaseFit, own: Sequence[Coordinate]) -> NDArray[np.bool_]:
    """Which free parameters (free,) are the points of a profile that the model lacks and to which `own` belong."""
    owner = own[0].name.partition(".")[0] if own else ""
    added = bool(own) and own[0].name in _points(fit, own)
    return np.array([added and name.partition(" ")[0] == owner for name in fit.names], dtype=bool)


def profile_slopes(fit: BaseFit, own: Sequence[Coordinate]) -> Array:
    """Slopes (residuals, own) by the coordinates of a profile: those of the texture; (0, 0) for any other ones."""
    points = points_of(fit, own)
    if not points.any():
        return np.empty((0, 0))
    columns = dict(zip(_points(fit, own), np.flatnonzero(points).tolist(), strict=True))
    return np.asarray(fit.slopes[:, [columns[c.name] for c in own]] / LAW_SPREAD)


def _points(fit: BaseFit, own: Sequence[Coordinate]) -> list[str]:
    """Names of all points of the profile to which `own` belong."""
    return [c.name for c in profile(coordinates(fit.model.library.find(own[0].name.partition(".")[0])))]


def loosened(fit: BaseFit, h: Hypothesis, spread: float) -> BaseFit:
    """The fit with the points of the profile that `h` adds free by `spread` usual sizes, from the sizes `h` has."""
    own, u = points_of(fit, h.coordinates), dict(zip((c.name for c in h.coordinates), h.u.tolist(), strict=True))
    if not own.any():
        return fit
    offset, slopes = fit.offset.copy(), fit.slopes.copy()
    offset[own] = np.array([u.get(name, 0.0) for name in _points(fit, h.coordinates)]) / spread
    slopes[:, own] *= spread / LAW_SPREAD
    return replace(fit, offset=offset, slopes=slopes)


def flattened(fit: BaseFit, h: Hypothesis) -> BaseFit:
    """The fit with the points of the profile that `h` adds held where they are: without the texture of any machine."""
    return replace(fit, slopes=np.where(points_of(fit, h.coordinates), 0.0, fit.slopes))


def unevenness(evidence: Evidence, everything: Model, lacking: Mapping[str, Sequence[Coordinate]]) -> dict[str, Array]:
    """Change of each residual by a tenth of the usual size of each point of the profiles in `lacking`, by name."""
    found = {}
    for name, effect in lacking.items():
        if points := profile(tuple(effect)):
            variants = [{}, *({c.name: c.value(LAW_SPREAD)} for c in points)]
            residual = evidence.residuals(everything, vectors(everything, variants), ranking=True)
            found[name] = np.asarray((residual[1:] - residual[0]).T)
    return found


def shaping(model: Model, added: Sequence[str]) -> dict[str, tuple[Coordinate, ...]]:
    """Parts of the library that read a parameter of an effect in `added`, and so shape its law, and their coordinates.

    Parts are how a machine is built, and no candidates: the curve of a valve is no fault.
    """
    found = {}
    for name in model.library.names() if added else ():
        kind = model.library.find(name)
        if (
            kind.part
            and name not in model.effects
            and {*owners_read(kind)} & {*added}
            and (effect := coordinates(kind))
        ):
            found[name] = effect
    return found


def _bent(fit: BaseFit, names: tuple[str, ...], columns: Array) -> BaseFit:
    count = columns.shape[1]
    return replace(
        fit,
        names=(*fit.names, *names),
        prior=np.append(fit.prior, np.full(count, LAW_SPREAD)),
        offset=np.append(fit.offset, np.zeros(count)),
        slopes=np.concatenate([fit.slopes, columns], axis=1),
        bends=fit.bends + count,
    )


def _seen(part: RunEvidence, time: Array, inputs: tuple[str, ...]) -> Array:
    rows = np.clip(np.round(time / part.run.sample_time).astype(int), 0, len(part.frame.states) - 1)
    states = part.frame.states[rows]
    pressures = part.run.sampled((DRIVE, *inputs))[rows, 1:] if inputs else states[:, 2:]
    return np.column_stack([states[:, 0], np.abs(states[:, 1]), pressures, np.abs(part.held[rows])])


def _acting(fit: BaseFit, effect: str) -> Array:
    """Change of each residual by an effect (residuals,), by its slopes at its sizes."""
    change = np.zeros(len(fit.residual))
    for c in coordinates(fit.model.library.find(effect)):
        if c.is_size and c.name in fit.names:
            k = fit.names.index(c.name)
            away = fit.model[c.name] if c.logarithmic else fit.model[c.name] - (c.neutral or 0.0)
            change += fit.slopes[:, k] * away / fit.prior[k]
    return change
