"""The C structs of a machine: state, input, parameters and output, with unit and meaning beside every member."""

from collections.abc import Iterable

from pneumo_ros.export.identifiers import comment
from pneumo_ros.export.machine import Exported, Variable


def structs(machine: Exported) -> Iterable[str]:
    """The text of each struct; all members are doubles."""
    time = Variable("t", "s", "time since the start")
    yield _struct(f"{machine.prefix}_state", _rows((time, *machine.states)))
    yield _struct(f"{machine.prefix}_input", _rows(machine.inputs))
    yield _struct(f"{machine.prefix}_parameters", _sections(machine))
    yield _struct(f"{machine.prefix}_output", _rows(machine.outputs))


def _struct(name: str, rows: list[str]) -> str:
    return "\n".join(["typedef struct {", *(f"    {row}" for row in rows), f"}} {name};"])


def _rows(variables: Iterable[Variable]) -> list[str]:
    return [f"double {v.member.split('.')[-1]}; /* {comment(f'{v.unit}, {v.meaning}')} */" for v in variables]


def _sections(machine: Exported) -> list[str]:
    """One inner struct for each section of the machine file."""
    sections: dict[str, list[Variable]] = {}
    for variable in machine.parameters:
        sections.setdefault(variable.member.split(".")[0], []).append(variable)
    rows = []
    for section, variables in sections.items():
        rows += ["struct {", *(f"    {row}" for row in _rows(variables)), f"}} {section};"]
    return rows
