"""Shared by the tests of every effect: all effects, the meaning of arguments, and machines for them."""

import math
from collections.abc import Callable
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Effect, Library, Model, Parameter, load_model, maths
from pneumo_ros.plant.library import ACTUATORS, FRAME
from pneumo_ros.plant.reach import owners_read
from pneumo_ros.plant.signals import SIGNALS

LIBRARY = Library()
FRAME_EFFECTS = [LIBRARY.frame(name) for name in FRAME]
# signals that a simulation of the axis alone does not have
MEASURED = {name for name, row in SIGNALS.items() if row.kind == "measured" and not name.startswith("p_")}


def reads_sensors(effect: type[Effect]) -> bool:
    """Whether an effect reads what only a recording has."""
    return any(MEASURED.intersection(function.reads) for function in effect.functions.values())


EVERY = [*FRAME_EFFECTS, *map(LIBRARY.find, LIBRARY.names())]
CATALOGUE = [effect for effect in map(LIBRARY.find, LIBRARY.names()) if not reads_sensors(effect)]
EFFECTS = {effect.name: effect for effect in [*FRAME_EFFECTS, *CATALOGUE]}
AXIS = load_model("axis")

LONG = {"piston.stroke": 20.0, "chambers.volume_a": 0.02, "chambers.volume_b": 0.02}
HARDLY_A_BRISTLE = {
    "lugre_friction.static_friction": 1e-3, "lugre_friction.coulomb_friction": 1e-3,
    "lugre_friction.bristle_stiffness": 1e3, "lugre_friction.bristle_damping": 0.0,
}  # fmt: skip
_READ_BY_BRISTLES = {"friction_scale", "friction_rise", "static_scale", "static_rise", "slip", "stribeck"}
_RANGES = {  # by unit: where the random values of states and signals lie
    "V": (-10.0, 10.0), "s": (0.0, 1e3), "Pa": (5e4, 1e6), "kg/s": (-0.02, 0.02), "m3": (0.0, 1e-4),
    "N": (-500.0, 500.0), "kg": (0.0, 20.0), "m": (-1.0, 1.0), "m/s": (-5.0, 5.0), "N s/m": (0.0, 5e3), "1": (0.0, 1.0),
    "W": (-300.0, 300.0), "K": (250.0, 400.0),
}  # fmt: skip


def moves_piston(effect: type[Effect]) -> bool:
    """Whether an effect is in a room of the catalogue whose effects act on the piston."""
    return effect.__module__.split(".")[-2] in ("friction", "piston")


def meaning(name: str, effect: type[Effect]) -> tuple[str, Parameter | None]:
    """Unit of an argument of `effect`, and its specification if it is a parameter."""
    if name in effect.parameters:
        return effect.parameters[name].unit, effect.parameters[name]
    for other in (effect, *EFFECTS.values()):
        if name in other.states:
            return other.states[name].unit, None
    if name in SIGNALS:
        return SIGNALS[name].unit, None
    owner, _, key = name.rpartition("__")
    for other in EVERY:
        if key in other.parameters and owner in ("", other.name):
            return other.parameters[key].unit, other.parameters[key]
    raise KeyError(name)


def drawn(parameter: Parameter, random: np.random.Generator) -> float:
    """A value of a parameter: its bounds, its default, or anything between."""
    low = max(parameter.low, -1e3 * (1.0 + abs(parameter.default)))
    high = min(parameter.high, 1e3 * (1.0 + abs(parameter.default)))
    between = random.uniform(low, high)
    if low > 0.0:
        between = math.exp(random.uniform(math.log(low), math.log(high)))
    return float(random.choice([low, high, parameter.default, between, between]))


def argument(name: str, effect: type[Effect], random: np.random.Generator) -> float:
    """A random value of an argument."""
    unit, parameter = meaning(name, effect)
    return drawn(parameter, random) if parameter else float(random.uniform(*_RANGES.get(unit, (-1.0, 1.0))))


def seeded(name: str) -> np.random.Generator:
    """The same random numbers for an effect in every run."""
    return np.random.default_rng(list(name.encode()))


def effect_function(effect: type[Effect], key: str) -> Callable[..., Any]:
    """An effect's function with the names of `maths` at hand, as in a kernel."""
    function = vars(effect)[key]
    return FunctionType(function.__code__, {**vars(maths), **function.__globals__}, key)


