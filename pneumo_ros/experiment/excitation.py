"""Runs that move the piston both ways: for refits of the whole machine, and to distinguish effects."""

from random import Random

from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.room import dead_zone, room_of
from pneumo_ros.experiment.voltages import Steps, Sweep
from pneumo_ros.plant import Model

SECONDS = 20.0  # of each run
MARGIN = 0.2  # of the stroke kept free before either end: fast motion needs room to turn


def steps(model: Model, seconds: float = SECONDS, seed: int = 0) -> Programme:
    """Two runs of levels drawn from `seed`: up to 2.3 V beyond the dead zone, 0.25 to 1.6 s each, some of them pauses.

    Raises UsageError for a model without valve.
    """
    trials = [
        Trial(f"{name}_{seed}", Steps(_levels(model, Random(f"{name} {seed}"), seconds)), seconds)
        for name in ("train_steps", "holdout_steps")
    ]
    return Programme("steps", model.name, trials=tuple(trials), **room_of(model, MARGIN))


def sweep(model: Model, seconds: float = SECONDS) -> Programme:
    """Sines 2 V beyond the dead zone whose frequency rises from about 0.1 to about 0.9 Hz: pressures at work.

    Raises UsageError for a model without valve.
    """
    volts = _reach(model) + 2.0
    trials = (
        Trial("train_sweep", Sweep(volts, 0.1, 0.9, seconds), seconds),
        Trial("holdout_sweep", Sweep(0.9 * volts, 0.13, 0.7, seconds), seconds),
    )
    return Programme("sweep", model.name, trials=trials, **room_of(model, MARGIN))


def slow_reversals(model: Model, seconds: float = SECONDS) -> Programme:
    """Slow sines a little beyond the dead zone: friction at reversal, breakaways both ways.

    Raises UsageError for a model without valve.
    """
    volts = _reach(model) + 0.35
    trials = (
        Trial("train_slow", Sweep(volts, 0.1, 0.12, seconds), seconds),
        Trial("holdout_slow", Sweep(1.1 * volts, 0.13, 0.1, seconds), seconds),
    )
    return Programme("slow-reversals", model.name, trials=trials, **room_of(model, MARGIN))


def _reach(model: Model) -> float:
    return max(dead_zone(model))


def _levels(model: Model, random: Random, seconds: float) -> tuple[tuple[float, float], ...]:
    """Random levels (seconds, volts) that last `seconds` in total."""
    low, levels, left = _reach(model), [], seconds
    while left > 0.0:
        volts = 0.0 if random.random() < 0.12 else random.choice((-1.0, 1.0)) * (low + random.uniform(0.05, 2.3))
        lasting = min(random.uniform(0.25, 1.6), left)
        levels.append((round(lasting, 3), round(volts, 3)))
        left -= lasting
    return tuple(level for level in levels if level[0] > 0.0)
