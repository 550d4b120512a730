"""Machine files of several axes: `axes` lists their names, and each has a section with effects and parameters.

What stands beside them - air, effects, lugre_friction - holds for every axis that uses it and has none of its own. The
section `supply_pressure_droop` beside them is the line from which all axes draw.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.library import ACTUATORS, FRAME
from pneumo_ros.units import KEY

AXES = "axes"
SUPPLY = "supply_pressure_droop"  # beside the axes: what they share
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_LAYOUT = "such as axes: [shoulder, elbow], and a section shoulder: and elbow: with the parts of each"


def axis_names(given: Mapping[str, Any]) -> tuple[str, ...]:
    """Names of the axes of a machine file's sections; () for a machine of one axis. UsageError for a bad list."""
    if AXES not in given:
        return ()
    listed = given[AXES]
    if not isinstance(listed, list) or not listed or not all(isinstance(name, str) for name in listed):
        raise UsageError(f"'{AXES}' is {brief(listed)}; it takes a list of names, {_LAYOUT}")
    for name in listed:
        if not _NAME.fullmatch(name):
            raise UsageError(f"axis {name!r} is no name for topics; take letters, digits and _, {_LAYOUT}")
        if listed.count(name) > 1:
            raise UsageError(f"axis {name} is listed twice")
        if not isinstance(given.get(name), Mapping):
            raise UsageError(f"axis {name} has no section of its own; {_LAYOUT}")
    return tuple(listed)


def axis_sections(given: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The sections of each axis as those of a machine of its own: shared ones, then its own in their place."""
    names = axis_names(given)
    shared = {key: value for key, value in given.items() if key not in (AXES, SUPPLY, *names)}
    result = {name: _with_shared(given[name], shared) for name in names}
    used = {key for sections in result.values() for key in sections}
    if unused := [key for key in shared if key not in used]:
        raise UsageError(f"{unknown_name('section', str(unused[0]), {*used, *names, SUPPLY})}; no axis uses it")
    return result


def _with_shared(own: Mapping[str, Any], shared: Mapping[str, Any]) -> dict[str, Any]:
    """The sections of one axis: its own, and the shared ones that it uses."""
    effects = own.get("effects", shared.get("effects"))
    listed = [name for name in effects if isinstance(name, str)] if isinstance(effects, list) else []
    actuated = any(name in own for name in ACTUATORS)
    used = {"effects", KEY, *FRAME, *listed} - set(ACTUATORS if actuated else ())
    return {**{key: value for key, value in shared.items() if key in used}, **own}


def place_of(name_or_path: str | Path) -> tuple[str | Path, str | None]:
    """A machine file and the axis in it, from `two.yaml:shoulder`; None where no axis is named."""
    text = str(name_or_path)
    path, colon, axis = text.rpartition(":")
    return (
        (path, axis) if colon and path and _NAME.fullmatch(axis) and not Path(text).exists() else (name_or_path, None)
    )


def from_anywhere(name_or_path: str | Path) -> str:
    """A machine file, or an axis in it, by its whole path; the name of a shipped machine as it is."""
    path, axis = place_of(name_or_path)
    if not Path(path).is_file():
        return str(name_or_path)
    return f"{Path(path).resolve()}:{axis}" if axis else str(Path(path).resolve())


def one_axis(given: Mapping[str, Any], place: str | Path, axis: str | None) -> Mapping[str, Any]:
    """The sections of a machine of one axis: all of them, or those of `axis`.

    UsageError where the file at `place` has several axes and none is named, or no such one.
    """
    names = axis_names(given)
    if axis is None and not names:
        return given
    if not names:
        raise UsageError(f"it holds one axis without a name; type {place} instead of {place}:{axis}")
    if axis is None:
        raise UsageError(f"it has the axes {', '.join(names)}; say which, such as {place}:{names[0]}")
    if axis not in names:
        raise UsageError(unknown_name("axis", axis, names))
    return axis_sections(given)[axis]
