"""One campaign examined: parameters with intervals, and effects that its machine lacks. The work of a fleet's sweep."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pneumo_ros.discover.diagnosis import diagnose
from pneumo_ros.errors import DataError
from pneumo_ros.identify.campaign import identify
from pneumo_ros.identify.plausible import check_run
from pneumo_ros.identify.run import Run, make_run
from pneumo_ros.plant import Model, load_model
from pneumo_ros.records import read_recording

HELD = "hold"  # recordings of such names are not fitted: they judge
NORMAL = 1.96  # deviations of a 95 % interval

Interval = dict[str, Any]  # value, low, high, unit


def examine(paths: Sequence[str], model: str, effects: Sequence[str], diagnosing: bool) -> dict[str, Any]:
    """What the recordings at `paths` say of their machine, as JSON; `model` and `effects` are files or a shipped name.

    parameters: dotted name -> value and 95 % interval, of identification and of added effects. added: effects that
    held-out recordings support, with those that explain as much. verdict is null without held-out recordings, or when
    they are not `diagnosing`. Raises DataError when no recording can be used, UsageError as `load_model`.
    """
    machine = load_model(model, tuple(effects))
    runs, passed = _read(machine, paths)
    held = [run for run in runs if run.name.startswith(HELD)]
    fitted = [run for run in runs if run not in held] or held
    found: dict[str, Any] = {"parameters": {}, "added": [], "verdict": None, "undetermined": {}, "passed_over": passed}
    try:
        known = identify(machine, fitted)
        found["parameters"] = {name: one for name in known.parameters if (one := _interval(known, name))}
        found["undetermined"] = dict(known.undetermined)
    except DataError as error:  # no constant voltages: a diagnosis may do without
        found["undetermined"] = {"all": str(error)}
    if diagnosing and held and fitted is not held:
        _add_diagnosis(found, machine, fitted, held)
    return found


def _read(machine: Model, paths: Sequence[str]) -> tuple[list[Run], dict[str, str]]:
    """The runs that can be used, and why others cannot; names are those of their folders."""
    runs, passed = [], {}
    for path in paths:
        try:
            run = make_run(read_recording(path), machine.force_driven)
            check_run(machine, run)
            runs.append(run)
        except DataError as error:
            passed[Path(path).name] = str(error)
    if not runs:
        raise DataError(f"none of {len(paths)} recordings can be used; the last: {list(passed.values())[-1]}")
    return runs, passed


def _interval(known: Any, name: str) -> Interval | None:
    one = known.parameters[name]
    if one.interval is None:
        return None
    low, high = map(float, one.interval)
    return {"value": float(one.value), "low": low, "high": high, "unit": one.unit}


def _add_diagnosis(found: dict[str, Any], machine: Model, fitted: list[Run], held: list[Run]) -> None:
    outcome = diagnose(machine, fitted, held)
    found["verdict"] = outcome.verdict
    for one in outcome.added:
        found["added"].append({"effect": one.effect, "rivals": list(one.indistinguishable_from)})
        for key, value in one.parameters.items():
            half = NORMAL * float(value.std)
            if half < float("inf"):
                middle = float(value.value)
                found["parameters"][f"{one.effect}.{key}"] = {
                    "value": middle, "low": middle - half, "high": middle + half, "unit": value.unit,
                }  # fmt: skip
