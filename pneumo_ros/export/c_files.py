"""A machine as one C99 file and its header: structs, values of the machine file, step, outputs, derivatives."""

from pneumo_ros import __version__
from pneumo_ros.export.identifiers import comment, identifier
from pneumo_ros.export.machine import EFFORT, Exported
from pneumo_ros.export.signature import number_text
from pneumo_ros.export.structs import structs
from pneumo_ros.export.templates import filled
from pneumo_ros.export.translation import functions_text
from pneumo_ros.plant.actuator import SIDES


def c_files(machine: Exported, header: str) -> tuple[str, str]:
    """Texts of the header, to be named `header`, and of the source; UsageError for what C cannot say."""
    functions, signatures = functions_text(machine)
    m = machine.prefix
    names = {"name": comment(machine.model.name), "version": __version__, "m": m, "M": m.upper(), "header": header}
    head = filled(
        "machine.h.in", structs="\n\n".join(structs(machine)), step=number_text(machine.step),
        effects=comment(", ".join(machine.model.effects) or "none"), **names,
    )  # fmt: skip
    targets = [f"&x->{v.member}" for v in machine.states]
    rates = signatures["derivatives"].width - len(machine.states)
    source = filled(
        "machine.c.in", functions=functions,
        values="\n".join(f"    p->{v.member} = {number_text(v.start)};" for v in machine.parameters),
        start="\n".join(_start(machine)),
        load="\n".join(_loads(machine)),
        store="\n".join(f"    x->{v.member} = {v.member};" for v in machine.states),
        step_call=_call(m, "step", _locals(machine), ["t", "dt", "&q"], [f"&{v.member}" for v in machine.states]),
        outputs_call=_call(m, "observation", _members(machine), ["x->t", "p"], _observed(machine)),
        effort_member=identifier(EFFORT), effort=_effort(machine),
        rates=f"    double rates[{rates}]; /* of decay, which only the step needs */" if rates else "",
        derivatives_call=_call(m, "derivatives", _members(machine), ["x->t", "p"], _slopes(machine, rates)),
        after_call=_call(m, "after_step", _members(machine), ["x->t", "p"], targets),
        **names,
    )  # fmt: skip
    return head, source


def _call(prefix: str, name: str, variables: list[str], further: list[str], targets: list[str]) -> str:
    return f"{prefix}_fn_{name}({', '.join([*variables, *further, *targets])})"


def _locals(machine: Exported) -> list[str]:
    return [v.member for v in (*machine.states, *machine.inputs)]


def _members(machine: Exported) -> list[str]:
    return [f"x->{v.member}" for v in machine.states] + [f"u->{v.member}" for v in machine.inputs]


def _observed(machine: Exported) -> list[str]:
    return [f"&o->{v.member}" for v in machine.outputs if v.name != EFFORT]


def _slopes(machine: Exported, rates: int) -> list[str]:
    return [f"&dx->{v.member}" for v in machine.states] + [f"&rates[{i}]" for i in range(rates)]


def _effort(machine: Exported) -> str:
    if machine.model.force_driven:
        return "o->drive"
    area_a, area_b, p_atm = "p->piston.area_a", "p->piston.area_b", "p->air.atmospheric_pressure"
    pressures = {chamber.side: f"x->{chamber.state}" for chamber in machine.model.chambers}
    p_a, p_b = (pressures.get(side, p_atm) for side in SIDES)
    return f"(({area_a} * {p_a}) - ({area_b} * {p_b})) - ({p_atm} * ({area_a} - {area_b}))"


def _start(machine: Exported) -> list[str]:
    """Constants and parameters first, then the states that start as another one does."""
    states = {v.name: v for v in machine.states}
    lines = []
    for v in sorted(machine.states, key=lambda v: v.follows in states):
        other = f"x->{states[v.follows].member}" if v.follows in states else f"p->{v.follows}"
        lines.append(f"    x->{v.member} = {other if v.follows else number_text(v.start)};")
    return lines


def _loads(machine: Exported) -> list[str]:
    states = [f"    double {v.member} = x->{v.member};" for v in machine.states]
    return states + [f"    const double {v.member} = u->{v.member};" for v in machine.inputs]
