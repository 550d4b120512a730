"""The variables of a functional mock-up unit: which there are, under which names and references, and where they lie."""

from collections import Counter
from dataclasses import dataclass

from pneumo_ros.errors import UsageError
from pneumo_ros.export.machine import Exported, Variable
from pneumo_ros.export.nominal import nominal

STEP_RANGE = (1e-7, 1e-2)  # s
INDICATORS = (
    Variable("to_end_a", "m", "way to the end of the stroke with chamber a large"),
    Variable("to_end_b", "m", "way to the end of the stroke with chamber b large"),
    Variable("to_reversal", "m/s", "velocity, moved by 1e-6 m/s: its sign changes where the piston reverses"),
)


@dataclass(frozen=True)
class UnitVariable:
    """One row of a model description. `place` is its member of `machine_values`, `block` the C name of its first.

    `state` is the reference of the state that it is the derivative of.
    """

    reference: int
    block: str
    place: str
    variable: Variable
    causality: str
    variability: str = "continuous"
    initial: str = ""
    state: int | None = None

    @property
    def name(self) -> str:
        """As the model description has it: plain letters, sections with a dot."""
        name = self.variable.name
        return name if name.isascii() else self.variable.member

    @property
    def size(self) -> float | None:
        """Usual size of a state."""
        return nominal(self.variable) if self.block == "FIRST_STATE" else None


def unit_variables(machine: Exported) -> list[UnitVariable]:
    """All of them, in the order of their references; UsageError for a state with a name that an FMU needs itself."""
    rows = [UnitVariable(0, "TIME", "x.t", Variable("time", "s", "time"), "independent")]

    def add(
        block: str, place: str, variable: Variable, causality: str, variability: str = "continuous", initial: str = ""
    ) -> None:
        rows.append(UnitVariable(len(rows), block, place, variable, causality, variability, initial))

    for v in machine.inputs:
        add("FIRST_INPUT", f"u.{v.member}", v, "input")
    for v in machine.states:
        add("FIRST_STATE", f"x.{v.member}", v, "output", "continuous", "exact")
    for row in rows[-len(machine.states) :]:
        slope, place = _slope(row.variable), f"d{row.place}"
        number = row.reference + len(machine.states)
        rows.append(
            UnitVariable(number, "FIRST_DERIVATIVE", place, slope, "local", initial="calculated", state=row.reference)
        )
    for v in machine.outputs:
        add("FIRST_OUTPUT", f"o.{v.member}", v, "output", "continuous", "calculated")
    for v in machine.parameters:
        add("FIRST_PARAMETER", f"p.{v.member}", v, "parameter", "tunable", "exact")
    step = Variable("integration_step", "s", "longest integration step", machine.step, *STEP_RANGE)
    add("STEP_PARAMETER", "step", step, "parameter", "fixed", "exact")
    for i, v in enumerate(INDICATORS):
        add("FIRST_INDICATOR", f"indicators[{i}]", v, "local", "continuous", "calculated")
    _check_names(rows)
    return rows


def _check_names(rows: list[UnitVariable]) -> None:
    twice = [name for name, count in Counter(row.name for row in rows).items() if count > 1]
    if twice:
        raise UsageError(f"an FMU has a variable {twice[0]} of its own; give that state of your effect another name")


def _slope(state: Variable) -> Variable:
    return Variable(f"der({state.name})", _per_second(state.unit), f"rate of change of {state.name}")


def _per_second(unit: str) -> str:
    known = {"m": "m/s", "m/s": "m/s2", "s": "1", "1": "1/s", "kg/s": "kg/s2"}
    return known.get(unit, f"{unit}/s")
