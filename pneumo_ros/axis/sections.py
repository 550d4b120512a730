"""Dotted parameters of a node as sections of a machine file, and back; what one axis of several has of them."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError
from pneumo_ros.plant.axes_section import AXES, axis_names, axis_sections

Given = Mapping[str, Any]


def nested(values: Given) -> dict[str, Any]:
    """Sections within sections from dotted names; UsageError where one name is a value and a section."""
    result: dict[str, Any] = {}
    for name, value in values.items():
        *sections, key = name.split(".")
        inner = result
        for section in sections:
            inner = inner.setdefault(section, {})
            if not isinstance(inner, dict):
                raise UsageError(f"{name} is given, and {section} as a value: one of them is too much")
        inner[key] = list(value) if hasattr(value, "__iter__") and not isinstance(value, str) else value
    return result


def flat(sections: Given) -> dict[str, Any]:
    """Dotted names from sections within sections."""
    result: dict[str, Any] = {}
    for key, value in sections.items():
        inner = {f"{key}.{name}": v for name, v in flat(value).items()} if isinstance(value, Mapping) else {key: value}
        result |= inner
    return result


def settings_of(given: Given, axis: str, own: Collection[str]) -> dict[str, Any]:
    """What a node of `axis` has of the node's `own` parameters: those for all, and in their place its own."""
    mine = {name.removeprefix(f"{axis}."): value for name, value in given.items() if name.startswith(f"{axis}.")}
    return {name: value for name, value in {**given, **mine}.items() if name in own}


def of_the_machine(given: Given, axes: Collection[str], own: Collection[str]) -> dict[str, Any]:
    """The parameters that are no node's `own`, of all axes or of one of `axes`."""
    plain = {name: name.partition(".")[2] if name.partition(".")[0] in axes else name for name in given}
    return {name: value for name, value in given.items() if plain[name] not in own}


def of_axis(given: Given, namespace: str, own: Collection[str], node: str) -> Given:
    """The parameters of the node of one axis, `node` by name, whose file holds several: its namespace ends in the axis.

    The same parameters where there are no `axes`. UsageError, with what to type, for a namespace of no axis.
    """
    if AXES not in given:
        return given
    names = tuple(given[AXES])
    axis = namespace.rpartition("/")[2]
    if axis not in names:
        raise UsageError(
            f"the machine has the axes {', '.join(names)}, and a {node} moves one: start it in that one's namespace, "
            f"such as -r __ns:=/{names[0]}"
        )
    sections = nested(of_the_machine(given, names, own))
    return {"joint_name": axis, **flat(axis_sections(sections)[axis]), **settings_of(given, axis, own)}


def with_arm(given: Given) -> Given:
    """The same, with the coefficients of an arm in place of its URDF, whose file is named from the present folder.

    UsageError as `plant.arm_section.coefficients`.
    """
    arm = {name: value for name, value in given.items() if name.startswith("arm_load.")}
    if "arm_load.urdf" not in arm:
        return given
    from pneumo_ros.plant.arm_section import coefficients  # Pinocchio is optional, and seldom needed

    found = coefficients(nested(arm)["arm_load"], given.get("piston.stroke"), Path())
    rest = {name: value for name, value in given.items() if name not in arm}
    return rest | {f"arm_load.{name}": value for name, value in found.items()}


def listed_axes(given: Given) -> tuple[str, ...]:
    """The axes that the parameters list; () for a machine of one axis."""
    return axis_names(nested(given)) if AXES in given else ()
