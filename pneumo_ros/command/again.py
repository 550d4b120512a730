"""Options that read the same recordings of the same rig once more, for the line that says what to type next."""

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path

HELD = "hold"  # start of the names of recordings that are kept to judge by


def again(options: argparse.Namespace, machine: str | None = None) -> str:
    """How `options` read recordings, and `machine` (None: theirs), as words that follow a verb; "" for the usual.

    A rig file holds its machine: another one is named beside it.
    """
    rig, chosen = getattr(options, "rig_file", None), machine or getattr(options, "model", None) or "axis"
    if rig:
        said = getattr(options, "rig_said", None)
        words = ["--rig", rig] + (["--model", chosen] if chosen != (said.machine if said else "") else [])
    else:
        words = [] if chosen == "axis" else ["--model", chosen]
        for name in ("namespace", "joint", "read_as"):
            value = getattr(options, name, None)
            words += [f"--{name.replace('_', '-')}", value] if value else []
    words += ["--imposed"] if getattr(options, "imposed", False) else []
    for path in getattr(options, "effects", None) or ():
        words += ["--effects", path]
    return "".join(f" {shlex.quote(word)}" for word in words)


def parted(bags: Sequence[str]) -> tuple[list[str], list[str]]:
    """Recordings to fit and to judge by: those whose names begin with hold are held out, else the last one."""
    held = [bag for bag in bags if Path(bag).name.startswith(HELD)]
    fitted = [bag for bag in bags if bag not in held]
    if not fitted or not held:
        return list(bags[:-1]), list(bags[-1:])
    return fitted, held
