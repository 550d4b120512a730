"""Freedom of shape: a machine's law need not be the catalogue's, and what differs must not pass for another effect.

A seal's friction grows less than in proportion to the pressures, a spring hardens, a leak is an orifice. So an effect
that was added may act more or less than its law says where the piston is elsewhere, faster, under other pressures or
another input: a (1 + sum of e_k x_k), x_k the deviations of what is measured from its mean, in standard ones, and their
squares less 1. The e_k stand beside the base parameters while further candidates are judged; the model that is refitted
and that predicts keeps the catalogue's law. What sensors do has no such freedom: an offset is an offset.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.coordinates import coordinates
from pneumo_ros.discover.course import reads_wrong
from pneumo_ros.discover.evidence import Course, Evidence
from pneumo_ros.discover.hypothesis import BaseFit

Array = NDArray[np.float64]

FREE = 0.1  # standard deviation of e_k: a law is known to a tenth over the usual range of what it depends on


@dataclass(frozen=True)
class Conditions:
    """Under which each residual arises; arrays (residuals, conditions): position, speed, pressures, size of input."""

    values: Array

    @classmethod
    def of(cls, evidence: Evidence) -> "Conditions":
        """Those of all residuals, in the middle of their windows."""
        columns = 3 + 2 * (not evidence.courses[0].run.force_driven)
        values = np.zeros((len(evidence.time), columns))
        for course in evidence.courses:
            own = evidence.run == course.families[0].run
            values[own] = _seen(course, evidence.time[own])
        return cls(values)

    def relative(self, other: "Conditions") -> Array:
        """Deviations x from the mean of others, in their standard ones, and x^2 - 1; what never changes is left out."""
        middle, spread = other.values.mean(axis=0), other.values.std(axis=0)
        moving = spread > 1e-9 * np.maximum(np.abs(middle), 1e-12)
        x = (self.values[:, moving] - middle[moving]) / spread[moving]
        return np.concatenate([x, x**2 - 1.0], axis=1)


def freed(fit: BaseFit, added: list[str], usual: Conditions) -> BaseFit:
    """The fit with the e_k of each effect that was added as further base parameters, relative to usual conditions."""
    added = [name for name in added if not reads_wrong(fit.model.library.find(name))]
    if not added:
        return fit
    relative = Conditions.of(fit.evidence).relative(usual)
    columns = np.concatenate([FREE * _acting(fit, effect)[:, None] * relative for effect in added], axis=1)
    count = columns.shape[1]
    return replace(
        fit,
        names=(*fit.names, *(f"{effect} {k}" for effect in added for k in range(relative.shape[1]))),
        prior=np.append(fit.prior, np.full(count, FREE)),
        offset=np.append(fit.offset, np.zeros(count)),
        slopes=np.concatenate([fit.slopes, columns], axis=1),
        bends=count,
    )


def _seen(course: Course, time: Array) -> Array:
    rows = np.clip(np.round(time / course.run.sample_time).astype(int), 0, len(course.frame.states) - 1)
    states = course.frame.states[rows]
    pressures = [] if course.run.force_driven else [states[:, 2], states[:, 3]]
    return np.column_stack([states[:, 0], np.abs(states[:, 1]), *pressures, np.abs(course.held[rows])])


def _acting(fit: BaseFit, effect: str) -> Array:
    """What an effect changes in each residual (residuals,), by its slopes at its sizes."""
    change = np.zeros(len(fit.residual))
    for c in coordinates(fit.model.library.find(effect)):
        if c.is_size and c.name in fit.names:
            k = fit.names.index(c.name)
            away = fit.model[c.name] if c.logarithmic else fit.model[c.name] - (c.neutral or 0.0)
            change += fit.slopes[:, k] * away / fit.prior[k]
    return change
