"""Machine files of several axes: read as one `Machine`, and written as one."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.files import yaml_number
from pneumo_ros.multiaxis.machine import Machine
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import Effect, Library, machine_file
from pneumo_ros.plant.axes_section import AXES, SUPPLY, axis_names, axis_sections


def holds_axes(name_or_path: str | Path) -> bool:
    """Whether a machine file has several axes; False for one that cannot be read, which loading it will say."""
    try:
        return AXES in machine_file.sections_of(machine_file.read_machine(name_or_path)[1])
    except (UsageError, OSError, ValueError):
        return False


def load_machine(name_or_path: str | Path, effects_files: Iterable[str | Path | type[Effect]] = ()) -> Machine:
    """The machine of a file with `axes`, completely or not at all; errors as `load_model`, with the axis named."""
    name, text = machine_file.read_machine(name_or_path)
    try:
        given, folder = machine_file.sections_of(text), machine_file.folder_of(name_or_path)
        return machine_from_dict(given, name, Library(effects_files), folder)
    except UsageError as error:
        raise UsageError(f"machine file {name_or_path}: {error}") from error


def machine_from_dict(given: Mapping[str, Any], name: str, library: Library, folder: Path = Path()) -> Machine:
    """A machine from the sections of its file; UsageError where it has no axes or one of them is wrong."""
    if not axis_names(given):
        raise UsageError("it has no 'axes'; load it by load_model")
    axes = {}
    for axis, sections in axis_sections(given).items():
        try:
            axes[axis] = machine_file.model_from_dict(sections, f"{name}:{axis}", library, folder)
        except UsageError as error:
            raise UsageError(f"axis {axis}: {error}") from error
    return Machine(name, axes, _supply(given[SUPPLY], library) if SUPPLY in given else None)


def _supply(given: object, library: Library) -> dict[str, float]:
    """Checked parameters of the shared line."""
    known = library.find(SUPPLY).parameters
    if not isinstance(given, Mapping):
        raise UsageError(f"section {SUPPLY} is {brief(given)}; it takes {', '.join(known)}")
    for key in given:
        if key not in known:
            raise UsageError(unknown_name(f"parameter of {SUPPLY}", str(key), known))
    if absent := [key for key in known if key not in given]:
        raise UsageError(f"section {SUPPLY} beside the axes lacks {', '.join(absent)}")
    return {key: known[key].check(f"{SUPPLY}.{key}", machine_file._number(given[key])) for key in known}


def machine_text(machine: Machine) -> str:
    """The machine file, each axis with all its sections, and units and meanings beside the values."""
    lines = ["/**:", "  ros__parameters:", f"    {AXES}: [{', '.join(machine.axes)}]"]
    if machine.supply is not None:
        known = next(iter(machine.axes.values())).library.find(SUPPLY).parameters
        lines.append(f"    {SUPPLY}:  # the line from which all axes draw")
        lines += [
            f"      {key}: {yaml_number(value)}  # [{known[key].unit}] {known[key].meaning}"
            for key, value in machine.supply.items()
        ]
    for axis, model in machine.axes.items():
        own = machine_file.machine_text(model).splitlines()[2:]  # without its two lines of ROS
        lines += [f"    {axis}:", *("  " + line for line in own)]
    return "\n".join(lines) + "\n"
