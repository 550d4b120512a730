"""The machine that ROS parameters describe: a whole machine file, or changes to one."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pneumo_ros.axis.simulator.force_input import LOAD
from pneumo_ros.axis.simulator.settings import EFFECTS
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, Model, load_model, model_from_dict
from pneumo_ros.plant.closed import SECOND

TOPICS = (SECOND, LOAD)  # inputs that the simulator gets as topics, beside the voltage


def machine_from_parameters(base: str, given: Mapping[str, Any], effects_files: Iterable[str | Path] = ()) -> Model:
    """The model that the `given` parameters describe.

    A whole machine file (effects and sections piston, air and an actuator) is used alone, and must be complete.
    Otherwise `given` changes the machine file `base`. Raises UsageError with the nearest names.
    """
    values, files = dict(given), tuple(effects_files)
    sections = {name.partition(".")[0] for name in values}
    if {EFFECTS, "piston", "air"} <= sections and sections.intersection(Library(files).actuators()):
        return _simulable(model_from_dict(_nested(values), "parameters", Library(files)))
    model = load_model(base, files)
    effects = values.pop(EFFECTS, None)
    if effects is not None:
        model = model.with_effects(effects)
    return _simulable(model.with_parameters(values) if values else model)


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
            f"static friction {static:g} N is below Coulomb friction {coulomb:g} N: it takes as much or more; "
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
            f"the piston is at {position:.4g} m, outside of a stroke of {2.0 * reach:g} m; move it inside first"
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


def _nested(values: Mapping[str, Any]) -> dict[str, Any]:
    nested: dict[str, Any] = {}
    for name, value in values.items():
        section, dot, key = name.partition(".")
        if dot:
            nested.setdefault(section, {})[key] = value
        else:
            nested[section] = list(value) if section == EFFECTS else value
    return nested
