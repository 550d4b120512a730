"""The available effects as data: their order, one sentence each, their equations as written, and records for JSON."""

import inspect
import math
import re
import textwrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pneumo_ros.plant.effect import Effect
    from pneumo_ros.plant.model import Model

ORDER = ("frame", "actuator", "valve", "line", "chamber", "piston", "friction", "sensor")  # of the parts of a machine


def catalogue(model: "Model") -> dict[str, "type[Effect]"]:
    """Name -> effect: the frame of every machine, then all available effects, room by room."""
    library = model.library
    found = [library.part(name) for name in ("piston", "air", *library.actuators())]
    found += [library.find(name) for name in library.names()]
    found.sort(key=lambda effect: ORDER.index(room(effect)) if room(effect) in ORDER else len(ORDER))
    return {effect.name: effect for effect in found}


def room(effect: "type[Effect]") -> str:
    """The part of the machine an effect belongs to: its folder in the catalogue, else the module it comes from."""
    parts = effect.__module__.split(".")
    return parts[3] if parts[:3] == ["pneumo_ros", "plant", "effects"] else parts[0].removeprefix("pneumo_effects_")


def summary(effect: "type[Effect]") -> str:
    """First sentence of the docstring, up to its equation if a colon announces one; at most 90 letters."""
    first = " ".join(inspect.cleandoc(effect.__doc__ or "").split("\n\n")[0].split())
    sentence = re.split(r"[:;]|\.(?= [A-Z]|$)", first)[0]  # the point in "Eqs. 1-2" ends no sentence
    return textwrap.shorten(sentence, 90, placeholder=" ...")


def body(effect: "type[Effect]", name: str) -> str:
    """The statements of an effect's function as they are written."""
    first = effect.functions[name].tree.body[0]
    source = textwrap.dedent(inspect.getsource(vars(effect)[name])).splitlines()
    return textwrap.dedent("\n".join(source[first.lineno - 1 :]))


def helpers(effect: "type[Effect]") -> dict[str, str]:
    """Source of the constants, then of the functions, that an effect's functions use from their own file, by name."""
    constants, functions = dict[str, str](), dict[str, str]()
    readers = [vars(effect)[name] for name in effect.functions]
    source = inspect.getsource(inspect.getmodule(effect) or effect)
    assigned = {line.partition(" = ")[0]: line for line in source.splitlines()}
    for reader in readers:
        for name in reader.__code__.co_names:
            value = reader.__globals__.get(name)
            if isinstance(value, int | float) and name in assigned:
                constants[name] = assigned[name]
            elif inspect.isfunction(value) and value.__module__ == effect.__module__ and name not in functions:
                functions[name] = inspect.getsource(value).rstrip()
                readers.append(value)
    return constants | functions


def record(effect: "type[Effect]", model: "Model") -> dict[str, Any]:
    """One effect for JSON; an infinite end of a range is null."""
    functions = effect.functions.values()
    return {
        "name": effect.name,
        "room": room(effect),
        "in_model": effect.name in {used.name for used in model.composition.effects},
        "description": inspect.cleandoc(effect.__doc__ or ""),
        "signature": effect.signature,
        "remedy": effect.remedy,
        "source": effect.source,
        "equations": {name: body(effect, name) for name in effect.functions},
        "helpers": helpers(effect),
        "reads": sorted({name for function in functions for name in function.reads}),
        "writes": sorted({name for function in functions for name in function.writes}),
        "states": {name: {"unit": state.unit, "meaning": state.meaning} for name, state in effect.states.items()},
        "parameters": {
            name: {
                "value": model.parameters.get(f"{effect.name}.{name}", parameter.default),
                "default": parameter.default,
                "unit": parameter.unit,
                "meaning": parameter.meaning,
                "low": None if math.isinf(parameter.low) else parameter.low,
                "high": None if math.isinf(parameter.high) else parameter.high,
            }
            for name, parameter in effect.parameters.items()
        },
    }
