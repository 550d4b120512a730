"""Compose a list of effects into the text of one kernel module.

Data flow decides the order, not registration: an effect that reads a signal runs after all that write it. One step of
length h is a Stormer-Verlet step (Hairer, Lubich, Wanner 2006, ch. I.1.4), exponential where an effect returns a rate:

    1. all states take half a step with the derivatives at the start;
    2. velocities (states in m/s) take a whole step with the forces at mid step;
    3. all other states take a whole step with the derivatives at mid step and the mean velocity.

It is of second order and time-symmetric for elastic parts (no artificial damping or growth below omega h = 2). Where
der_x = source - rate x, a state moves by the exact solution for constant source and rate; half steps and velocities
take a rational approximation (`maths.damped`) that also decays. Both are stable for any rate h.
"""

import builtins
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import maths
from pneumo_ros.plant.actuator import SIDES, Actuator, Chamber
from pneumo_ros.plant.commanded import commanded_states, commanding_parameters, jumping, memories
from pneumo_ros.plant.effect import Effect, Function, Parameter
from pneumo_ros.plant.emit import module_text
from pneumo_ros.plant.reach import inputs_of
from pneumo_ros.plant.signals import SIGNALS

_MECHANICS = ("drive", "force", "friction", "friction_level", "added_mass")
SENSED = {"y_measured": "y", **{f"p_{side}_measured": f"p_{side}" for side in SIDES}}  # reading -> state


def observed_of(chambers: Sequence[Chamber]) -> tuple[str, ...]:
    """The observed signals of a machine with these chambers."""
    valve = ("opening", *(chamber.flow for chamber in chambers)) if chambers else ()
    return (*_MECHANICS, *valve, "y_measured", *(f"{chamber.state}_measured" for chamber in chambers))


def actuator_of(effects: Iterable[type[Effect]]) -> type[Actuator] | None:
    """The actuator among some effects; None for a machine that a measured force drives."""
    return next((effect for effect in effects if issubclass(effect, Actuator)), None)


@dataclass(frozen=True)
class Composition:
    """Composed effects: states, parameters and inputs in kernel order, observed signals, and the module text.

    `inputs`: U, then the measured signals that the effects read; `measured`: signals that were asked for in place of a
    constant; `sensed` holds the states that sensors measure;
    `true_sensors`: no effect changes the readings. `commanded`: states that follow from the inputs alone, `commanding`:
    the parameters on which they depend, `memories`: states that move in jumps, `jumping`: whether one jumps within a
    step, so that only short steps see it well.
    """

    effects: tuple[type[Effect], ...]
    states: tuple[str, ...]
    parameters: tuple[str, ...]  # dotted
    inputs: tuple[str, ...]
    measured: tuple[str, ...]
    observed: tuple[str, ...]
    sensed: tuple[str, ...]
    true_sensors: bool
    text: str
    commanded: tuple[str, ...] = ()
    commanding: frozenset[str] = frozenset()
    memories: frozenset[str] = frozenset()
    jumping: bool = False

    @property
    def actuator(self) -> type[Actuator] | None:
        """What actuates the machine; None where a measured force does."""
        return actuator_of(self.effects)

    @property
    def chambers(self) -> tuple[Chamber, ...]:
        """The chambers of its actuator, in the order of their pressures among the states."""
        return self.actuator.chambers if self.actuator else ()

    def parameter(self, dotted: str) -> Parameter:
        """Specification of a parameter by its dotted name; UsageError with the nearest names."""
        section, _, key = dotted.partition(".")
        for effect in self.effects:
            if effect.name == section and key in effect.parameters:
                return effect.parameters[key]
        raise UsageError(unknown_name("parameter", dotted, self.parameters))


# names the generated module uses itself
_WORDS = """x q u h k s i j b c X _ out half middle elapsed inputs row first t0 stride parts steps values np math LANES
entry inline block cells width acting derivatives after_step observation sensing step step_lanes run run_lanes follow
rates observe sense interval lead lead_derivatives lead_after at"""
_ALIKE = (("d_", ""), ("r_", ""), ("", "_m"), ("", "_n"), ("mean_", ""), ("end_", ""))  # names made from a state's
_RESERVED = {*_WORDS.split(), *vars(maths), *vars(builtins)}


