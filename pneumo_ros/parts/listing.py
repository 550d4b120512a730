"""Parts as a table and as data: names, what they are, their figures in the units of data sheets, their sources."""

from collections.abc import Iterable
from typing import Any

from pneumo_ros.parts.figure import Figure
from pneumo_ros.parts.part import KINDS, Part
from pneumo_ros.parts.shelf import rules

SHOWN = {  # SI unit -> unit of data sheets, and its size
    "m": ("mm", 1e-3), "m3/(s Pa)": ("dm3/(s bar)", 1e-8), "m3/s": ("l/min", 1e-3 / 60.0), "s": ("ms", 1e-3),
    "Pa": ("bar", 1e5), "m/s": ("mm/s", 1e-3),
}  # fmt: skip
SHORT = {
    "conductance_filling": "C filling", "conductance_exhaust": "C exhaust", "critical_ratio_filling": "b filling",
    "critical_ratio_exhaust": "b exhaust", "nominal_flow": "qn",
}  # fmt: skip


def figure_text(figure: Figure) -> str:
    """Value, interval and unit, as data sheets write them."""
    unit, size = SHOWN.get(figure.unit, (figure.unit, 1.0))
    between = "" if figure.exact else f" ({figure.low / size:g} to {figure.high / size:g})"
    return f"{figure.value / size:.6g}{between}{'' if unit == '1' else f' {unit}'}"


def figures_text(part: Part) -> str:
    """All figures of a part in one line."""
    named = ((SHORT.get(name, name.replace("_", " ")), figure_text(one)) for name, one in part.figures.items())
    return ", ".join(f"{name} {text}" for name, text in named)


def sources_text(part: Part) -> str:
    """The sources of a part in one line."""
    return " | ".join(dict.fromkeys(figure.source for figure in part.figures.values()))


def markdown(parts: Iterable[Part]) -> str:
    """The table of parts, and that of rules, for the documentation."""
    rows = [f"| `{p.name}` | {p.title} | {figures_text(p)} | {sources_text(p).replace('|', ';')} |" for p in parts]
    ruled = [f"| `{name}` | {r.note} | {figure_text(r)} | {r.source} |" for name, r in rules().items()]
    return "\n".join(
        [
            "| part | what it is | figures | source |",
            "|---|---|---|---|",
            *rows,
            "",
            "| rule | meaning | value (interval) | where it comes from |",
            "|---|---|---|---|",
            *ruled,
        ]
    )


def record(part: Part) -> dict[str, Any]:
    """A part for JSON, in SI units."""
    figures = {
        name: {
            "value": f.value, "unit": f.unit, "low": f.low, "high": f.high, "source": f.source, "note": f.note,
            "meaning": KINDS[part.kind][name][1],
        }
        for name, f in part.figures.items()
    }  # fmt: skip
    return {
        "name": part.name, "kind": part.kind, "title": part.title, "opening": part.opening, "ways": part.ways,
        "file": part.file,
        "figures": figures,
    }  # fmt: skip
