"""One campaign examined: parameters with intervals, and effects that its machine lacks. The work of a fleet's sweep."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pneumo_ros.diagnose.adding import estimates_along
from pneumo_ros.diagnose.diagnosis import conclude
from pneumo_ros.diagnose.search import Search
from pneumo_ros.errors import DataError
from pneumo_ros.identify.campaign import identify
from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.read import read_runs
from pneumo_ros.reading.rig_file import read_rig, reading_of
from pneumo_ros.runs.inputs import measuring
from pneumo_ros.runs.run import Run

HELD = "hold"  # start of the names of held-out recordings
NORMAL = 1.96  # deviations of a 95 % interval


def examine(
    paths: Sequence[str], model: str, effects: Sequence[str], diagnosing: bool, rig_file: str = ""
) -> dict[str, Any]:
    """Results of the recordings at `paths`, as JSON; `model` and `effects` are files or a shipped name.

    `rig_file` says how they were recorded.

    parameters: dotted name -> value and 95 % interval. added: effects that held-out recordings support, with those that
    explain as much. With held-out recordings and `diagnosing`, parameters are those of the model with the added
    effects, because a missing effect biases the others; otherwise they come from an identification, and verdict is
    null. Raises DataError when no recording can be used, UsageError as `load_model`.
    """
    machine = load_model(model, tuple(effects))
    how = reading_of(read_rig(rig_file), machine) if rig_file else None
    readings = read_runs(paths, machine, how)
    passed = {Path(path).name: why for path, why in readings.refused.items()}
    runs = readings.runs
    held = [run for run in runs if Path(run.name).name.startswith(HELD)]
    fitted = [run for run in runs if run not in held]
    found: dict[str, Any] = {"parameters": {}, "added": [], "verdict": None, "undetermined": {}, "passed_over": passed}
    return found | (_diagnosis if diagnosing and held and fitted else _identification)(machine, fitted or held, held)


def _identification(machine: Model, runs: list[Run], held: list[Run]) -> dict[str, Any]:
    """Parameters from the constant-voltage runs among all recordings."""
    every = [*runs, *(run for run in held if run not in runs)]
    try:
        known = identify(measuring(machine, every), every)
    except DataError as error:  # no such runs: the campaign is kept
        return {"undetermined": {"all": str(error)}}
    parameters = {}
    for name, one in known.parameters.items():
        if one.interval is not None:
            low, high = map(float, one.interval)
            parameters[name] = {"value": float(one.value), "low": low, "high": high, "unit": one.unit}
    return {"parameters": parameters, "undetermined": dict(known.undetermined)}


def _diagnosis(machine: Model, fitted: list[Run], held: list[Run]) -> dict[str, Any]:
    """Effects that the machine lacks, and all parameters refitted with them."""
    search = Search(measuring(machine, [*fitted, *held]), fitted, held)
    course = search.run()
    outcome = conclude(search, course, lambda share, text: None)
    parameters = {
        name: {"value": one.value, "low": one.low, "high": one.high, "unit": course.model.specification(name).unit}
        for name, one in estimates_along(search.fitter, course.model).items()
        if one.determined
    }
    for one in outcome.added:
        for key, value in one.parameters.items():
            half = NORMAL * float(value.std)
            if half < float("inf"):
                middle = float(value.value)
                found = {"value": middle, "low": middle - half, "high": middle + half, "unit": value.unit}
                parameters.setdefault(f"{one.effect}.{key}", found)
    added = [{"effect": one.effect, "rivals": list(one.indistinguishable_from)} for one in outcome.added]
    return {"parameters": parameters, "added": added, "verdict": outcome.verdict}
