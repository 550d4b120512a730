"""The table of effects a machine may hide, and machines drawn from it.

Names are those of the catalogue of physical effects. After a colon: another shape from the literature for the same
effect. OUTSIDE has the effects of no catalogue.
"""

import difflib
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .case import Case
from .effect import Effect, Rng
from .hidden_flow import GAS, SENSORS, VALVE
from .hidden_friction import FRICTION, LOADS
from .machine import Machine, worn
from .outside import OUTSIDE

EFFECTS: dict[str, Effect] = {**FRICTION, **LOADS, **VALVE, **GAS, **SENSORS, **OUTSIDE}


class Wish(NamedTuple):
    """A requested effect: a name of EFFECTS, and a size, or None for a random one."""

    name: str
    size: float | None = None


def find(name: str) -> Effect:
    """The effect of that name; KeyError with the nearest names if there is none."""
    if name not in EFFECTS:
        near = difflib.get_close_matches(name, EFFECTS, 3, 0.4)
        raise KeyError(f"no effect is called {name!r}; nearest: {', '.join(near) or ', '.join(EFFECTS)}")
    return EFFECTS[name]


def parse(text: str) -> Wish:
    """NAME or NAME=SIZE, as on a command line; KeyError for an unknown name, ValueError for a bad size."""
    name, equals, size = text.partition("=")
    effect = find(name)
    if not equals:
        return Wish(name)
    try:
        value = float(size)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{size!r} is no size of {name}: give a number in {effect.unit}, as in {name}={effect.high:g}")
    return Wish(name, value)


def build(seed: int, wishes: Sequence[Wish] = (), wear: float = 0.05, rough: bool = False, scale: float = 1.0) -> Case:
    """A worn machine that hides the requested effects; other sizes are drawn, at `scale` of full strength."""
    machine = worn(Machine(), np.random.default_rng([seed, 0]), wear)
    rng, hidden = np.random.default_rng([seed, 1]), []
    for name, size in wishes:
        effect, before = find(name), machine
        size = effect.draw(rng, scale) if size is None else size
        machine = effect.apply(machine, size, rng)
        hidden.append(_truth(name, effect, size, before, machine))
    _refuse_overlap(hidden)
    return Case(machine, rough, seed, _describe(machine, seed, rough, hidden))


def draw(
    seed: int,
    count: int = 1,
    scale: tuple[float, float] = (1.0, 1.0),
    outside: bool = False,
    wear: float = 0.05,
    rough: bool = False,
) -> Case:
    """A machine with `count` different catalogue effects drawn by the seed, or with one of OUTSIDE.

    `scale` are the least and the highest share of an effect's full strength; 0.2 makes small ones. Effects that show
    only at the ends of the stroke are drawn too: `runs_for` says which runs a case needs.
    """
    rng = np.random.default_rng([seed, 3])
    names = list(OUTSIDE) if outside else _catalogue_names(rng)
    picked = [str(name) for name in rng.choice(names, 1 if outside else count, replace=False)]
    strength = float(rng.uniform(*scale))
    return build(seed, [Wish(name) for name in picked], wear, rough, strength)


def _catalogue_names(rng: Rng) -> list[str]:
    """Each catalogue name once, in one of its shapes; of two that use the coupling to the load only one."""
    families: dict[str, list[str]] = {}
    for name in EFFECTS:
        if name not in OUTSIDE:
            families.setdefault(name.split(":")[0], []).append(name)
    names = [str(rng.choice(shapes)) for shapes in families.values()]
    if "backlash:load" in names:
        names.remove("load_compliance")
    return names


def _refuse_overlap(hidden: Sequence[dict[str, Any]]) -> None:
    """Raise ValueError if two effects set one field; viscous parts and dead volumes add up."""
    seen: dict[str, str] = {}
    for effect in hidden:
        for key in sorted(set(effect["fields"]) - {"viscous_out", "viscous_in", "volume_a", "volume_b"}):
            if key in seen:
                raise ValueError(f"{seen[key]} and {effect['shape']} both set {key}: give one of them")
            seen[key] = effect["shape"]


def _truth(name: str, effect: Effect, size: float, before: Machine, after: Machine) -> dict[str, Any]:
    changed = {key: value for key, value in after._asdict().items() if value != getattr(before, key)}
    return {
        "effect": name.split(":")[0],
        "shape": name,
        "size": size,
        "unit": effect.unit,
        "same_shape": effect.same_shape,
        "in_catalogue": name not in OUTSIDE,
        "equations": list(effect.equations),
        "fields": changed,
    }


def _describe(machine: Machine, seed: int, rough: bool, hidden: list[dict[str, Any]]) -> dict[str, Any]:
    return {"seed": seed, "effects": hidden, "rough": rough, "machine": machine._asdict()}
