"""Sentences on what a machine file lacks and what to add: effects that others need, and parameters."""

from collections.abc import Iterator, Sequence
from functools import lru_cache

from pneumo_ros.files import yaml_number
from pneumo_ros.plant.compose import Composition, actuator_of, observed_of
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.library import FRAME, USUAL_ACTUATOR, USUAL_FRAME, Library, is_part
from pneumo_ros.plant.reach import acting, names_in, written_by
from pneumo_ros.plant.signals import SIGNALS


def lacking(effects: Sequence[type[Effect]], library: Library) -> str | None:
    """A sentence for the first effect that reads a state or parameter of an effect which is not among `effects`.

    It names what is missing and what to add. None unless exactly one effect of `library` has it.
    """
    here = {effect.name for effect in effects}
    known = {name for effect in effects for name in (*effect.states, *effect.parameters, *written_by(effect))}
    actuator = actuator_of(effects)
    known |= set(actuator.open_side) if actuator else set()
    for effect in effects:
        for name in _read(effect, known):
            owner, _, key = name.rpartition("__")
            owners = [owner] if owner else [one.name for one in _all(library) if key in (*one.states, *one.parameters)]
            if len(owners) == 1 and owners[0] not in here and owners[0] in (*FRAME, *library.names()):
                return _sentence(effect.name, f"it reads {key}", _find(library, owners[0]))
    return None


@lru_cache(maxsize=256)
def without_chambers(effects: tuple[type[Effect], ...], library: Library) -> str | None:
    """A sentence for the first effect that acts on chambers alone, which are not among `effects`; else None."""
    if actuator_of(effects):
        return None
    chambers = library.actuator(USUAL_ACTUATOR)
    own = [state for effect in effects if is_part(effect) for state in effect.states]
    acts, observed = acting(effects, (*own, *observed_of(()))), observed_of(chambers.chambers)
    for effect in effects:
        if any(SIGNALS[name].kind in ("input", "measured") for name in written_by(effect) & SIGNALS.keys()):
            return None  # which `compose` refuses
        if effect.name not in acts and effect.name in acting((*effects, chambers), (*own, *chambers.states, *observed)):
            names = [name for function in effect.functions.values() for name in function.reads]
            key = next((name for name in names if name in (*chambers.states, *chambers.parameters)), "")
            return _sentence(effect.name, f"it reads {key}" if key else "it acts on them alone", chambers)
    return None


def missing_parameters(composition: Composition, absent: Sequence[str]) -> str:
    """Sentence for parameters that a machine file lacks, with the lines to add, by section, at their defaults."""
    lines, section = list[str](), ""
    for dotted in absent:
        owner, _, key = dotted.partition(".")
        one = composition.parameter(dotted)
        if owner != section:
            section = owner
            lines.append(f"    {owner}:")
        lines.append(f"      {key}: {yaml_number(one.default)}  # [{one.unit}] {one.meaning}, {one.range_text()}")
    named = f"parameter {absent[0]} is" if len(absent) == 1 else f"{len(absent)} parameters are"
    return "\n".join([f"{named} missing; add to the sections (values shown are defaults):", *lines])


def _sentence(reader: str, why: str, needed: type[Effect]) -> str:
    name = needed.name
    section = f"section '{name}' with {', '.join(needed.parameters)}"
    if name in FRAME:
        without = " (a machine without chambers is driven by a measured force)" if name == "chambers" else ""
        return f"effect {reader} needs section '{name}' ({why}); add {section}{without}"
    also = f", and {section}" if needed.parameters else ""
    return f"effect {reader} needs effect {name} ({why}); add {name} to 'effects'{also}, or leave {reader} out"


def _read(effect: type[Effect], known: set[str]) -> Iterator[str]:
    """Names that an effect reads and no listed effect has; for signals that none sets, names in their defaults."""
    for function in effect.functions.values():
        for name in function.reads:
            if name in SIGNALS and name not in known:
                names = [] if SIGNALS[name].without else names_in(SIGNALS[name].default)
                yield from (one for one in names if one not in known and one not in SIGNALS)
            elif name not in known:
                yield name


def _all(library: Library) -> Iterator[type[Effect]]:
    yield from (_find(library, name) for name in (*USUAL_FRAME, *library.names()))


def _find(library: Library, name: str) -> type[Effect]:
    return library.part(name) if name in FRAME else library.find(name)
