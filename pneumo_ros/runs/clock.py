"""Runs of one machine on one sample time: clocks a little apart, and rates apart."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.records.rates import laid
from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]

# relative difference of sample times: that counts as equal (two runs may be twice as far apart), and the largest that
# is one rate with an uneven clock
SAME, ALIKE = 2e-4, 0.2


def on_one_clock(runs: Sequence[Run]) -> list[Run]:
    """The runs on their median sample time, by linear interpolation, where theirs differ from it by up to 20 %.

    Where a rate differs by more, all are laid on that of the slowest, and what is too fast for it is filtered out.
    """
    if not runs:
        return []
    step = common_step(runs)
    return [_laid(run, step) if abs(run.sample_time / step - 1.0) > SAME else run for run in runs]


def common_step(runs: Sequence[Run]) -> float:
    """The sample time [s] that runs are laid on: their median, or the longest where they differ by more than 20 %."""
    steps = np.array([run.sample_time for run in runs])
    middle = float(np.median(steps))
    return middle if np.all(np.abs(steps / middle - 1.0) <= ALIKE) else float(steps.max())


def lowered(runs: Sequence[Run]) -> str:
    """Which rates are lowered where the runs are fitted together, in words; empty where none is."""
    step = common_step(runs) if runs else 0.0
    faster = [run for run in runs if run.sample_time < step * (1.0 - ALIKE)]
    if not faster:
        return ""
    rates = sorted({f"{1.0 / run.sample_time:.4g}" for run in faster}, key=float)
    which = faster[0].name if len(faster) == 1 else f"{len(faster)} recordings"
    return (
        f"Rates differ: {which} of {', '.join(rates)} Hz count at the {1.0 / step:.4g} Hz of the slowest, without what "
        "is too fast for it"
    )


def _laid(run: Run, step: float) -> Run:
    """The run on a grid of `step` [s]; a point is measured where the nearest sample was."""
    n = int((len(run) - 1) * run.sample_time / step * (1.0 + 1e-12)) + 1
    at = np.asarray(np.arange(n) * (step / run.sample_time), dtype=np.float64)  # in samples
    nearest = np.minimum(np.rint(at).astype(np.int64), len(run) - 1)
    edges = np.minimum(np.arange((n - 1) * PARTS + 1) * (step / run.sample_time), len(run.input))  # in parts
    faster = step > run.sample_time * (1.0 + ALIKE)

    def lay(signal: Array | None) -> Array | None:
        return None if signal is None else laid(at, np.arange(len(run), dtype=np.float64), signal, lowered=faster)

    def hold(parts: Array) -> Array:
        if not faster:
            return np.asarray(parts[np.minimum((0.5 * (edges[1:] + edges[:-1])).astype(np.int64), len(parts) - 1)])
        total = np.interp(edges, np.arange(len(parts) + 1), np.concatenate([[0.0], np.cumsum(parts)]))
        return np.asarray(np.diff(total) / np.diff(edges))

    position = lay(run.position)
    assert position is not None
    return replace(
        run, sample_time=step, position=position, pressure_a=lay(run.pressure_a), pressure_b=lay(run.pressure_b),
        input=hold(run.input), measured=run.measured[nearest],
        further={name: hold(parts) for name, parts in run.further.items()},
    )  # fmt: skip
