"""Cylinders and valves as sold: figures, units, and where each figure comes from.

`pneumo parts` lists all of them, `pneumo parts show NAME` or `pneumo parts NAME` one with its sources.
"""

import argparse
from typing import TYPE_CHECKING

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.console import Console, columns
from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.parts.part import Part

EXAMPLES = (
    "pneumo parts                # cylinders and valves, a line each",
    "pneumo parts show smc-sy7000",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """list, show NAME or NAME, and the common options."""
    parser.add_argument("what", nargs="*", metavar="NAME", help="list (default), or the part to show")
    add_parts(parser)
    parser.add_argument("--markdown", action="store_true", help="the list as the tables of docs/parts.md")
    add_output(parser)


def add_parts(parser: argparse.ArgumentParser) -> None:
    """--parts."""
    parser.add_argument(
        "--parts", metavar="FOLDER", action="append", default=[],
        help="folder with part files of your own; may be repeated, as may folders in PNEUMO_PARTS",
    )  # fmt: skip


def run(options: argparse.Namespace, console: Console) -> int:
    """List the parts, or show one."""
    from pneumo_ros.parts.listing import markdown, record
    from pneumo_ros.parts.shelf import load_shelf

    shelf, name = load_shelf(options.parts), _name(options.what)
    if name and options.markdown:
        raise UsageError("--markdown goes with the list; leave out the name of the part")
    chosen = [shelf.find(name)] if name else list(shelf.parts.values())
    text = shown(chosen[0]) if name else markdown(chosen) if options.markdown else listing(chosen)
    console.say(text)
    console.next("new --cylinder iso15552-32-250 --valve NAME --supply 6barg --mass 10 --out my.yaml")
    console.json({"schema_version": 1, "parts": [record(part) for part in chosen]})
    return 0


def _name(what: list[str]) -> str | None:
    """The part to show; None for the list."""
    if what in ([], ["list"]):
        return None
    name = what[-1]
    if len(what) > 2 or (len(what) == 2 and what[0] != "show") or what == ["show"]:
        raise UsageError(f"'{' '.join(what)}' is no part; type: pneumo parts, or pneumo parts show NAME")
    return name


def listing(parts: "list[Part]") -> str:
    """One line for each part, by kind."""
    from pneumo_ros.parts.listing import figures_text

    text: list[str] = []
    for kind in dict.fromkeys(part.kind for part in parts):
        rows = [(f"  {part.name}", part.title, figures_text(part)) for part in parts if part.kind == kind]
        text += [f"{kind}s", columns(rows), ""]
    return "\n".join([*text, "Sources of the figures: pneumo parts show NAME. A machine of parts: pneumo new"])


def shown(part: "Part") -> str:
    """Everything about one part."""
    from pneumo_ros.parts.listing import figure_text

    rows = [(f"  {name}", figure_text(f), part.meaning(name), f.source, f.note) for name, f in part.figures.items()]
    opening = f", {part.opening}" if part.opening else ""
    return f"{part.name}: {part.title} ({part.kind}{opening})\n{columns(rows)}\nFile: {part.file}"
