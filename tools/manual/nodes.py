"""The page of the nodes' parameters, from the tables that the nodes declare them from, and that of the topics."""

from collections.abc import Iterable
from typing import Any

from pneumo_ros.axis.commission.settings import SETTINGS as COMMISSION
from pneumo_ros.axis.controller.settings import SETTINGS as CONTROLLER
from pneumo_ros.axis.experiment.settings import SETTINGS as EXPERIMENT
from pneumo_ros.axis.identification.settings import SETTINGS as IDENTIFICATION
from pneumo_ros.axis.simulator.settings import FIXED, LIVE
from pneumo_ros.records.contract import GLOBAL_TYPES, TYPES

NODES = {
    "simulator": ("the plant in the role of a rig", (*FIXED, *LIVE)),
    "controller": ("a control law that moves the piston", CONTROLLER),
    "experiment": ("recorded trials inside the stroke", EXPERIMENT),
    "commission": ("a new axis from its data sheet to a machine file", COMMISSION),
    "identification": ("parameters from recordings that arrive", IDENTIFICATION),
}


def page() -> str:
    """Markdown: the topics, and a table of parameters for each node."""
    rows = [f"| `{name}` | `{kind}` |" for name, kind in {**TYPES, **GLOBAL_TYPES}.items()]
    first = (
        "# Topics and parameters of the nodes\n\nServices, and how nodes begin and end: [nodes](../nodes.md). Names "
        "are relative to the namespace of the axis.\n\n| topic | type |\n|---|---|\n"
        + "\n".join(rows)
        + "\n\nA parameter "
        "that is *live* can be set while the node runs. The simulator has, besides, the parameters of its machine file."
    )
    return "\n\n".join([first, *(section(name, role, settings) for name, (role, settings) in NODES.items())])


def section(name: str, role: str, settings: Iterable[Any]) -> str:
    """One node."""
    rows = [
        f"| `{one.name}` | {value(one.default)} | {'yes' if one.live else ''} | {one.described} |" for one in settings
    ]
    table = "\n".join(["| parameter | default | live | meaning |", "|---|---|---|---|", *rows])
    return f"## {name}\n\n{role.capitalize()}.\n\n{table}"


def value(default: object) -> str:
    """A default as it is typed; empty text and empty lists as a dash."""
    return f"`{default}`" if default not in ("", [], ()) else "-"
