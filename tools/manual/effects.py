"""The page of the effects: what each is, its equation as written, parameters, source, a picture of its signature."""

import inspect
from pathlib import Path

import pneumo_ros as pn
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant.catalogue import ORDER, body, catalogue, helpers, room
from pneumo_ros.plant.library import FRAME

from . import signature


def page(pictures: Path) -> str:
    """Markdown: a section for each effect, by the part of the machine; `pictures` is filled, beside the page."""
    machine = pn.load_model("axis")
    pictures.mkdir(parents=True, exist_ok=True)
    parts = [
        "# Effects\n\nEvery effect that a machine file may list: its equation is the code that is compiled. The "
        "picture shows what it leaves where the default machine lacks it: the residual of each equation over the "
        "variable that explains most of it (red: more than noise), for a usual size of the effect. Effects that it "
        "needs, such as the flow law of `path_conductances`, are in both."
    ]
    found = catalogue(machine)
    for place in ORDER:
        parts.append(f"## {place.capitalize()}")
        parts += [section(effect, machine, pictures) for effect in found.values() if room(effect) == place]
    return "\n\n".join(parts)


def section(effect: type[pn.Effect], machine: pn.Model, pictures: Path) -> str:
    """One effect."""
    lines = [f"(effect-{effect.name})=\n### {effect.name}", inspect.cleandoc(effect.__doc__ or "")]
    own = "\n\n".join([*helpers(effect).values(), *(f"# {name}\n{body(effect, name)}" for name in effect.functions)])
    if own:
        lines.append(f"```python\n{own}\n```")
    if effect.parameters:
        rows = [f"| `{key}` | {one.default:g} | {one.unit} | {one.meaning} |" for key, one in effect.parameters.items()]
        lines.append("\n".join(["| parameter | default | unit | meaning |", "|---|---|---|---|", *rows]))
    if effect.signature:
        lines.append(f"Shows as: {effect.signature}.")
    if effect.remedy:
        lines.append(f"At the machine: {effect.remedy}.")
    if effect.source:
        lines.append(f"Source: {effect.source}.")
    if effect.name not in (*FRAME, *machine.effects):
        try:
            signature.draw(effect, pictures / f"{effect.name}.png")
            lines.append(f"![Residuals of a machine without {effect.name}](signatures/{effect.name}.png)")
        except PneumoError as problem:
            lines.append(f"No picture: {problem}.")
    return "\n\n".join(lines)
