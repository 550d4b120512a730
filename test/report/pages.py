"""Reports to test: of the model's own runs with sensor noise, so that they take seconds."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from identify.making import own

from pneumo_ros.command.console import plain
from pneumo_ros.compare.compare import Comparison, RunComparison, compare
from pneumo_ros.plant import Model
from pneumo_ros.report.chart import Report
from pneumo_ros.report.comparison import comparison_report
from pneumo_ros.report.provenance import provenance

HOSTILE = """<img src=x onerror="window.hacked=1">'"&</script><script>window.hacked=2</script>$x_2$"""
SECONDS = 6.0


@lru_cache(maxsize=1)
def compared() -> tuple[Model, Comparison]:
    """A machine with too little friction against two runs, one of them with a malicious name."""
    model, _, first = own("sweep", seconds=SECONDS)
    wrong = model.with_parameters({"lugre_friction.coulomb_friction": 60.0})
    second = own("steps", seconds=SECONDS)[2]
    return wrong, compare(wrong, [first, replace(second, name=HOSTILE)])


def result_of(comparison: Comparison) -> dict[str, Any]:
    """The JSON of a comparison, as in its file."""
    result: dict[str, Any] = plain(comparison.as_dict())
    return result


def report_of(model: Model, comparison: Comparison) -> Report:
    """The report of a comparison, with an empty origin."""
    return comparison_report(result_of(comparison), comparison, model, provenance([], "axis", ["compare"]))


def many(comparison: Comparison, runs: int, times: int) -> Comparison:
    """`runs` copies of the first run, each `times` as long: many samples, little work."""
    return replace(comparison, runs=(longer(comparison.runs[0], times),) * runs)


def longer(run: RunComparison, times: int) -> RunComparison:
    """A repeated run with noise that does not repeat, so that it compresses as badly as a real one."""

    def tile(values: np.ndarray) -> np.ndarray:
        return np.tile(values, times)

    grid = run.motion.run
    signals = {name: tile(getattr(grid, name)) for name in ("position", "pressure_a", "pressure_b", "measured")}
    grid = replace(grid, **signals, input=np.resize(grid.input, (len(grid) * times - 1) * 10))
    return replace(
        run,
        samples=len(grid),
        duration=float(grid.time[-1]),
        motion=replace(run.motion, run=grid, input=tile(run.motion.input)),
        masks={name: tile(mask) for name, mask in run.masks.items()},
        predicted={name: tile(error) for name, error in run.predicted.items()},
        free_errors={name: tile(error) for name, error in run.free_errors.items()},
    )
