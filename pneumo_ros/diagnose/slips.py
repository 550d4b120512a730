"""Effects between sticking and sliding, which no equation along the motion shows, judged by short simulations.

The mechanics alone are simulated through breakaways, stops and reversals, every start fitted again. A model is judged
by the median over events of the squared error per sample, or by the upper quartile: a single breakaway predicted
slightly too early or too late, which no start corrects, must not decide.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.mechanics import driven_by_pressures, event_rows, events
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.runs.inputs import measured_inputs
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.problem import NOISE_TAIL
from pneumo_ros.shooting.refit import refit_segments
from pneumo_ros.shooting.robust import huber_loss
from pneumo_ros.shooting.segments import Segments
from pneumo_ros.shooting.start import fit_starts

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

FRICTION_KEYS = ("static_friction", "coulomb_friction", "stribeck_velocity", "bristle_stiffness")
STATIC, COMMON = "lugre_friction.static_friction", 0.005
FEWEST_FITTED, FEWEST_JUDGED = 5, 12  # events: of training runs for friction, of both kinds for an effect
SURE_SHARE = 0.02  # relative uncertainty below which a parameter keeps its prior from the equations
# squared error per sample over that of noise and texture, of most events: above, something between stick and slip is
# missing
POOR = 1.5
DRAWS = 2  # of unknown forces in each event
STALLED, REFITS = 0.5, 10  # share of the error above which a refit is not restarted; most refits
EQUATIONS_OFF = 0.2  # share by which the equations may be wrong about an effect that the events show better
FEW_PARAMETERS = 3  # parameters: the events are too few to fit more


@dataclass(frozen=True)
class Slips:
    """Events of training and held-out runs, for one mechanical model and its variants."""

    train_runs: tuple[Run, ...]
    held_runs: tuple[Run, ...]
    train_rows: Rows
    held_rows: Rows

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs that all their runs hold."""
        return measured_inputs([*self.train_runs, *self.held_runs])

    @property
    def judge(self) -> bool:
        """Whether there are enough of them to judge an effect."""
        return min(len(self.train_rows), len(self.held_rows)) >= FEWEST_JUDGED

    def train(self, model: Model) -> Segments:
        """Training events, first guesses by `model`; those of the last two models are kept."""
        return self._train(model)

    def some(self, model: Model) -> Segments:
        """As many of the training events as are needed to judge an effect, evenly chosen from all."""
        count = len(self.train_rows)
        return self.train(model).pick(
            np.unique(np.linspace(0, count - 1, min(count, FEWEST_JUDGED)).round().astype(int))
        )

    def held(self, model: Model) -> Segments:
        """Held-out events, first guesses by `model`."""
        return events(model, self.held_runs, self.held_rows)

    @cached_property
    def _train(self) -> Callable[[Model], Segments]:
        return lru_cache(2)(lambda model: events(model, self.train_runs, self.train_rows))


def slips(model: Model, train: Sequence[Run], held: Sequence[Run]) -> tuple[Model, Slips] | None:
    """The mechanics of `model` and the events to fit them to; None where either is missing."""
    alone = mechanical(model)
    if alone is None or "lugre_friction" not in alone.effects:
        return None
    first, second = (tuple(driven_by_pressures(model, run) for run in runs) for runs in (train, held))
    found = Slips(first, second, event_rows(first), event_rows(second))
    return (alone, found) if len(found.train_rows) >= FEWEST_FITTED else None


def with_values_of(model: Model, other: Model) -> Model:
    """The model with all parameters that `other` has at its values."""
    return model.with_parameters({n: v for n, v in other.parameters.items() if n in model.parameters})


def errors(model: Model, segments: Segments, threads: int = 2) -> Array:
    """Robust mean squared error per sample over the noise's (events,), every start fitted."""
    return errors_of_each([model], [segments], threads)[0]


def errors_of_each(models: Sequence[Model], segments: Sequence[Segments], threads: int = 1) -> list[Array]:
    """The same for the same events by models that differ in values alone: (events,) for each, in one batch of lanes."""
    model, whole = models[0], segments[0].joined(segments[1:])
    q = np.repeat([one.values for one in models], [len(some) for some in segments], axis=0)
    begin = np.concatenate([some.seated(one) for one, some in zip(models, segments, strict=True)])
    x = fit_starts(model, whole, begin, threads=threads, parameters=q)
    whitened = whole.residuals(model, x, q, threads)[0]
    far = 0.5 * np.sum(whole.from_guess(model, x, q)[0] ** 2, axis=1)
    found = 2.0 * (np.sum(huber_loss(whitened, NOISE_TAIL), axis=1) + far) / whitened.shape[1]
    return list(np.split(found, np.cumsum([len(some) for some in segments])[:-1]))


def textured(model: Model, segments: Segments, force: float) -> Array:
    """The errors (draws, events) of `model` if in each event a force of deviation `force` [N] acts that it lacks.

    Its own predictions, without noise, are the measurements; every start is fitted again.
    """
    drive, length = model.inputs.index(DRIVE), segments.samples * segments.parts
    there = segments.predicted(model, fit_starts(model, segments, threads=2), threads=2)
    rows = segments.first[:, None] + np.arange(length)
    found = []
    for loads in np.random.default_rng(0).normal(0.0, force, (DRAWS, len(segments))):
        inputs = segments.inputs.copy()
        inputs[rows, drive] += loads[:, None]
        found.append(errors(model, replace(segments, inputs=inputs, measured=there)))
    return np.array(found)


def polished(
    alone: Model, found: Slips, known: dict[str, float], added: Sequence[str] = (), limits: list[str] | None = None
) -> Model:
    """The mechanics with friction and the `added` effects refitted to the training events.

    `known`: prior standard deviations of parameters from elsewhere; 5 % otherwise. Static friction a few per cent off
    shifts the slips in time and leads the refit into a valley; a restart from its end leaves the valley. `limits`
    takes a sentence if the last of `REFITS` restarts still helped.
    """
    prior = friction_priors(alone, known)
    for name in (n for n in known if n.partition(".")[0] in added and n in alone.parameters and alone[n] != 0.0):
        if len(alone.library.find(name.partition(".")[0]).parameters) <= FEW_PARAMETERS:
            sure = known[name] < SURE_SHARE * abs(alone[name])
            prior[name] = known[name] if sure else EQUATIONS_OFF * abs(alone[name])
    best, left = alone, _level(errors(alone, found.train(alone)))
    for _ in range(REFITS):
        new = refit_segments(best, found.train(best), list(prior), prior).model
        before, left = left, _level(errors(new, found.train(new)))
        if not left < before:
            return best
        best = new
        if left < POOR or left > STALLED * before:
            return best
    if limits is not None:
        limits.append(f"the friction refitted to breakaways and reversals still changed after {REFITS} refits")
    return best


def _level(errors: Array) -> float:
    """Geometric mean: a breakaway at the wrong moment counts, but less than its error."""
    return float(np.exp(np.mean(np.log(errors))))


def friction_priors(alone: Model, known: dict[str, float]) -> dict[str, float]:
    """Prior standard deviations of the free friction parameters: those `known` from elsewhere, at most 5 %.

    If the value is 0, 5 % of its default. For static friction at least 0.5 %, a common error of all breakaways, as slip
    times are uncertain.
    """
    names = [f"lugre_friction.{key}" for key in FRICTION_KEYS]
    prior = {n: min(known.get(n, np.inf), 0.05 * (alone[n] or alone.usual_size(n))) for n in names}
    return prior | {STATIC: max(prior[STATIC], COMMON * alone[STATIC])}
