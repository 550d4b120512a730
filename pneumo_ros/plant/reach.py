"""What effects reach: the measured signals that they read as inputs, and the machine on which they act."""

import ast
from collections.abc import Collection, Iterable, Iterator, Sequence

from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.signals import DRIVE, SIGNALS, Signal

_IN_KERNEL = ("equations", "outputs", "advance")  # functions of an effect that a kernel calls


def names_in(default: str) -> list[str]:
    """The names in the default of a signal."""
    return [node.id for node in ast.walk(ast.parse(default, mode="eval")) if isinstance(node, ast.Name)]


def default_of(signal: Signal, measured: Collection[str]) -> str:
    """The default of a signal where the signals `measured` are asked for as inputs."""
    asked = signal.measured and all(name in measured for name in names_in(signal.measured) if _is_measured(name))
    return signal.measured if asked else signal.default


def _is_measured(name: str) -> bool:
    return name in SIGNALS and SIGNALS[name].kind == "measured"


def read_by(effect: type[Effect]) -> set[str]:
    """Names that any function of an effect reads."""
    return {name for function in effect.functions.values() for name in function.reads}


def written_by(effect: type[Effect]) -> set[str]:
    """Names that any function of an effect writes."""
    return {name for function in effect.functions.values() for name in function.writes}


def reads_drive(effect: type[Effect]) -> bool:
    """Whether an effect reads the drive force."""
    return any(name in ("drive", DRIVE) for reads, _ in _functions(effect) for name in reads)


def fades(effect: type[Effect]) -> bool:
    """Whether an effect adds nothing at the neutral values of its parameters: not one that drives the machine."""
    drives = any(name in ("drive", "duty") for _, writes in _functions(effect) for name in writes)
    return not drives and any(one.neutral is not None for one in effect.parameters.values())


def owners_read(effect: type[Effect]) -> tuple[str, ...]:
    """Names of the other effects whose parameters an effect reads, as owner__key, sorted."""
    return tuple(sorted({name.partition("__")[0] for name in read_by(effect) if "__" in name}))


def inputs_of(effects: Sequence[type[Effect]], measured: Collection[str] = ()) -> tuple[str, ...]:
    """The held inputs of a machine in kernel order: its drive, then the measured signals that its effects read.

    `measured`: those that are to take the place of a constant, where one is read.
    """
    states = {state for effect in effects for state in effect.states}
    states |= {name for effect in effects if issubclass(effect, Actuator) for name in effect.open_side}
    read = {name for effect in effects for reads, _ in _functions(effect) for name in reads}
    todo = list(read)
    while todo:  # each signal once
        new = {name for name in _defaults(todo.pop(), measured) if name not in read}
        read |= new
        todo += new
    return DRIVE, *(name for name in SIGNALS if _is_measured(name) and name in read - states)


def acting(effects: Sequence[type[Effect]], roots: Collection[str]) -> set[str]:
    """Names of the effects on which the named states and signals depend."""
    functions = [(effect.name, reads, writes) for effect in effects for reads, writes in _functions(effect)]
    found, seen, todo = set[str](), set[str](), list(roots)
    while todo:  # each name once
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        for owner, reads, writes in functions:
            if name in writes or f"der_{name}" in writes or f"rate_{name}" in writes:
                found.add(owner)
                todo += reads
        todo += _defaults(name)
    return found


def _functions(effect: type[Effect]) -> Iterator[tuple[Iterable[str], Iterable[str]]]:
    """Reads and writes of each function of an effect that a kernel calls."""
    own = (effect.functions[key] for key in _IN_KERNEL if key in effect.functions)
    return ((function.reads, function.writes) for function in own)


def _defaults(name: str, measured: Collection[str] = ()) -> list[str]:
    return names_in(default_of(SIGNALS[name], measured)) if name in SIGNALS else []
