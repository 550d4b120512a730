"""The C files of a functional mock-up unit: the machine, its table of variables, and one file that includes all."""

from pneumo_ros.export.c_files import c_files
from pneumo_ros.export.machine import Exported
from pneumo_ros.export.nominal import nominal
from pneumo_ros.export.signature import number_text
from pneumo_ros.export.templates import asset, filled
from pneumo_ros.export.unit_variables import INDICATORS, UnitVariable, unit_variables

MAIN = "all.c"


_UNFIT = """\
    if (p->{volume} <= 0.5 * p->piston.stroke * p->{area}) {{
        return "chamber {side} has no volume left at its end: increase {volume}";
    }}"""


def unit_sources(machine: Exported, version: int, token: str) -> dict[str, str]:
    """Names and texts of all C files; UsageError for what C cannot say."""
    m = machine.prefix
    header, source = c_files(machine, f"{m}.h")
    fixed = {name: asset(name) for name in ("unit.c", f"fmi{version}.c")}
    return {
        f"{m}.h": header,
        f"{m}.c": source,
        "variables.h": _variables(machine, token),
        **fixed,
        MAIN: filled("all.c.in", m=m, version=version),
    }


def _variables(machine: Exported, token: str) -> str:
    rows = unit_variables(machine)
    firsts = {row.block: row.reference for row in reversed(rows)}
    return filled(
        "variables.h.in", m=machine.prefix, M=machine.prefix.upper(), token=token,
        inputs=len(machine.inputs), states=len(machine.states), outputs=len(machine.outputs),
        parameters=len(machine.parameters), indicators=len(INDICATORS),
        firsts="\n".join(f"#define {block} {first}ul" for block, first in sorted(firsts.items(), key=lambda f: f[1])),
        ranges="\n".join(
            f'    {{"{v.name}", {number_text(v.low)}, {number_text(v.high)}}},' for v in machine.parameters
        ),
        nominals=", ".join(number_text(nominal(state)) for state in machine.states),
        cases="\n".join(map(_case, rows)), follow="\n".join(_follow(machine)),
        unfit="\n".join(
            _UNFIT.format(side=one.side, volume=one.volume, area=one.area) for one in machine.model.chambers
        ),
    )  # fmt: skip


def _case(row: UnitVariable) -> str:
    return f"    case {row.reference}:\n        return &m->{row.place};"


def _follow(machine: Exported) -> list[str]:
    states = {v.name: v for v in machine.states}
    lines = []
    for i, v in enumerate(machine.states):
        if v.follows:
            other = f"m->x.{states[v.follows].member}" if v.follows in states else f"m->p.{v.follows}"
            lines.append(f"    if (!given[{i}]) {{\n        m->x.{v.member} = {other};\n    }}")
    return lines
