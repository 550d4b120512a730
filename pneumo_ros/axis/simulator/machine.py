"""The machine that ROS parameters describe: a whole machine file, or changes to one."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.axis.sections import Given, nested
from pneumo_ros.axis.simulator.force_input import LOAD
from pneumo_ros.axis.simulator.settings import EFFECTS
from pneumo_ros.errors import UsageError
from pneumo_ros.multiaxis import Machine, load_machine
from pneumo_ros.multiaxis.machine_file import machine_from_dict
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import Library, Model, load_model, model_from_dict
from pneumo_ros.plant.axes_section import AXES, SUPPLY
from pneumo_ros.plant.closed import SECOND
from pneumo_ros.units import shown

TOPICS = (SECOND, LOAD)  # inputs that the simulator gets as topics, beside the voltage


def machine_from_parameters(base: str, given: Mapping[str, Any], effects_files: Iterable[str | Path] = ()) -> Model:
    """The model that the `given` parameters describe.

    A whole machine file (effects and sections piston, air and an actuator) is used alone, and must be complete.
    Otherwise `given` changes the machine file `base`. Raises UsageError with the nearest names.
    """
    values, files = dict(given), tuple(effects_files)
    sections = {name.partition(".")[0] for name in values}
    if {EFFECTS, "piston", "air"} <= sections and sections.intersection(Library(files).actuators()):
        return _simulable(model_from_dict(nested(values), "parameters", Library(files)))
    return _with(load_model(base, files), values)


def machine_of_axes(base: str, given: Given, effects_files: Iterable[str | Path] = ()) -> Machine:
    """The machine of several axes that the `given` parameters describe: a whole one, or changes of the file `base`.

    Raises UsageError as `machine_from_parameters`, with the axis named.
    """
    if AXES in given:
        machine = machine_from_dict(nested(given), "parameters", Library(effects_files))
    else:
        machine = _changed(load_machine(base, effects_files), given)
    return machine.with_axes({axis: _simulable(one) for axis, one in machine.axes.items()})


def _changed(machine: Machine, given: Given) -> Machine:
    """`machine` with the parameters whose names begin with an axis, or with the supply that all share."""
    line, axes = dict(machine.supply or {}), {*machine.axes}
    changes: dict[str, dict[str, Any]] = {axis: {} for axis in axes}
    for name, value in given.items():
        section, _, key = name.partition(".")
        if section == SUPPLY and key in line:
            line[key] = float(value)
        elif section in axes:
            changes[section][key] = value
        else:
            raise UsageError(
                unknown_name("parameter", name, [f"{axis}.{n}" for axis in axes for n in machine.axes[axis].parameters])
            )
    found = {axis: _with(model, changes[axis]) for axis, model in machine.axes.items() if changes[axis]}
    return machine.with_axes(found).with_supply(line or None)


def _with(model: Model, values: Mapping[str, Any]) -> Model:
    """`model` with the effects and the parameters in `values`."""
    rest = dict(values)
    effects = rest.pop(EFFECTS, None)
    if effects is not None:
        model = model.with_effects(list(effects))
    return _simulable(model.with_parameters(rest) if rest else model)


def changed(model: Model, values: Mapping[str, Any]) -> Model:
    """`model` with the effects and parameters in `values`, as far as they are the machine's; UsageError as above.

    The same model is returned when nothing differs.
    """
    effects = tuple(values.get(EFFECTS, model.effects))
    if effects != model.effects:
        model = model.with_effects(effects)
    new = {n: v for n, v in values.items() if n in model.parameters and v != model.parameters[n]}
    return _simulable(model.with_parameters(new) if new else model)


def check_live(model: Model, before: Model, position: float) -> None:
    """Raise UsageError unless the piston at `position` [m] of the machine `before` can go on as `model`.

    A new stroke must hold it. A piston that a wrong model threw out of the old stroke does not block its mending.
    """
    values = model.parameters
    static, coulomb = (values.get(f"lugre_friction.{name}_friction", 0.0) for name in ("static", "coulomb"))
    if static < coulomb:
        raise UsageError(
            f"static friction {static:g} {shown('N')} is below Coulomb friction {coulomb:g} "
            f"{shown('N')}: it takes as much or more; "
            "set both together to change both"
        )
    supply, atmosphere = values["air.supply_pressure"], values["air.atmospheric_pressure"]
    if supply < atmosphere:
        raise UsageError(
            f"the supply pressure, {supply:g} Pa, is absolute: it takes the atmosphere's {atmosphere:g} Pa or more"
        )
    reach = 0.5 * values["piston.stroke"]
    if values["piston.stroke"] != before["piston.stroke"] and abs(position) > 1.05 * reach:
        raise UsageError(
            f"the piston is at {position:.4g} {shown('m')}, outside of a stroke of {2.0 * reach:g} "
            f"{shown('m')}; move it inside first"
        )
    model.state()  # chambers keep a volume at both ends


def _simulable(model: Model) -> Model:
    if model.force_driven:
        raise UsageError(f"{model.name} has no chambers; the simulator takes a machine file with a section 'chambers'")
    if measured := ", ".join(name for name in model.inputs[1:] if name not in TOPICS):
        raise UsageError(
            f"effects of {model.name} read what only a recording has ({measured}); the simulator takes a machine file "
            "without them"
        )
    return model
