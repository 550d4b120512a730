"""Runs of one machine whose clocks differ a little, laid on one sample time."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]

# relative difference of sample times: that counts as equal (two runs may be twice as far apart), and the largest that
# interpolation bridges
SAME, ALIKE = 2e-4, 0.2


def on_one_clock(runs: Sequence[Run]) -> list[Run]:
    """The runs on their median sample time, by linear interpolation, where theirs differ from it by up to 20 %.

    Runs of other rates stay as they are.
    """
    if not runs:
        return []
    step = float(np.median([run.sample_time for run in runs]))
    return [_laid(run, step) if SAME < abs(run.sample_time / step - 1.0) <= ALIKE else run for run in runs]


def _laid(run: Run, step: float) -> Run:
    """The run on a grid of `step` [s]; a point is measured where the nearest sample was."""
    n = int((len(run) - 1) * run.sample_time / step * (1.0 + 1e-12)) + 1
    at = np.arange(n) * (step / run.sample_time)  # in samples
    nearest = np.minimum(np.rint(at).astype(np.int64), len(run) - 1)
    cells = np.minimum((np.arange((n - 1) * PARTS) + 0.5) * (step / run.sample_time), len(run.input) - 1.0)

    def lay(signal: Array | None) -> Array | None:
        return None if signal is None else np.interp(at, np.arange(len(run)), signal)

    def hold(parts: Array) -> Array:
        return np.asarray(parts[np.minimum(cells.astype(np.int64), len(parts) - 1)])

    position = lay(run.position)
    assert position is not None
    return replace(
        run, sample_time=step, position=position, pressure_a=lay(run.pressure_a), pressure_b=lay(run.pressure_b),
        input=hold(run.input), measured=run.measured[nearest],
        further={name: hold(parts) for name, parts in run.further.items()},
    )  # fmt: skip
