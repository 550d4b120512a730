"""The programme of an experiment and the folder for its recordings, from parameters."""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError
from pneumo_ros.experiment.catalogue import make_programme
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.programme_file import read_programme
from pneumo_ros.plant import load_model


def prepare(values: Mapping[str, Any], effects_files: tuple[str | Path, ...]) -> tuple[Programme, Path]:
    """Programme and folder. Raises UsageError when a recording exists already, and what reading programme or machine
    file raises.
    """
    if values["programme"]:
        programme = read_programme(Path(values["programme"]).expanduser())
    else:
        programme = make_programme(values["experiment"], load_model(values["model"], effects_files))
    folder = Path(values["output"] or time.strftime("experiment_%Y_%m_%d-%H_%M_%S")).expanduser()
    there = [trial.name for trial in programme.trials if (folder / trial.name).exists()]
    if there:
        raise UsageError(f"{folder / there[0]} exists and is not overwritten; name another folder as output")
    return programme, folder
