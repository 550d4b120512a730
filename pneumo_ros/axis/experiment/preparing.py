"""The programme of an experiment and the folder for its recordings, from parameters."""

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneumo_ros.axis.rig import rig_of
from pneumo_ros.errors import UsageError
from pneumo_ros.experiment.catalogue import make_programme
from pneumo_ros.experiment.programme import Programme, within
from pneumo_ros.experiment.programme_file import read_programme
from pneumo_ros.plant import load_model
from pneumo_ros.units import LINE


def prepare(values: Mapping[str, Any], effects_files: tuple[str | Path, ...]) -> tuple[Programme, Path]:
    """Programme and folder, from parameters and `model_given`: whether somebody chose the machine.

    Raises UsageError when a recording exists already or the rig's limits are angles, and what reading programme,
    machine file or rig file raises.
    """
    rig = rig_of(values)
    if values["programme"]:
        programme = read_programme(Path(values["programme"]).expanduser())
    else:
        chosen = values["model_given"] or rig.machine
        model = values["model"] if values["model_given"] or not rig.machine else rig.machine
        machine = load_model(model, effects_files)
        machine.require_metres("an experiment")
        programme = make_programme(values["experiment"], machine)
        if not chosen:  # the default machine is not a word on this rig
            programme = replace(programme, says_closed=False)
    if rig.limits:  # programmes are in m
        programme = within(programme, rig.limits.along(LINE, programme.machine))
    folder = Path(values["output"] or time.strftime("experiment_%Y_%m_%d-%H_%M_%S")).expanduser()
    there = [trial.name for trial in programme.trials if (folder / trial.name).exists()]
    if there:
        raise UsageError(f"{folder / there[0]} exists and is not overwritten; name another folder as output")
    return programme, folder
