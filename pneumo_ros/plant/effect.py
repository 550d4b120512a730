"""The interface of a physical effect: plain classes whose equations are plain Python.

    class SealLeak(Effect):
        \"\"\"Turbulent leakage across the piston seal. Source, equation.\"\"\"
        conductance = Parameter(2e-11, "kg/(s*sqrt(Pa))", "seal leak coefficient", low=0.0)

        def equations(p_a, p_b, conductance):
            leak = conductance * (p_a - p_b) / sqrt(abs(p_a - p_b) + 1.0)
            flow_a, flow_b = -leak, leak
            return flow_a, flow_b

An effect reads the arguments of `equations` (states, signals, its own parameters, those of others) and writes the
returned names: signals of `signals.py`, `der_x` for each state x it declares, and `rate_x` [1/s] where
der_x = source - rate_x x, so that the integrator solves that part exactly. An effect whose force grows with velocity
also returns the slope as `resistance`, which keeps the step stable for any slope. An optional `advance` runs once
after each step and returns states; an optional `caution` returns a sentence when parameters are allowed but unwise.
"""

import ast
import inspect
import math
import re
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

import numpy as np

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.plant.maths import atan, cos, exp, log, pi, power, sign, sin, sqrt, tanh

__all__ = [
    "Effect", "Function", "Parameter", "State",
    "atan", "cos", "exp", "log", "pi", "power", "sign", "sin", "sqrt", "tanh",
]  # fmt: skip


LATE = ("delay", "low-pass")  # roles of times by which a signal is late
ROLES = ("", *LATE, "play", "damping")  # of a parameter, where its unit and neutral value do not say what it does


@dataclass(frozen=True)
class Parameter:
    """A physical constant of an effect: `default` value in `unit`, `meaning`, and the allowed values, `low` to `high`.

    `neutral` is the value at which the effect adds nothing, for the parameters that have one. `role` is "delay" for the
    time by which a signal is late, "low-pass" for the time constant of a low-pass of first order, "play" for the width
    of the play before a sensor, "damping" for the damping ratio of a lag, and "" otherwise; UsageError for another
    role. `usual`: the usual size, where the default is neutral; of a shape that may have either sign, as the place of
    something, the distance that matters. `shapes`: the key of the parameter of the same effect without which this one
    does nothing; an effect with such a parameter has several forms, one for each kind of its sizes, and a machine has
    one of them. `optional`: whether a machine file may leave the parameter out, as one may whose default is neutral.
    `chosen`: whoever builds or wires the machine chooses it, so that fits leave it alone. `span`: in a machine that
    turns, the width of the range that is allowed at every radius.
    """

    default: float
    unit: str
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    neutral: float | None = None
    role: str = ""
    optional: bool = False
    chosen: bool = False
    usual: float | None = None
    shapes: str = ""
    span: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "optional", self.optional or self.default == self.neutral)
        if self.role not in ROLES:
            raise UsageError(f"role {self.role!r} of a parameter is unknown; known are {', '.join(ROLES[1:])}")
        if not (self.low <= self.default <= self.high):
            raise UsageError(
                f"default {self.default!r} of a parameter lies outside its range [{self.low}, {self.high}]"
            )

    def check(self, name: str, value: object) -> float:
        """Return value as float; UsageError when it is no number, not finite, or out of range."""
        if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
            raise UsageError(f"{name} is {brief(value)}; it takes a number in {self.unit}, {self.range_text()}")
        number = min(max(value, -math.inf), math.inf) if isinstance(value, int) else float(value)
        if not self.low <= number <= self.high or math.isinf(number):
            raise UsageError(f"{name} is {brief(value)} {self.unit}; allowed is {self.range_text()}")
        return float(number)

    def range_text(self) -> str:
        """The allowed range in words."""
        if math.isinf(self.low) and math.isinf(self.high):
            return "any finite number"
        if math.isinf(self.high):
            return f"{self.low:g} or more"
        if math.isinf(self.low):
            return f"{self.high:g} or less"
        return f"{self.low:g} to {self.high:g}"


class Bounded(Protocol):
    """A parameter, or the coordinate of one."""

    @property
    def unit(self) -> str: ...
    @property
    def neutral(self) -> float | None: ...
    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...


def kind_of(size: Bounded) -> tuple[str, float | None, float, float]:
    """What sizes of one kind have in common, as those for the two directions of motion, or the points of a profile."""
    return size.unit, size.neutral, size.low, size.high


@dataclass(frozen=True)
class State:
    """A state an effect integrates: unit, meaning and value at rest. A state in m/s is a velocity (see `compose`).

    `initial` may name another state and then means its initial value: a load starts at its piston's velocity.
    """

    unit: str
    meaning: str
    initial: float | str = 0.0
    line_unit: str = ""  # where the machine turns, the unit in one that moves along a line

    @property
    def is_velocity(self) -> bool:
        """Whether it takes its step with the velocities."""
        return (self.line_unit or self.unit) == "m/s"


@dataclass(frozen=True)
class Function:
    """A function of an effect as data: the names it reads and writes, its syntax tree and its global names."""

    name: str
    reads: tuple[str, ...]
    writes: tuple[str, ...]
    tree: ast.FunctionDef = field(repr=False)
    globals: dict[str, Any] = field(repr=False)


