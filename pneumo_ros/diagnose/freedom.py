"""Freedom of shape: a machine's law may differ from the catalogue's, and the difference must not pass for an effect.

A seal's friction grows less than in proportion to the pressures, a spring hardens, a leak is an orifice. So an added
effect a may deviate from its law with position, speed, pressures and input: a (1 + sum of e_k x_k), x_k the measured
conditions minus their mean, in standard deviations, and their squares minus 1. The e_k are free together with the base
parameters while further candidates are judged; the model that is refitted and predicts keeps the catalogue's law.
Sensor effects are not free in shape: an offset is an offset.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.evidence import Evidence, RunEvidence
from pneumo_ros.diagnose.follow import reads_wrong
from pneumo_ros.diagnose.hypothesis import BaseFit
from pneumo_ros.plant.signals import DRIVE

Array = NDArray[np.float64]

PRESSURES = ("p_a", "p_b")
LAW_SPREAD = 0.1  # standard deviation of e_k: a law is known to 10 % over the usual range of its variables


def conditions(evidence: Evidence, inputs: Sequence[str] = ()) -> Array:
    """Conditions of each residual in the middle of its window: position, speed, pressures, magnitude of the input.

    (residuals, 3 to 5). `inputs`: those of a force-driven model; measured pressures among them are conditions, too.
    """
    pressures = tuple(name for name in PRESSURES if name in inputs)
    columns = 3 + (len(pressures) if evidence.by_run[0].run.force_driven else 2)
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
    count = columns.shape[1]
    return replace(
        fit,
        names=(*fit.names, *(f"{effect} {k}" for effect in added for k in range(seen.shape[1]))),
        prior=np.append(fit.prior, np.full(count, LAW_SPREAD)),
        offset=np.append(fit.offset, np.zeros(count)),
        slopes=np.concatenate([fit.slopes, columns], axis=1),
        bends=count,
    )


def _seen(part: RunEvidence, time: Array, inputs: tuple[str, ...]) -> Array:
    rows = np.clip(np.round(time / part.run.sample_time).astype(int), 0, len(part.frame.states) - 1)
    states = part.frame.states[rows]
    pressures = part.run.sampled((DRIVE, *inputs))[rows, 1:] if inputs else states[:, 2:4]
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