class Resolver:
    """Resolves every name in the equations of a composition."""

    def __init__(self, effects: tuple[type[Effect], ...], measured: tuple[str, ...] = ()) -> None:
        self.effects, self.measured = effects, measured
        self.states: dict[str, type[Effect]] = {}
        actuator = actuator_of(effects)
        self.open_side = actuator.open_side if actuator else {}
        self.inputs = inputs_of(effects, measured)
        self.owners: dict[str, list[str]] = {}
        self.writers: dict[str, list[tuple[type[Effect], str]]] = {}  # name -> effects, and the function of each
        for effect in effects:
            self._add(effect)
        self._check_names()

    def _add(self, effect: type[Effect]) -> None:
        for state in effect.states:
            signal = state in SIGNALS and SIGNALS[state].kind != "measured"
            if state in self.states or signal or state in _RESERVED:
                owner = self.states[state].name if state in self.states else "the kernel"
                raise UsageError(
                    f"state {state} of effect {effect.name} is already taken by {owner}; choose another name"
                )
            self.states[state] = effect
        for key in effect.parameters:
            self.owners.setdefault(key, []).append(effect.name)
        for key in ("outputs", "equations"):
            if key in effect.functions:
                self._add_writes(effect, key)

    def _add_writes(self, effect: type[Effect], key: str) -> None:
        for name in effect.functions[key].writes:
            if name not in SIGNALS and not name.startswith(("der_", "rate_")):
                raise UsageError(f"effect {effect.name} returns {name!r}. {unknown_name('signal', name, SIGNALS)}")
            if name in SIGNALS and SIGNALS[name].kind in ("input", "measured"):
                raise UsageError(f"effect {effect.name} returns {name}, which is an input and cannot be written")
            self.writers.setdefault(name, []).append((effect, key))

    def _check_names(self) -> None:
        for state, effect in self.states.items():
            self._check_begin(state, effect)
            alike = (f"{before}{state}{after}" for before, after in _ALIKE)
            for name in {*alike} & set(self.states):
                raise UsageError(
                    f"state {name} of effect {self.states[name].name} is too similar to state {state}; rename it"
                )
        for name, owners in self.owners.items():
            if name in self.states or name in SIGNALS:
                kind = "state" if name in self.states else "signal"
                raise UsageError(f"parameter {name} of effect {owners[0]} is the name of a {kind}; choose another")

    def _check_begin(self, state: str, effect: type[Effect]) -> None:
        begin = effect.states[state].initial
        numbers = [s for s, owner in self.states.items() if not isinstance(owner.states[s].initial, str)]
        if isinstance(begin, str) and begin not in numbers:
            raise UsageError(
                f"state {state} of effect {effect.name} starts at {begin!r}. {unknown_name('state', begin, numbers)}"
            )

    def parameter(self, name: str, effect: type[Effect] | None) -> str | None:
        """Kernel variable of the parameter an argument means: the effect's own, `effect__name`, or a unique one."""
        if effect is not None and name in effect.parameters:
            return f"{effect.name}__{name}"
        owner, _, key = name.partition("__")
        if key and owner in self.owners.get(key, ()):
            return name
        owners = self.owners.get(name, [])
        if len(owners) > 1:
            choices = ", ".join(f"{owner}__{name}" for owner in owners)
            raise UsageError(
                f"argument {name} of {effect.name if effect else 'a signal'} is ambiguous; write one of {choices}"
            )
        return f"{owners[0]}__{name}" if owners else None

    def check(self, function: Function, effect: type[Effect]) -> None:
        """UsageError, with the nearest known names, for an unknown argument."""
        for name in function.reads:
            known_here = name in self.states or name in SIGNALS or name in self.open_side
            if not known_here and self.parameter(name, effect) is None:
                known = [*self.states, *SIGNALS, *self.owners]
                raise UsageError(f"effect {effect.name}: {unknown_name('argument', name, known)}")


@lru_cache(maxsize=256)  # a diagnosis tries some thirty effects beside each model, again and again
def compose(effects: tuple[type[Effect], ...], measured: tuple[str, ...] = ()) -> Composition:
    """Compose effects, in the given order, into one kernel; `measured` signals take the place of constants.

    Raises UsageError when names clash, an argument is unknown, a single signal has two sources, or effects depend on
    each other in a loop.
    """
    resolver = Resolver(effects, measured)
    for effect in effects:
        for key in ("equations", "outputs", "advance"):
            if key in effect.functions:
                resolver.check(effect.functions[key], effect)
    parameters = tuple(f"{effect.name}.{key}" for effect in effects for key in effect.parameters)
    states = tuple(resolver.states)
    actuator = actuator_of(effects)
    observed = observed_of(actuator.chambers if actuator else ())
    signals = tuple(name for name, state in SENSED.items() if state in states)
    true_sensors = not any(name in resolver.writers for name in signals)
    commanded = commanded_states(effects, measured) if actuator else ()  # a measured force is no command
    text = module_text(resolver, parameters, observed, () if true_sensors else signals, commanded)
    sensed = tuple(SENSED[name] for name in signals)
    return Composition(
        effects, states, parameters, resolver.inputs, measured, observed, sensed, true_sensors, text, commanded,
        commanding_parameters(effects, commanded, measured) if commanded else frozenset(), memories(effects),
        jumping(effects, commanded),
    )  # fmt: skip
