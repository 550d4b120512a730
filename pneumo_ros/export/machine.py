"""What an exported machine consists of: its inputs, states, outputs and parameters, with units, ranges and C names."""

import ast
import math
from dataclasses import dataclass
from functools import cached_property

from pneumo_ros.export.identifiers import identifier, prefix_of
from pneumo_ros.plant import Model
from pneumo_ros.plant.model import STEP
from pneumo_ros.plant.signals import SIGNALS

EFFORT = "effort"


@dataclass(frozen=True)
class Variable:
    """A number of the machine: its name, unit and meaning, value at the start, closed range, and C member name.

    `follows` names what gives the value at the start where that is no constant: a state, or a parameter.
    """

    name: str
    unit: str
    meaning: str
    start: float = 0.0
    low: float = -math.inf
    high: float = math.inf
    follows: str = ""

    @property
    def member(self) -> str:
        """The member of its C struct; `section.key` for parameters."""
        return ".".join(map(identifier, self.name.split(".")))


@dataclass(frozen=True)
class Exported:
    """A model, and how it looks from outside the package."""

    model: Model

    @property
    def prefix(self) -> str:
        """What every public C name begins with."""
        return prefix_of(self.model.name)

    @property
    def step(self) -> float:
        """The usual integration step [s]."""
        return STEP

    @cached_property
    def functions(self) -> dict[str, ast.FunctionDef]:
        """The functions of the kernel's module by name, in an order in which each is defined before it is called."""
        body = ast.parse(self.model.composition.text).body
        return {node.name: node for node in body if isinstance(node, ast.FunctionDef)}

    @cached_property
    def inputs(self) -> tuple[Variable, ...]:
        """What is held from outside during a step, in the order of the kernel's arguments."""
        arguments = [a.arg for a in self.functions["step"].args.args]
        names = arguments[len(self.model.states) : arguments.index("t")]
        return tuple(self._input(name) for name in names)

    def _input(self, name: str) -> Variable:
        if name == "U" and self.model.force_driven:
            return Variable(name, "N", "driving force on the piston")
        return Variable(name, SIGNALS[name].unit, SIGNALS[name].meaning)

    @cached_property
    def states(self) -> tuple[Variable, ...]:
        """What is integrated, in the order of the kernel; at the start at rest, the pressures atmospheric."""
        found = {name: state for effect in self.model.composition.effects for name, state in effect.states.items()}
        rest = dict(zip(self.model.states, self.model.state().tolist(), strict=True))
        follows = {n: s.initial for n, s in found.items() if isinstance(s.initial, str)}
        follows |= dict.fromkeys((chamber.state for chamber in self.model.chambers), "air.atmospheric_pressure")
        return tuple(Variable(n, s.unit, s.meaning, rest[n], follows=follows.get(n, "")) for n, s in found.items())

    @cached_property
    def outputs(self) -> tuple[Variable, ...]:
        """What is computed from the states and inputs: readings of the sensors, forces and flows."""
        effort = Variable(EFFORT, "N", "net force on the piston: of the chambers against the atmosphere, or the input")
        observed = (Variable(n, SIGNALS[n].unit, SIGNALS[n].meaning) for n in self.model.composition.observed)
        return (effort, *observed)

    @cached_property
    def parameters(self) -> tuple[Variable, ...]:
        """The machine file: every parameter by its dotted name, with value and range."""
        found = ((dotted, value, self.model.specification(dotted)) for dotted, value in self.model.parameters.items())
        return tuple(Variable(d, s.unit, s.meaning, value, s.low, s.high) for d, value, s in found)
