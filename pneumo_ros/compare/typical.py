"""The one number of a model: the error of a typical window of predictions, in noise floors."""

import math
from collections.abc import Mapping, Sequence
from typing import Any


def typical_error(runs: Sequence[Mapping[str, Any]]) -> float | None:
    """Error of a typical window over `runs`, as they stand in the JSON of `compare`; 1 is the noise floor.

    The geometric mean over all windows, then the root mean square over the signals, as `pneumo diagnose` and `pneumo
    add` judge. None where nothing was predicted, or where a simulation diverged.
    """
    found = [run for run in runs if run["windows"]]
    if not found:
        return None
    total, squares = sum(run["windows"] for run in found), []
    for signal in found[0]["error"]:
        ratios = [(run["windows"], run["error"][signal]["typical_ratio_to_noise"]) for run in found]
        if not all(ratio is not None and 0.0 < ratio < math.inf for _, ratio in ratios):
            return None
        squares.append(math.exp(sum(n * math.log(ratio) for n, ratio in ratios) / total) ** 2)
    return math.sqrt(sum(squares) / len(squares))
