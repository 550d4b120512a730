"""A commissioning as plain data."""

from typing import Any

import numpy as np

from pneumo_ros.commission.commission import Commissioned
from pneumo_ros.compare.compare import compare_run
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

JUDGED, HORIZON = 4, 1.0  # the last runs; s of the windows of predictions


def summary(found: Commissioned) -> dict[str, Any]:
    """Moves, parameters and what lacks; SI units, units of parameters beside them."""
    return {
        "moves": [
            {
                "name": move.name, "recordings": list(move.recordings), "seconds": move.seconds,
                "deviations_over_predicted": move.ratio,
            }
            for move in found.moves
        ],
        "seconds": found.seconds,
        "parameters": {
            name: {
                "value": one.value, "std": one.std, "low": one.low, "high": one.high, "before": one.before,
                "prior": one.prior, "determined": one.determined,
                "unit": found.before.specification(name).unit,
            }
            for name, one in found.knowledge.estimates.items()
        },
        "undetermined": list(found.lacking), "next_minute": found.left, "next_move": found.next_move,
    }  # fmt: skip


def errors(found: Commissioned) -> tuple[float, float]:
    """Typical error of the position over its noise, predicted over 1 s: with the machine as given, and as found."""
    runs = [run for run in found.runs if run.time[-1] > 2.0 * HORIZON][-JUDGED:]
    before, after = (_typical(model, runs) for model in (found.before, found.machine))
    return before, after


def _typical(model: Model, runs: list[Run]) -> float:
    logs = []
    for run in runs:
        try:
            logs.append(np.log(compare_run(model, run, HORIZON).error["position_m"].typical))
        except PneumoError:
            continue
    return float(np.exp(np.mean(logs))) if logs else float("nan")
