"""States at the starts of segments that follow from the inputs alone, run from the beginning of each recording.

Spools, valve bodies, delayed commands and the loops of regulators are known wherever the command is. Fitted to each
segment by itself, the start of one that begins inside a pulse would explain what the model lacks.
"""

from collections import OrderedDict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.model import STEP, substeps
from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SETTLING, _HELD = 3.0, 0.01  # s: longer than the slowest spool takes; for how long inputs are held
_KEPT = 64  # results: those of one linearisation and of the steps tried beside it


class Lead:
    """The commanded states where segments begin: segment i at grid point at[i] of run number run[i]."""

    def __init__(self, runs: Sequence[Run], run: Index, at: Index) -> None:
        self.runs, self.run, self.at = tuple(runs), run, at
        self._found: OrderedDict[tuple[str, bytes], Array] = OrderedDict()

    def states(self, model: Model, values: Array) -> Array:
        """(segments, commanded) with parameter values (parameters,); each run begins at rest."""
        composition = model.composition
        needed = [name in composition.commanding for name in composition.parameters]
        key = composition.text, values[needed].tobytes()
        if key not in self._found:
            self._found[key] = self._run(model, values)
        self._found.move_to_end(key)
        if len(self._found) > _KEPT:
            self._found.popitem(last=False)
        return self._found[key]

    def _run(self, model: Model, values: Array) -> Array:
        found = np.empty((len(self.at), len(model.composition.commanded)))
        for number in np.unique(self.run):
            rows = np.flatnonzero(self.run == number)
            instants, back = np.unique(self.at[rows], return_inverse=True)
            found[rows] = led(model, self.runs[number], values, instants)[back]
        return found


def led(model: Model, run: Run, values: Array, at: Index) -> Array:
    """Commanded states (len(at), commanded) at grid points `at` of a run, which ascend, from rest at its first one."""
    out = np.empty((len(at), len(model.composition.commanded)))
    stride, h = substeps(run.sample_time / PARTS, STEP)
    held = np.require(run.inputs(model.inputs), float, ["C", "W"])
    model.kernel.lead(
        model.state(), np.ascontiguousarray(values), held, run.begin, h, stride, PARTS, at.astype(np.int64), out
    )
    return out


def settled(model: Model, inputs: Array) -> Array:
    """Commanded states (n, commanded) after some seconds under each row of constant inputs (n, inputs)."""
    found = np.empty((len(inputs), len(model.composition.commanded)))
    begin, at = model.state(), np.array([round(_SETTLING / _HELD)], dtype=np.int64)
    stride, h = substeps(_HELD, STEP)
    for row, held in zip(found, inputs, strict=True):
        every = np.tile(held, (int(at[0]), 1))
        model.kernel.lead(begin, model.values, every, 0.0, h, stride, 1, at, row[None])
    return found


def columns(model: Model) -> list[int]:
    """Columns of the commanded states of a model."""
    return [model.states.index(name) for name in model.composition.commanded]
