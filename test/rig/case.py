"""A case: one machine, worn and maybe with hidden effects, and its recordings."""

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import bags, loop
from .excitation import EXCITATIONS, RUNS, programme, run_rng
from .machine import SMOOTH, Machine, Roughness, rough_surface
from .sensors import USUAL, Logger, Run, position_noise, record

_SETTLING = 1000  # samples of closed valve before a recording starts


class Case(NamedTuple):
    """The recordings, and the truth behind them."""

    machine: Machine
    rough: bool
    seed: int
    truth: dict[str, Any]  # JSON: effects, their sizes, the machine's parameters


def roughness(case: Case, name: str, samples: int) -> Roughness:
    """Disturbance of one run: the texture is the machine's, the force is the run's own."""
    if not case.rough:
        return SMOOTH
    return rough_surface(np.random.default_rng([case.seed, 2]), run_rng(case.seed + 1, name), samples)


def make_run(case: Case, name: str, step: float = loop.STEP, logger: Logger = USUAL) -> Run:
    """Simulate and record the run `name` of a case; the same case and name give the same numbers. `step` [s]."""
    rng = run_rng(case.seed, name)
    plan = programme(name, rng)
    n, m, finer = len(plan.voltage), case.machine, logger.finer
    rough, noise = roughness(case, name, n), position_noise(rng, n * finer, logger.noise)
    x = loop.rest(m, plan.position, plan.pressure)
    x = loop.run(m, SMOOTH, x, np.zeros(_SETTLING), step=step)[0][-1]
    states, voltage = loop.run(m, rough, x, plan.voltage, plan.wanted, noise[::finer], plan.limit, step)
    if finer > 1:  # the same motion again, as positions and guard act once a millisecond
        states, _ = loop.run(m, rough, x, np.repeat(voltage, finer), step=step, sample=loop.SAMPLE / finer)
    return record(name, m, states, voltage, noise, rng, logger)


def make_runs(
    case: Case, names: Iterable[str] = RUNS, step: float = loop.STEP, logger: Logger = USUAL
) -> Iterator[Run]:
    """The named runs of a case, one after another."""
    for name in names:
        yield make_run(case, name, step, logger)


def epoch(seed: int) -> int:
    """When the recordings of a seed start, ns since 1970: fixed, so that the same seed gives the same bytes."""
    return (1780101000 + 1000 * (seed % 100000)) * 10**9


def write_case(case: Case, folder: Path, names: Sequence[str] = RUNS, truth: Path | None = None) -> Iterator[Run]:
    """Write the runs of a case as rosbag2 folders under `folder`, yielding each when it is written, then the truth."""
    folder.mkdir(parents=True, exist_ok=True)
    for run in make_runs(case, names):
        bags.write(folder / run.name, run, epoch(case.seed))
        yield run
    truth = truth or folder.with_name(folder.name + ".truth.json")
    truth.write_text(json.dumps(case.truth, indent=2) + "\n")


def runs_for(case: Case, excitation: str = "usual") -> tuple[str, ...]:
    """The runs of a kind of excitation, and runs to the ends of the stroke if the machine differs there."""
    names = EXCITATIONS[excitation]
    return (*names, "train_ends", "holdout_ends") if case.machine.cushion < 1.0 else names
