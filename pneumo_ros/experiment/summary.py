"""Results of an experiment, as plain data."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.trial_result import TrialResult


def trial_dict(outcome: TrialResult) -> dict[str, Any]:
    """One trial with units in the names."""
    keys = {"seconds": "valve_open_s", "travel": "travel_m", "speed": "speed_m_s"}
    return {keys.get(key, key): value for key, value in asdict(outcome).items()}


def recorded(outcome: TrialResult, folder: Path) -> dict[str, Any]:
    """One trial, and where its recording is."""
    return trial_dict(outcome) | {"path": str(folder / outcome.name)}


def summary(
    programme: Programme, conductor: Conductor, folder: Path, failure: Exception | None
) -> tuple[str, dict[str, Any]]:
    """A sentence, and the data; `failure` is what ended the experiment early, None if nothing did."""
    complete = failure is None and conductor.done
    trials = [recorded(outcome, folder) for outcome in conductor.outcomes]
    said = "all trials are done" if complete else f"{failure}; the valve is closed"
    return f"{said}; {len(trials)} of {len(programme.trials)} recorded in {folder}", {
        "schema_version": 1,
        "experiment": programme.experiment,
        "machine": programme.machine,
        "complete": complete,
        "reason": "" if complete else str(failure),
        "trials": trials,
    }
