"""The runs of a tuning over any executor: a piece of work is one run with one set of gains."""

from collections.abc import Sequence
from dataclasses import astuple
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.trials import Task, trials_of
from pneumo_ros.control.control_file import Control
from pneumo_ros.control.tuning import Costs, Gains, Trial, cost
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.sweep import Pool, sweep

if TYPE_CHECKING:
    import argparse

RUNS = 4  # of each set of gains: `trials_of`


def costs_over(pool: Pool, start: Control, task: Task, options: "argparse.Namespace") -> Costs:
    """What gains of `start` cost, by runs on the workers of `pool`; the same to the bit on any.

    options: model, effects and spool, as of the command. Raises NumericalError where a run could not be made.
    """
    model = str(Path(options.model).resolve()) if Path(options.model).is_file() else str(options.model)
    effects = tuple(str(Path(path).resolve()) for path in options.effects)

    def costs(many: Sequence[Gains]) -> list[float]:
        controls = [(start.law, {**start.gains, **gains}, start.smoothing) for gains in many]
        jobs = {
            f"{number}, run {k}": (model, effects, astuple(task), options.spool, control, k)
            for number, control in enumerate(controls)
            for k in range(RUNS)
        }
        found = {}
        for done in sweep(run_cost, jobs, pool):
            if done.problem:
                raise NumericalError(f"gains could not be tried: {done.problem}")
            found[done.key] = done.result
        return [sum(found[f"{number}, run {k}"] for k in range(RUNS)) / RUNS for number in range(len(controls))]

    return costs


def run_cost(
    model: str,
    effects: tuple[str, ...],
    task: tuple[float, float, float, float],
    spool: float | None,
    control: tuple[str, dict[str, float], float],
    number: int,
) -> float:
    """Cost of one run: law, gains and smoothing in `control`, the run by its number."""
    machine, trials = _prepared(model, effects, task, spool)
    law, gains, smoothing = control
    return cost(Control(law, gains, smoothing).make(machine.effects, machine.parameters), [trials[number]])


@lru_cache(1)
def _prepared(
    model: str, effects: tuple[str, ...], task: tuple[float, float, float, float], spool: float | None
) -> tuple[Model, list[Trial]]:
    """Of one tuning; a worker keeps them."""
    machine = load_model(model, effects_files=effects)
    return machine, trials_of(machine, Task(*task), spool)
