"""Output of an identification: a numbered machine file, the whole result beside it, and a message."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.errors import DataError
from pneumo_ros.files import write_whole
from pneumo_ros.plant import Model, save_model

_NUMBERS = 1000  # tried at most: fewer identifications end at the same moment
_EVIDENCE = ("map", "refused", "breakaways", "machine")  # large; only in the file


def store(model: Model, result: Mapping[str, Any], folder: Path) -> Path:
    """Write machine file and result under the first free number; returns the machine file's path.

    Raises UsageError when the folder cannot be made or written, DataError when the disk is full or no number is free.
    """
    folder.mkdir(parents=True, exist_ok=True)
    first = 1 + max((_number(path) for path in folder.glob(f"{model.name}_*.yaml")), default=0)
    path = next(filter(None, (_saved(model, folder, first + k) for k in range(_NUMBERS))), None)
    if path is None:
        raise DataError(f"{folder}: others took {_NUMBERS} numbers in a row from {first} on; give a folder of your own")
    write_whole(path.with_suffix(".json"), json.dumps(result, indent=1) + "\n")
    return path


def _saved(model: Model, folder: Path, number: int) -> Path | None:
    """The machine file of that number, None where somebody else took the number meanwhile."""
    path = folder / f"{model.name}_{number}.yaml"
    try:
        save_model(model, path, overwrite=False)
    except DataError:
        if not path.exists():  # the disk is full
            raise
        return None
    return path


def _number(path: Path) -> int:
    digits = path.stem.rpartition("_")[2]
    return int(digits) if digits.isdigit() else 0


def message(result: Mapping[str, Any]) -> dict[str, Any]:
    """The published part of a result: parameters with intervals, what is not determined, and the recordings used."""
    short = {name: value for name, value in result.items() if name not in _EVIDENCE}
    short["runs"] = [{key: run[key] for key in ("name", "windows", "used")} for run in result["runs"]]
    fit = result["map"]
    short["map"] = {name: fit[name] for name in ("residual_rms_n", "share_of_force", "ratio_to_noise") if name in fit}
    return short


def determined(result: Mapping[str, Any]) -> dict[str, float]:
    """Values of the parameters that the recordings determine; those of a refit of the whole model come first."""
    found = {name: one for name, one in result["parameters"].items() if one["determined"]}
    if "refit" in result:
        refitted = result["refit"]["parameters"].items()
        found |= {name: one for name, one in refitted if one["determined"] or name in found}
    return {name: float(one["value"]) for name, one in found.items()}


def sentence(result: Mapping[str, Any]) -> str:
    """One line for the log."""
    values = [
        f"{name} {one['value']:.5g} ({one['low']:.5g} to {one['high']:.5g}) {one['unit']}"
        for name, one in result["parameters"].items()
        if one["determined"]
    ]
    unknown = ", ".join(result["undetermined"])
    recordings = f"{len(result['recordings'])} recordings in {result['took_s']:.1f} s"
    return f"{recordings}: {'; '.join(values) or 'nothing'}" + (f"; not determined: {unknown}" if unknown else "")
