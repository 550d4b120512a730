"""--rig: a file that says of a rig which machine it is and how its recordings are wired."""

import argparse
from pathlib import Path
from typing import Any

from pneumo_ros.errors import DataError, UsageError, brief

KEYS = ("machine", "namespace", "joint", "read_as")
_HOW = "type: pneumo rig check BAG --model MACHINE --out rig.yaml"


def apply_rig(options: argparse.Namespace) -> None:
    """Take what the options do not say from the file of --rig, if there is one.

    Raises DataError when it cannot be read, UsageError when it is invalid or says something else than an option.
    """
    path = getattr(options, "rig_file", None)
    if not path:
        return
    given = read_rig(path)
    for key, value in given.items():
        option = "model" if key == "machine" else key
        present = getattr(options, option, None)
        if present not in (None, "", "axis") and value and present != value:
            raise UsageError(
                f"--rig {path} says {key} {value}, and --{option.replace('_', '-')} {present}; leave one out"
            )
        if value and hasattr(options, option):
            setattr(options, option, value)


def read_rig(path: str) -> dict[str, str]:
    """The entries of a rig file; a machine file is found beside it."""
    from pneumo_ros.nearest import unknown_name
    from pneumo_ros.records.corrections import parse_words
    from pneumo_ros.yaml_text import load_yaml

    try:
        document: Any = load_yaml(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no UTF-8 text"
        raise DataError(f"rig file {path} cannot be read ({reason}); {_HOW}") from error
    given = document.get("rig") if isinstance(document, dict) else None
    if not isinstance(given, dict):
        raise UsageError(f"rig file {path} has no section 'rig'; {_HOW}")
    if unknown := [key for key in given if key not in KEYS]:
        raise UsageError(f"rig file {path}: {unknown_name('entry', str(unknown[0]), KEYS)}")
    found = {key: "" if value is None else value for key, value in given.items()}
    if wrong := [key for key, value in found.items() if not isinstance(value, str)]:
        raise UsageError(f"rig file {path}: {wrong[0]} is {brief(found[wrong[0]])}; it takes a text")
    parse_words(found.get("read_as", ""))
    beside = Path(path).parent / found.get("machine", "")
    if found.get("machine") and beside.is_file():
        found["machine"] = str(beside)
    return found
