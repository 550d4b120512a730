"""Cylinders and valves as sold."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pneumo_ros.parts.part import Part


def parts(*, kind: str | None = None, folders: Iterable[str | Path] = ()) -> "dict[str, Part]":
    """Cylinders and valves by name: figures in SI units, each with its interval and its source.

    `kind`: "cylinder" or "valve" alone; `folders`: of part files of your own. Raises UsageError for another kind, and
    for a folder without parts.
    """
    from pneumo_ros.errors import UsageError
    from pneumo_ros.nearest import unknown_name
    from pneumo_ros.parts.part import KINDS
    from pneumo_ros.parts.shelf import load_shelf

    if kind is not None and kind not in KINDS:
        raise UsageError(unknown_name("kind of part", kind, KINDS))
    return {name: part for name, part in load_shelf(folders).parts.items() if kind in (None, part.kind)}
