"""The headline number of a comparison: a typical window, over runs and signals, as a diagnosis has it."""

import math
from typing import Any

import pytest
from identify.making import rig

from pneumo_ros.command.console import plain
from pneumo_ros.compare.compare import compare
from pneumo_ros.compare.findings import verdict
from pneumo_ros.compare.typical import typical_error
from pneumo_ros.compare.wording import times
from pneumo_ros.diagnose.prediction import typical_error as of_a_diagnosis


def run(windows: int, *ratios: float | None) -> dict[str, Any]:
    """A run in the JSON of `compare`, with a ratio for each signal."""
    return {"windows": windows, "error": {str(k): {"typical_ratio_to_noise": r} for k, r in enumerate(ratios)}}


def test_long_runs_count_more_and_signals_alike() -> None:
    assert typical_error([run(3, 1.0, 7.0), run(1, 16.0, 7.0)]) == pytest.approx(math.sqrt((2.0**2 + 7.0**2) / 2.0))


@pytest.mark.parametrize("runs", [[], [run(0, 2.0)], [run(1, math.inf)], [run(1, None)]])
def test_without_a_prediction_there_is_no_number(runs: list[dict[str, Any]]) -> None:
    assert typical_error(runs) is None


def test_it_is_the_number_of_a_diagnosis_and_stands_in_the_verdict() -> None:
    model, _, recorded = rig("train_sweep", effect="viscous_friction", size=180.0)
    found = compare(model, [recorded])
    result = plain(found.as_dict())
    number = typical_error(result["runs"])
    assert number == pytest.approx(of_a_diagnosis({n: e.typical for n, e in found.runs[0].error.items()}))
    assert verdict(result).endswith(f"the error over 1 s is {times(number)} the noise floor.")
    assert verdict(result, [run(1, 2.5)], " on one").endswith("is 2.5 x the noise floor on one.")
