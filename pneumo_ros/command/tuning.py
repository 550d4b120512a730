"""The runs of a tuning over any executor: a piece of work is one run with one set of gains."""

from collections.abc import Sequence
from functools import lru_cache

from pneumo_ros.command.rated_motions import Task, rated_motions
from pneumo_ros.control.control_file import Control
from pneumo_ros.control.tuning import Costs, Gains, RatedMotion, cost
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.closed import centred
from pneumo_ros.sweep import Pool, sweep

# model and files of effects as `load_model` takes them, the numbers of a `Task`, a spool [rad/s]
Tuned = tuple[str, tuple[str, ...], tuple[float, float, float, float], float | None]


def costs_over(pool: Pool, start: Control, tuned: Tuned) -> Costs:
    """Costs of gains of `start`, by runs on the workers of `pool`; bit-identical on every executor.

    Raises NumericalError where a run could not be made.
    """
    runs = range(len(_prepared(tuned)[1]))

    def costs(many: Sequence[Gains]) -> list[float]:
        controls = [(start.law, {**start.gains, **gains}, start.smoothing) for gains in many]
        jobs = {f"{k}, run {run}": (tuned, control, run) for k, control in enumerate(controls) for run in runs}
        found = {}
        for done in sweep(run_cost, jobs, pool):
            if done.problem:
                raise NumericalError(f"gains could not be tried: {done.problem}")
            found[done.key] = done.result
        return [sum(found[f"{k}, run {run}"] for run in runs) / len(runs) for k in range(len(controls))]

    return costs


def run_cost(tuned: Tuned, control: tuple[str, dict[str, float], float], run: int) -> float:
    """Cost of one run: law, gains and smoothing in `control`, the run by its number."""
    machine, motions = _prepared(tuned)
    law, gains, smoothing = control
    return cost(Control(law, gains, smoothing).make(machine.effects, machine.parameters), [motions[run]])


@lru_cache(1)
def _prepared(tuned: Tuned) -> tuple[Model, list[RatedMotion]]:
    """Machine and motions of one tuning; a worker keeps them."""
    model, effects, task, spool = tuned
    machine = centred(load_model(model, effects_files=effects))
    return machine, rated_motions(machine, Task(*task), spool)
