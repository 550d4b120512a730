"""Changes of the recordings that must not change what is found: each makes a question out of another, or records anew.

Of the mirror, the model lacks one thing: `asymmetric_friction.ratio` is the excess of retraction over extension. Of the
same machine in the mirror, friction in extension has the excess r: the ratio is 1 / (1 + r) - 1 there, and friction
itself, which the machine file tells, is higher by 1 + r, more than the few per cent that are expected.

Larger: twice the areas, volumes, masses, flows and forces, at the same pressures, move alike; the recordings stay.
Higher pressure: twice the supply, atmosphere, masses, flows and forces of the same cylinder move alike; the pressures
recorded are twice as high, and so is their noise. The usual sizes of effects stay: their priors are of one machine.

A slower logger stores every second or fourth reading as it is, and all commands; one at 2 kHz records anew.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from blind_case import divided, taken
from invariance_machines import mirrored_model, mirrored_run, scaled_model, scaled_run

from pneumo_ros.plant import Model
from pneumo_ros.plant.library import Library
from pneumo_ros.runs.run import PARTS, Run

Recordings = tuple[list[Run], list[Run]]  # to fit, and held out


class Question(NamedTuple):
    """What a diagnosis is given."""

    model: Model
    train: list[Run]
    held: list[Run]

    def of_runs(self, change: Callable[[Run], Run]) -> "Question":
        """The question with every recording changed."""
        return self._replace(train=[change(run) for run in self.train], held=[change(run) for run in self.held])


class Reversed(Library):
    """The catalogue from its end."""

    def names(self) -> tuple[str, ...]:
        """All effect names, the last one first."""
        return super().names()[::-1]


def recordings_reversed(asked: Question) -> Question:
    """The last recording first."""
    return asked._replace(train=asked.train[::-1], held=asked.held[::-1])


def catalogue_reversed(asked: Question) -> Question:
    """The last effect of the catalogue first."""
    model = asked.model
    return asked._replace(model=Model(model.composition, model.parameters, model.name, Reversed()))


def pieces(asked: Question) -> Question:
    """Every recording in two, as if the recorder had been started again in between."""
    train, held = ([_half(run, part) for run in runs for part in (0, 1)] for runs in (asked.train, asked.held))
    return asked._replace(train=train, held=held)


def _half(run: Run, part: int) -> Run:
    middle = len(run) // 2
    first, last = ((0, middle), (middle, len(run)))[part]
    p_a, p_b = (None if one is None else one[first:last] for one in (run.pressure_a, run.pressure_b))
    return replace(
        run, name=f"{run.name}_part{part + 1}", position=run.position[first:last], pressure_a=p_a, pressure_b=p_b,
        input=run.input[first * PARTS : (last - 1) * PARTS], measured=run.measured[first:last],
    )  # fmt: skip


def mirrored(asked: Question) -> Question:
    """The axis turned round."""
    return asked.of_runs(mirrored_run)._replace(model=mirrored_model(asked.model))


def scaled(asked: Question, area: float, pressure: float) -> Question:
    """An axis of other areas and pressures that moves alike."""
    changed = asked.of_runs(partial(scaled_run, pressure=pressure))
    return changed._replace(model=scaled_model(asked.model, area, pressure))


def anew(case: Any, names: tuple[str, ...], **logger: float) -> Recordings:
    """The same motions by another logger."""
    return divided(taken(case, names, **logger))


def twice(case: Any, names: tuple[str, ...]) -> Recordings:
    """The recordings, and as many of the same kinds with other motions and noise."""
    train, held = anew(case, names)
    more, held_more = ([replace(run, name=f"{run.name}_again") for run in runs] for runs in anew(_later(case), names))
    return train + more, held + held_more


def one_more(case: Any, names: tuple[str, ...]) -> Recordings:
    """One recording more to fit, of another kind."""
    kinds = [f"train_{kind}" for kind in ("steps", "sweep", "slow", "creep", "moves")]
    others = [name for name in kinds if name not in names]
    name = str(np.random.default_rng([case.seed, 11]).choice(others))
    train, held = anew(case, names)
    return [*train, *taken(_later(case), (name,)).values()], held


def _later(case: Any) -> Any:
    """The same machine on another day: motions and noise are drawn anew."""
    return case._replace(seed=case.seed + 10**6)


LARGER = {"larger": (2.0, 1.0), "higher pressure": (1.0, 2.0)}  # factors of area and pressure
OF_QUESTIONS: dict[str, Callable[[Question], Question]] = {
    "recordings reversed": recordings_reversed,
    "catalogue reversed": catalogue_reversed,
    "pieces": pieces,
    "mirrored": mirrored,
    **{name: partial(scaled, area=area, pressure=pressure) for name, (area, pressure) in LARGER.items()},
}
OF_RECORDINGS: dict[str, Callable[[Any, tuple[str, ...]], Recordings]] = {
    "twice as many": twice,
    "250 Hz": partial(anew, rate=250),
    "500 Hz": partial(anew, rate=500),
    "2 kHz": partial(anew, rate=2000),
    "half the noise": partial(anew, noise=0.5),
    "twice the noise": partial(anew, noise=2.0),
    "one more": one_more,
}
AS_RECORDED = "as recorded"
CHANGES = (*OF_QUESTIONS, *OF_RECORDINGS)
