"""Coordinates in which candidates are fitted: relative sizes, and logarithms of time constants and frequencies."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant.effect import Effect, kind_of
from pneumo_ros.plant.usual import usual_size

Array = NDArray[np.float64]

_FACTOR = 4.0  # between the shapes that are tried first
_TUNE, _TUNED = 1.25, 7  # factor between frequencies tried, and their number either way: broad resonances overlap
_FREQUENCY = ("Hz", "rad/s")
_WIDE, _NARROW = 30.0, 1.0  # prior deviations: of a size over its typical size, of the logarithm of a shape
_PLACES = 40  # most places tried
_FEW, _PROFILE = 3, 1.0  # most sizes of no profile; prior deviation in a profile, as in the score: not all have data


@dataclass(frozen=True)
class Coordinate:
    """One parameter of a candidate.

    Its value is neutral + typical u, or typical exp(u) where it is a shape or fades out towards its upper bound. A
    place, a shape that may have either sign and that matters within a distance `typical`, is typical u.
    """

    name: str
    typical: float
    neutral: float | None
    low: float
    high: float
    unit: str = ""
    role: str = ""
    shapes: str = ""  # name of the size without which it does nothing
    wide: float = _WIDE  # prior deviation of a size, in typical sizes

    @property
    def logarithmic(self) -> bool:
        """Whether u is a logarithm."""
        return self.typical > 0.0 and (self.neutral is None or self.neutral == self.high) and not self.is_place

    @property
    def is_place(self) -> bool:
        """Whether the parameter says where, within its range, something is."""
        return self.neutral is None and self.typical > 0.0 and -np.inf < self.low < 0.0

    @property
    def is_size(self) -> bool:
        """Whether the parameter fades the effect in, rather than shaping it."""
        return self.neutral is not None

    @property
    def tuned(self) -> bool:
        """Whether the parameter is a resonance frequency: it shows near the resonance only."""
        return self.logarithmic and not self.is_size and self.unit in _FREQUENCY

    @property
    def fading_frequency(self) -> bool:
        """Whether the parameter is the corner frequency of a lag: the higher, the smaller the lag."""
        return self.logarithmic and self.is_size and self.unit in _FREQUENCY

    @property
    def share(self) -> bool:
        """Whether the effect is linear in a fading parameter, as in a share, rather than in its inverse."""
        return self.unit == "1"

    @property
    def prior(self) -> float:
        """Prior standard deviation of u."""
        return _NARROW if self.logarithmic else self.wide

    def value(self, u: float) -> float:
        """The parameter's value, within its bounds."""
        if self.logarithmic:
            value = self.typical * float(np.exp(np.clip(u, -50.0, 50.0)))
        else:
            value = (self.neutral or 0.0) + self.scale * u
        return float(min(max(value, self.low), self.high))

    @property
    def expected(self) -> float:
        """Deviation of u in a score: a usual size or a factor e; a place is as likely anywhere."""
        low, high = self.ends
        return float(high - low) / math.sqrt(12.0) if self.is_place else 1.0

    @property
    def scale(self) -> float:
        """Value per u of a linear coordinate."""
        return self.typical - (self.neutral or 0.0) if self.typical != (self.neutral or 0.0) else 1.0

    def u(self, value: float) -> float:
        """The coordinate of a value."""
        if self.logarithmic:
            return float(np.log(max(value, 1e-300) / self.typical))
        return (value - (self.neutral or 0.0)) / self.scale

    def size(self, u: float) -> float:
        """Size of the effect in usual sizes: 0 at neutral, 1 at the usual value."""
        if not self.logarithmic or self.neutral is None:
            return u
        value, end, usual = self.value(u), self.neutral, self.typical
        if self.share:
            return (end - value) / (end - usual)
        return (1.0 / value - 1.0 / end) / (1.0 / usual - 1.0 / end)

    def grown(self, value: float, factor: float) -> float:
        """The value of a size `factor` times larger; the inverse grows if the effect fades out at the upper bound."""
        u = self.u(value)
        return self.value(u - float(np.log(factor)) if self.logarithmic else factor * u)

    def clip(self, u: float) -> float:
        """The nearest u whose value is allowed."""
        return self.u(self.value(u))

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest u whose value is allowed."""
        first, second = self.clip(-1e9), self.clip(1e9)
        return min(first, second), max(first, second)


def coordinates(effect: type[Effect]) -> tuple[Coordinate, ...]:
    """Coordinates of all parameters of an effect; () when none of them fades it in."""
    if all(p.neutral is None for p in effect.parameters.values()):
        return ()
    found = tuple(_coordinate(effect, key) for key in effect.parameters)
    points = profile(found)
    return tuple(replace(c, wide=_PROFILE) if c in points else c for c in found)


def profile(effect: tuple[Coordinate, ...]) -> tuple[Coordinate, ...]:
    """The sizes of an effect that are so many that they form a profile, which can follow any signal; () if none do."""
    return next((kind for kind in kinds(effect) if len(kind) > _FEW), ())


def _coordinate(effect: type[Effect], key: str) -> Coordinate:
    p = effect.parameters[key]
    typical = p.default
    if p.neutral is not None and p.default == p.neutral:  # by default it does nothing: the usual size is needed
        typical = p.neutral + usual_size(effect, key)
    elif p.neutral is None and p.default == 0.0 and p.usual is not None:
        typical = p.usual
    shapes = f"{effect.name}.{p.shapes}" if p.shapes else ""
    return Coordinate(f"{effect.name}.{key}", typical, p.neutral, p.low, p.high, p.unit, p.role, shapes)


def kinds(effect: tuple[Coordinate, ...]) -> list[tuple[Coordinate, ...]]:
    """The sizes of an effect by kind: of equal unit, bounds and neutral value, as for the two directions of motion."""
    found: dict[tuple[str, float | None, float, float], list[Coordinate]] = {}
    for c in effect:
        if c.is_size:
            found.setdefault(kind_of(c), []).append(c)
    return [tuple(own) for own in found.values()]


def by_kind(effect: tuple[Coordinate, ...]) -> list[tuple[Coordinate, ...]]:
    """The sizes of each kind with the shapes that act beside them, in the order of the effect."""
    found = []
    for kind in kinds(effect):
        names = {"", *(c.name for c in kind)}
        found.append(tuple(c for c in effect if c in kind or (not c.is_size and c.shapes in names)))
    return found


def forms(effect: tuple[Coordinate, ...]) -> list[tuple[Coordinate, ...]]:
    """The forms of an effect, of which a machine has one: a play is before the sensor or before the load."""
    return by_kind(effect) if any(c.shapes for c in effect) else [effect]


def starts(effect: tuple[Coordinate, ...]) -> list[Array]:
    """Shapes to try: the usual one, and each shape parameter four times larger and smaller, as u (coordinates,).

    Frequencies are tried in finer steps, with the other shapes at four times the usual: damped, broad resonances. And a
    place all over its range, in steps of the distance that matters.
    """
    usual = np.array([0.0 if c.logarithmic or not c.is_size else 1.0 for c in effect])
    shapes = [k for k, c in enumerate(effect) if not c.is_size and c.logarithmic]
    found = [usual]
    for k in shapes:
        tuned = effect[k].tuned
        begin = _moved(effect, usual, [j for j in shapes if j != k], _FACTOR) if tuned else usual
        factors = _TUNE ** np.arange(-_TUNED, _TUNED + 1.0) if tuned else (_FACTOR, 1.0 / _FACTOR)
        tried = [_moved(effect, begin, [k], float(factor)) for factor in factors]
        found += [u for u in tried if tuned or abs(u[k]) > 0.5]
    for k, c in enumerate(effect):
        if c.is_place:
            found += [np.where(np.arange(len(effect)) == k, at, usual) for at in _spread(*c.ends)]
    return found


def _spread(low: float, high: float) -> Array:
    """Places between two ends, one apart from each other and half as far from the ends; a bounded number of them."""
    count = min(math.ceil(high - low - 1e-9), _PLACES)
    return np.array([low + (high - low) * (k + 0.5) / count for k in range(count)])


def _moved(effect: tuple[Coordinate, ...], u: Array, which: list[int], factor: float) -> Array:
    """u with some coordinates at `factor` times their usual value, within their bounds."""
    return np.array([effect[k].clip(np.log(factor)) if k in which else x for k, x in enumerate(u)])