def neutral_values(effect: type[Effect]) -> dict[str, float]:
    """Neutral values of an effect's parameters, those that have one, by dotted name."""
    return {f"{effect.name}.{key}": p.neutral for key, p in effect.parameters.items() if p.neutral is not None}


@cache
def actuated(name: str, effects: tuple[str, ...] = AXIS.effects) -> Model:
    """The axis with another actuator: piston, air and effects as they are, the actuator at its defaults."""
    known = {key: value for key, value in AXIS.parameters.items() if key.partition(".")[0] in (*effects, *FRAME)}
    own = {key: value for key, value in known.items() if key.partition(".")[0] not in ACTUATORS}
    return Model.build(effects, own, frame=("piston", "air", name), name=name, defaults=True)


@cache
def machine(name: str) -> Model:
    """The axis with the effect added, in place of those that set the same signal."""
    if name in ACTUATORS:
        return actuated(name)
    effect, effects = EFFECTS[name], list(AXIS.effects)
    if name in effects or name in FRAME:
        return AXIS
    for signal in sets(effect):
        effects = [other for other in effects if signal not in sets(EFFECTS[other])]
    return AXIS.with_effects([*effects, *needs(effect), name])


def needs(effect: type[Effect]) -> list[str]:
    """Effects that the axis lacks, whose parameters an effect reads: owner__key."""
    return [owner for owner in owners_read(effect) if owner in EFFECTS and owner not in (*AXIS.effects, *FRAME)]


def sets(effect: type[Effect]) -> set[str]:
    """The single signals of which an effect is the source."""
    equations = effect.functions.get("equations")
    written = [w for w in equations.writes if w not in equations.reads] if equations else []
    return {w for w in written if w in SIGNALS and SIGNALS[w].kind == "single"}


@cache
def lone_machine(name: str) -> Model:
    """The effect with as few others as it needs to have an influence: none, the bristle, or the whole axis."""
    written = {w for function in EFFECTS[name].functions.values() for w in function.writes}
    for others in ([], ["lugre_friction"])[bool(written & _READ_BY_BRISTLES) :]:
        try:
            return AXIS.with_effects(dict.fromkeys([*others, name]))
        except UsageError:
            continue
    return machine(name)


@cache
def everything() -> Model:
    """The axis with every effect: one kernel, in which any effect can be examined alone."""
    return AXIS.with_effects(
        sorted({*AXIS.effects, *(effect.name for effect in CATALOGUE)})
    )  # as a diagnosis orders them: one kernel


@cache
def in_one_kernel(name: str) -> Model:
    """The machine with the effect, as `machine` makes it, by the kernel of everything: all others are at neutral."""
    others = {key: value for effect in CATALOGUE for key, value in neutral_values(effect).items()}
    own = machine(name).parameters
    here = {
        key: value
        for key, value in own.items()
        if key.partition(".")[0] in (name, *needs(EFFECTS[name]), *AXIS.effects)
    }
    return everything().with_parameters({**others, **here})


@cache
def driven_in_one_kernel(name: str) -> Model:
    """`lone_machine` by the kernel of everything: hardly a bristle where the effect needs none, and no stop near."""
    others = {key: value for effect in CATALOGUE for key, value in neutral_values(effect).items()}
    own = {key: value for key, value in machine(name).parameters.items() if key.partition(".")[0] == name}
    written = {w for function in EFFECTS[name].functions.values() for w in function.writes}
    bristle = {} if name == "lugre_friction" or written & _READ_BY_BRISTLES else HARDLY_A_BRISTLE
    return everything().with_parameters({**others, **bristle, **LONG, **own})


_CELLS = """
def get(cells, first, i):
    return cells[first + i]

def put(cells, first, i, value):
    cells[first + i] = value

"""


@cache
def _interpreted(text: str) -> ModuleType:
    compiled = "from pneumo_ros.plant.jit import"
    assert compiled in text
    module = ModuleType("interpreted_kernel")
    plain = f"{_CELLS}entry = inline = block = lambda function: function\nfrom pneumo_ros.plant.maths import"
    names = "exponent, mantissa, power_of_two"
    head, _, tail = text.partition(compiled)
    exec(f"{head}{plain} {names}\n{tail.partition(chr(10))[2]}", vars(module))
    return module


def in_python(model: Model) -> Model:
    """The same model, whose kernel's text Python runs, uncompiled."""
    plain = Model(model.composition, model.parameters, model.name, model.library)
    vars(plain)["kernel"] = _interpreted(model.composition.text)
    return plain