FUNCTIONS = ("equations", "outputs", "advance", "caution")


class Effect:
    """Base of all effects; subclasses are never instantiated."""

    name: ClassVar[str] = ""
    parameters: ClassVar[dict[str, Parameter]] = {}
    states: ClassVar[dict[str, State]] = {}
    functions: ClassVar[dict[str, Function]] = {}
    invariant: ClassVar[bool] = False  # `advance` only keeps what the exact equations keep, and one step may overshoot
    signature: ClassVar[str] = ""  # how a person recognises the effect in a recording, one line
    remedy: ClassVar[str] = ""  # what to do at the machine when it is found, one line
    source: ClassVar[str] = ""
    transmission: ClassVar[bool] = False  # a candidate only for machines that a measured force drives
    part: ClassVar[bool] = False  # how a machine is built: its machine file says so, and no recording is asked for it
    entered: ClassVar[str] = ""  # what to write into a machine file, for an effect that recordings cannot show
    coordinate: ClassVar[str] = ""  # of a part that is made for one: "rotation" for one that turns
    contains: ClassVar[tuple[str, ...]] = ()  # simpler effects that it equals at some of its values

    def __init_subclass__(cls) -> None:
        cls.name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()
        cls.parameters = {key: value for key, value in vars(cls).items() if isinstance(value, Parameter)}
        cls.states = {key: value for key, value in vars(cls).items() if isinstance(value, State)}
        present = {key: vars(cls)[key] for key in FUNCTIONS if key in vars(cls)}
        cls.functions = {key: parse_function(value, f"{cls.__name__}.{key}") for key, value in present.items()}
        if not (cls.__doc__ or "").strip():
            raise UsageError(
                f"effect {cls.__name__} has no docstring; say what it is and where the equation comes from"
            )
        cls._check_states()
        wrong = [key for key, p in cls.parameters.items() if p.shapes and p.shapes not in cls.parameters]
        if wrong:
            raise UsageError(f"parameter {wrong[0]} of effect {cls.__name__} shapes none of its other parameters")

    @classmethod
    def idle(cls, values: Mapping[str, float]) -> set[str]:
        """Keys of the parameters that do nothing at these values, by key: their form of the effect is not this one.

        What shapes a neutral size; and the sizes of other forms, where one acts. Sizes of one kind are of one form, so
        that neutral points of a profile belong to it.
        """
        shaped = {key: p.shapes for key, p in cls.parameters.items() if p.shapes}
        if not shaped:
            return set()
        sizes = {key: p for key, p in cls.parameters.items() if p.neutral is not None}
        acting = {kind_of(p) for key, p in sizes.items() if values[key] != p.neutral}
        off = {key for key, p in sizes.items() if kind_of(p) not in acting}
        return {key for key, size in shaped.items() if size in off} | (off if acting else set())

    @classmethod
    def _check_states(cls) -> None:
        writes = cls.functions["equations"].writes if "equations" in cls.functions else ()
        advanced = cls.functions["advance"].writes if "advance" in cls.functions else ()
        for state in cls.states:
            if f"der_{state}" not in writes and state not in advanced:
                raise UsageError(f"effect {cls.__name__} declares state {state} but returns no der_{state}")
        for name in writes:
            if name.startswith(("der_", "rate_")) and name.partition("_")[2] not in cls.states:
                raise UsageError(f"effect {cls.__name__} returns {name} but declares no state {name.partition('_')[2]}")


def parse_function(function: Callable[..., Any], title: str) -> Function:
    """Read the arguments and the returned names of an effect's function from its source.

    Raises UsageError when the source cannot be read, when an argument is not plain, or when the function does not end
    with its only `return`, of plain names.
    """
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    except (OSError, TypeError) as error:
        raise UsageError(f"the source of {title} cannot be read; put the effect in a file") from error
    if not isinstance(tree, ast.FunctionDef):
        raise UsageError(f"{title} must be a function")
    given = tree.args
    if given.vararg or given.kwarg or given.kwonlyargs or given.defaults or given.posonlyargs:
        raise UsageError(f"{title} takes plain arguments only: no defaults, no * and no **")
    name = function.__name__
    writes = () if name == "caution" else _returned_names(tree, title)
    return Function(name, tuple(a.arg for a in given.args), writes, tree, function.__globals__)


def _returned_names(tree: ast.FunctionDef, title: str) -> tuple[str, ...]:
    last = tree.body[-1]
    returns = [node for node in ast.walk(tree) if isinstance(node, ast.Return)]
    if not isinstance(last, ast.Return) or last.value is None or returns != [last]:
        raise UsageError(
            f"{title} must end with its only return statement, of the names it writes: return flow_a, flow_b"
        )
    values = last.value.elts if isinstance(last.value, ast.Tuple) else [last.value]
    names = [value.id for value in values if isinstance(value, ast.Name)]
    if len(names) != len(values) or len(set(names)) != len(names):
        raise UsageError(f"{title} must return plain, different names: assign first, then return flow_a, flow_b")
    return tuple(names)
