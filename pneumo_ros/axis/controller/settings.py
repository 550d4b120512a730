"""Parameters of the controller, and what they mean for law, valve and reference."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.axis.controller import guiding
from pneumo_ros.axis.controller.guiding import limits_of
from pneumo_ros.axis.priority import PRIORITY
from pneumo_ros.axis.rig import SETTINGS as RIG
from pneumo_ros.axis.rig import LiveRig, live_rig, rig_of
from pneumo_ros.axis.setting import Setting
from pneumo_ros.control import LAWS, Law, Machine, Reference, ValveInverse
from pneumo_ros.control.control_file import SMOOTHEST, SMOOTHING
from pneumo_ros.control.machine import ABSENT, PARAMETERS
from pneumo_ros.control.reference import constant, sine, steps
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.plant.closed import says_closed
from pneumo_ros.plant.library import ACTUATORS, FRAME, USUAL_ACTUATOR, Library
from pneumo_ros.plant.uncertainty import SECTION
from pneumo_ros.records.contract import JOINT
from pneumo_ros.units import KEY, LINE

SHAPES = ("topic", "constant", "steps", "sine")
_DEAD_ZONE = ("right_limit", "left_limit", "right_slope", "left_slope")

_OWN = (
    Setting("joint_name", JOINT, "name of the joint in joint_states", live=False),
    Setting("law", "pid", "control law", live=False, choices=tuple(LAWS)),
    PRIORITY,
    Setting("measurement_timeout", 0.1, "age of the last measurement at which the valve is closed", "s", 0.001, 60.0),
    Setting("max_voltage", 10.0, "limit of the command", "V", 0.0, 100.0),
)
_VALVE = (
    # names as in the machine file, which can be given unchanged
    Setting("dead_zone.right_limit", 0.78, "voltage at which port a begins to fill", "V", 0.0, 10.0),
    Setting("dead_zone.left_limit", 0.78, "magnitude of the voltage at which port a begins to empty", "V", 0.0, 10.0),
    Setting("dead_zone.right_slope", 1.0, "slope beyond the right limit", "V/V", 0.01, 100.0),
    Setting("dead_zone.left_slope", 1.0, "slope beyond the left limit", "V/V", 0.01, 100.0),
    Setting(
        "valve.smoothing", SMOOTHING, "opening by which the jump across the dead zone is complete", "V", 0.0, SMOOTHEST
    ),
)
EFFECTS = "effects"


def _of_machine(name: str, default: float) -> Setting:
    section, _, key = name.partition(".")
    given = (Library.frame(section) if section in FRAME else Library().find(section)).parameters[key]
    return Setting(name, default, given.meaning, "" if given.unit == "1" else given.unit, given.low, given.high)


_MACHINE = (
    Setting(EFFECTS, list(load_model("axis").effects), "effects that the machine file lists", live=False),
    *(_of_machine(name, default) for name, default in PARAMETERS.items()),
)
OF_THE_MACHINE = frozenset({EFFECTS, *PARAMETERS, *(f"dead_zone.{name}" for name in _DEAD_ZONE)})
_REFERENCE = (
    Setting("reference.shape", "topic", "where the reference comes from; topic: position/reference", choices=SHAPES),
    Setting("reference.position", 0.0, "reference of shape constant", "m", -100.0, 100.0),
    Setting("reference.levels", [0.0, 0.06], "references of shape steps, one after the other", "m", -100.0, 100.0),
    Setting("reference.hold", 8.0, "time for which each level is held", "s", 0.001, 1e6),
    Setting("reference.offset", 0.0, "middle of the sine", "m", -100.0, 100.0),
    Setting("reference.amplitude", 0.3, "amplitude of the sine", "m", -100.0, 100.0),
    Setting("reference.frequency", 0.05, "frequency of the sine", "Hz", 0.0, 100.0),
)
_GAINS = tuple(
    Setting(f"{law}.{name}", gain.default, gain.meaning, gain.unit, gain.low, gain.high)
    for law, kind in LAWS.items()
    for name, gain in kind.gains.items()
)
SETTINGS = (*_OWN, *RIG, *_REFERENCE, *guiding.SETTINGS, *_VALVE, *_MACHINE, *_GAINS)


def gains_of(law: str, values: Mapping[str, Any]) -> dict[str, float]:
    """Gains of the law of that name among all parameters."""
    return {name: values[f"{law}.{name}"] for name in LAWS[law].gains}


def valve_of(values: Mapping[str, Any]) -> ValveInverse:
    """The inverse of the valve; UsageError if the values do not describe a valve."""
    dead_zone = {name: values[f"dead_zone.{name}"] for name in _DEAD_ZONE}
    closed = machine_of(values).closed_signal
    room = live_rig(values, closed, said=False).room(closed, values["max_voltage"])
    if room <= 0.0:
        raise UsageError(
            f"max_voltage is {values['max_voltage']:g} V, and the valve is closed at "
            f"{live_rig(values, closed, said=False).wiring.command(closed):g} V: there is no room to open it"
        )
    return ValveInverse(**dead_zone, smoothing=values["valve.smoothing"], max_voltage=room)


def reference_of(values: Mapping[str, Any]) -> tuple[Reference, bool] | None:
    """The reference that the parameters describe, and whether it jumps; None if it comes from topics.

    UsageError for bad values, such as positions outside the limits and the stroke.
    """
    shape, offset = values["reference.shape"], values["reference.offset"]
    if shape == "constant":
        _require_within(values, values["reference.position"])
        return constant(values["reference.position"]), True
    if shape == "steps":
        _require_within(values, *values["reference.levels"])
        return steps(list(values["reference.levels"]), values["reference.hold"]), True
    if shape == "sine":
        amplitude = values["reference.amplitude"]
        _require_within(values, offset + amplitude, offset - amplitude)
        return sine(amplitude, values["reference.frequency"], offset), False
    return None


def _require_within(values: Mapping[str, Any], *positions: float) -> None:
    limits = limits_of(values).on_stroke(machine_of(values).stroke)
    for position in positions:
        limits.require(position)


def machine_of(values: Mapping[str, Any]) -> Machine:
    """What the law knows of the machine."""
    return Machine.of(values[EFFECTS], values)


def law_of(values: Mapping[str, Any]) -> Law:
    """The law that the parameters describe; UsageError for a gain out of range or a wrong valve."""
    return LAWS[values["law"]](gains_of(values["law"], values), valve_of(values), machine_of(values))


def check(values: Mapping[str, Any]) -> None:
    """Raise UsageError unless the parameters make a law, leave room to move, and keep the reference inside it."""
    limits_of(values).on_stroke(law_of(values).machine.stroke)
    reference_of(values)


def of_a_machine_file(given: Mapping[str, Any]) -> set[str]:
    """Names that a machine file brought along and that no law uses; UsageError for a machine that turns
    or has another actuator than `chambers`.
    """
    effects = given.get(EFFECTS)
    if effects is None:
        return set()
    if given.get(KEY, LINE) != LINE:
        raise UsageError(
            f"laws of control plan in m and N; the machine file says '{KEY}: {given[KEY]}', in rad and N m. "
            "Give one of a machine that moves along a line"
        )
    if other := sorted({name.partition(".")[0] for name in given} & {*ACTUATORS} - {USUAL_ACTUATOR}):
        raise UsageError(
            f"laws of control need chambers on both sides of the piston; the machine file has a section '{other[0]}'. "
            f"Give one with a section '{USUAL_ACTUATOR}'"
        )
    sections = {*FRAME, *effects, KEY, SECTION}
    return {name for name in given if name.partition(".")[0] in sections}


def absent(given: Mapping[str, Any]) -> dict[str, float]:
    """Values for effects that a machine file does not list: no friction, a valve that opens at once."""
    effects = given.get(EFFECTS)
    if effects is None:
        return {}
    known = {**ABSENT, "dead_zone.right_limit": 0.0, "dead_zone.left_limit": 0.0}
    listed = {*FRAME, *effects}
    return {n: value for n, value in known.items() if n.partition(".")[0] not in listed and n not in given}


def of_a_rig(values: Mapping[str, Any], begun_with: Mapping[str, Any]) -> dict[str, Any]:
    """Values that the rig file brings along and nobody has given: those of its machine file, and its limits.

    Raises UsageError for a machine that turns or has other chambers, and for limits that are angles: laws plan in m.
    """
    rig = rig_of(values)
    found: dict[str, Any] = {}
    name = "this machine"
    if rig.machine and EFFECTS not in begun_with:
        machine = load_model(rig.machine)
        found, name = {EFFECTS: list(machine.effects), **machine.parameters}, machine.name
        of_a_machine_file({**found, KEY: machine.coordinate})
        found |= absent(found)
    if rig.limits:
        found["limits.low"], found["limits.high"] = rig.limits.along(LINE, name)
    if rig.joint:
        found["joint_name"] = rig.joint
    return {name: value for name, value in found.items() if name in values and name not in begun_with}


def wired_by(values: Mapping[str, Any], begun_with: Mapping[str, Any]) -> LiveRig:
    """The rig; the effects that are listed where nobody gives a machine file say nothing of its valve."""
    machine, given = rig_of(values).machine, EFFECTS in begun_with
    own = load_model(machine).uncertainty if machine and not given else {}
    stated = {name.partition(".")[2]: value for name, value in begun_with.items() if name.partition(".")[0] == SECTION}
    told = (given or bool(machine)) and says_closed(values[EFFECTS], values, {**own, **stated})
    return live_rig(values, machine_of(values).closed_signal, told)
