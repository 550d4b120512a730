"""A commissioning on a live plant: each programme is performed by the node of experiments, or read where it was."""

import json
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any

from pneumo_ros.command.conducting import conduct
from pneumo_ros.command.console import Console
from pneumo_ros.commission.performing import Perform, Performed
from pneumo_ros.commission.safe import may_be_tried_again
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.experiment.programme import Programme

INTERRUPTED = 130  # exit code of the node
SUMMARY = "experiment.json"
AS_IT_IS = ","  # a list of no words, in place of that of the rig file


class InterruptedCommissioningError(PneumoError):
    """The commissioning was ended from outside; what was recorded is kept."""

    exit_code = INTERRUPTED


def live(folder: Path, settings: Mapping[str, object], namespace: str, console: Console) -> Perform:
    """Performs programmes on the plant in `namespace`, each in a folder of its own inside `folder`.

    A programme whose folder is complete is not performed again: its recordings are read, so that an interrupted
    commissioning goes on. `settings` are those of the node.
    """

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        from pneumo_ros.records import read_recording

        place = folder / name
        result = _kept(place)
        if result is None:
            _aside(place)
            given = {**settings, "output": str(place.resolve()), "read_as": ",".join(words) or AS_IT_IS}
            console.note(f"{programme.experiment}: {len(programme.trials)} moves, recorded in {place}")
            code, result = conduct(programme, given, namespace, console)
            if code == INTERRUPTED:
                raise InterruptedCommissioningError(
                    f"interrupted; the same command goes on after {folder / name} where it stopped"
                )
            if code and not result.get("trials") and not may_be_tried_again(str(result.get("reason", ""))):
                raise DataError(str(result.get("reason", "the experiment failed")))
        else:
            console.note(f"{programme.experiment}: recorded before in {place}")
        joint = str(settings["joint_name"])
        recordings = tuple(read_recording(trial["path"], None, joint) for trial in result["trials"])
        seconds = sum(one.duration for one in recordings)
        return Performed(recordings, seconds, "" if result["complete"] else str(result["reason"]))

    return perform


def _kept(place: Path) -> dict[str, Any] | None:
    """What was performed there before, None unless it ended by itself: complete, or at a limit."""
    try:
        result: dict[str, Any] = json.loads((place / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return result if result.get("complete") or may_be_tried_again(str(result.get("reason", ""))) else None


def _aside(place: Path) -> None:
    """Move a folder of a programme that was broken off out of the way; nothing is lost."""
    if place.exists():
        place.rename(next(free for k in count(1) if not (free := Path(f"{place}_broken_{k}")).exists()))
