"""Which experiment distinguishes two effects, and how well."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pneumo_ros.errors import UsageError
from pneumo_ros.experiment.imitation import imitate, unknowns
from pneumo_ros.experiment.offers import Offer, menu
from pneumo_ros.experiment.record import Record, record
from pneumo_ros.experiment.whitened import Noise, Whitened, families
from pneumo_ros.plant import Model

CLEAR = 5.0  # noise deviations that distinguish effects for certain; fewer than NOTHING decide nothing
NOTHING = 2.0
PRIOR = "prior knowledge of the other parameters"

Progress = Callable[[float], None]  # called with the share that is done, 0 to 1


@dataclass(frozen=True)
class Separation:
    """The expected result of an experiment.

    if_a, if_b: noise deviations that remain when effect a (b) made the record and the model with the other is
    refitted to it. where: the most informative equation. refused: why it must not be done, else "".
    """

    offer: Offer
    if_a: float
    if_b: float
    where: str
    duration: float  # s
    refused: str = ""

    @property
    def separation(self) -> float:
        """The smaller of both, reached whichever effect is present."""
        return min(self.if_a, self.if_b)

    @property
    def log_likelihood_ratio(self) -> float:
        """Expected value: half the square of the separation."""
        return 0.5 * self.separation**2


def separate(
    model: Model,
    effect_a: str,
    effect_b: str,
    *,
    noise: Noise | None = None,
    offers: Sequence[Offer] | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> list[Separation]:
    """Every experiment of `offers` (default: the menu), the most informative first; refused ones last.

    Each effect has its parameters from `model`, or their defaults. Raises UsageError for unknown or equal effects, for
    effects that the machine needs or cannot have, and for a machine without valve.
    """
    models = rivals(model, effect_a, effect_b)
    chosen = menu(model) if offers is None else list(offers)
    told = progress or (lambda share: None)
    found: list[Separation] = []
    with ThreadPoolExecutor(max_workers=max(threads, 1)) as pool:
        judged = pool.map(lambda offer: _judge(offer, models, (effect_a, effect_b), noise or Noise()), chosen)
        for result in judged:
            found.append(result)
            told(len(found) / len(chosen))
    return sorted(found, key=lambda one: (bool(one.refused), -one.separation, -one.if_a - one.if_b))


def rivals(model: Model, effect_a: str, effect_b: str) -> tuple[Model, Model]:
    """Two machines, each with one of the effects and without the other; errors as `separate`."""
    if effect_a == effect_b:
        raise UsageError(f"{effect_a} is given twice; it takes two different effects")
    for name in (effect_a, effect_b):
        model.library.find(name)
    others = [name for name in model.effects if name not in (effect_a, effect_b)]

    def having(effect: str) -> Model:
        known = effect in model.effects
        return model.with_effects(
            [name for name in model.effects if name in others or name == effect] if known else [*others, effect]
        )

    return having(effect_a), having(effect_b)


def _judge(offer: Offer, models: tuple[Model, Model], effects: tuple[str, str], noise: Noise) -> Separation:
    """The separation by `offer` if the first model is true, and if the second is."""
    found, duration = [], 0.0
    for k, truth in enumerate(models):
        records = [record(part, truth) for part in offer.parts]
        refused = [one for one in records if isinstance(one, str)]
        if refused:
            return Separation(offer, 0.0, 0.0, "", 0.0, refused[0])
        other, name = models[1 - k], effects[1 - k]
        evidence = [Whitened(one, other, noise) for one in records if isinstance(one, Record)]
        found.append(imitate(evidence, truth, other, unknowns(other, name)))
        duration = max(duration, sum(one.duration for one in records if isinstance(one, Record)))
    totals = [float(np.sqrt(sum(left))) for left in found]
    least = found[int(np.argmin(totals))]
    return Separation(offer, totals[0], totals[1], (*families(models[0]), PRIOR)[int(np.argmax(least))], duration)
