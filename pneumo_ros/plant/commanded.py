"""Which states follow from the inputs alone: spools, valve bodies, delayed commands, the loop of a regulator.

Such a state has nothing of the motion in it: run from the start of a recording under the recorded inputs, it is known
at every instant without any measurement. What a state depends on is read from the effects' own source.
"""

import ast
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache

from pneumo_ros.plant.effect import Effect, Function
from pneumo_ros.plant.library import is_part
from pneumo_ros.plant.reach import default_of, names_in
from pneumo_ros.plant.signals import SIGNALS


def commanded_states(effects: Sequence[type[Effect]], measured: Collection[str] = ()) -> tuple[str, ...]:
    """The states, in order, that depend on inputs, parameters and each other alone; `measured` as in `inputs_of`."""
    owners = {state: effect for effect in effects for state in effect.states}
    needs = _needs(effects, measured)
    known = {s for s, effect in owners.items() if not is_part(effect) and not effect.states[s].is_velocity}
    for _ in owners:  # each round but the last takes at least one away
        kept = {s for s in known if not (_closure(needs, s) & owners.keys()) - known}
        if kept == known:
            break
        known = kept
    return tuple(s for s in owners if s in known)


def commanding_parameters(
    effects: Sequence[type[Effect]], commanded: Collection[str], measured: Collection[str] = ()
) -> frozenset[str]:
    """Dotted names of the parameters on which the `commanded` states depend."""
    needs = _needs(effects, measured)
    names = {name for state in commanded for name in _closure(needs, state)}
    dotted = (f"{effect.name}.{key}" for effect in effects for key in effect.parameters)
    return frozenset(name for name in dotted if {name, name.partition(".")[2]} & names)


def readings_from(effect: type[Effect], readings: Collection[str]) -> frozenset[str]:
    """Names of signals, states and parameters from which an effect computes `readings`, its own states followed up."""
    found, todo = set[str](), list(readings)
    while todo:  # each name once
        name = todo.pop()
        for function in effect.functions.values():
            for written in {name, f"der_{name}", f"rate_{name}"} & set(function.writes):
                new = sources(function, written) - found
                found |= new
                todo += new & effect.states.keys()
    return frozenset(found)


def memories(effects: Sequence[type[Effect]]) -> frozenset[str]:
    """The states that an effect sets once per step: levels and clocks, which move in jumps."""
    return frozenset(name for effect in effects if (f := effect.functions.get("advance")) for name in f.writes)


def jumping(effects: Sequence[type[Effect]], commanded: Collection[str]) -> bool:
    """Whether a commanded state moves within a step, beside its derivative, as valves that open and close do."""
    for effect in effects:
        if "advance" in effect.functions and "equations" in effect.functions:
            moved = {f"der_{name}" for name in effect.functions["advance"].writes if name in commanded}
            if moved & set(effect.functions["equations"].writes):
                return True
    return False


def _needs(effects: Sequence[type[Effect]], measured: Collection[str]) -> Mapping[str, frozenset[str]]:
    """Name of a state or signal -> names of states, signals and parameters from which it is computed directly."""
    found: dict[str, set[str]] = {name: set(names_in(default_of(signal, measured))) for name, signal in SIGNALS.items()}
    for effect in effects:
        for key in effect.functions:
            if key == "caution":
                continue
            function = effect.functions[key]
            for name in function.writes:
                state = name.partition("_")[2] if name.startswith(("der_", "rate_")) else name
                own = (_own(effect, read) for read in sources(function, name))
                found.setdefault(state, set()).update(own)
    return {name: frozenset(names) for name, names in found.items()}


def _own(effect: type[Effect], name: str) -> str:
    """The name, or the dotted one of a parameter."""
    if name in effect.parameters:
        return f"{effect.name}.{name}"
    owner, _, key = name.partition("__")
    return f"{owner}.{key}" if key else name


def _closure(needs: Mapping[str, frozenset[str]], name: str) -> set[str]:
    found, todo = set[str](), list(needs.get(name, ()))
    while todo:  # each name once
        one = todo.pop()
        if one not in found:
            found.add(one)
            todo += needs.get(one, ())
    return found


def sources(function: Function, name: str) -> frozenset[str]:
    """The arguments of an effect's function from which it computes the returned `name`."""
    return frozenset({name, *_closure(_computed(function.tree), name)} & set(function.reads))


@lru_cache(256)
def _computed(tree: ast.FunctionDef) -> Mapping[str, frozenset[str]]:
    """Name assigned in a function -> names from which it is computed directly."""
    needs: dict[str, set[str]] = {}
    for target, used in _assignments(tree.body, frozenset()):
        needs.setdefault(target, set()).update(used)
    return {target: frozenset(used) for target, used in needs.items()}


def _assignments(body: Sequence[ast.stmt], conditions: frozenset[str]) -> Iterator[tuple[str, frozenset[str]]]:
    """Assigned names and what they are computed from, with the conditions under which that happens."""
    for statement in body:
        inner = [getattr(statement, key, []) for key in ("body", "orelse")]
        if any(inner):
            above = [getattr(statement, key) for key in ("test", "iter", "target") if hasattr(statement, key)]
            deeper = conditions | frozenset(name for node in above for name in _names(node))
            yield from ((name, deeper) for node in above for name in _names(node, ast.Store))
            for part in inner:
                yield from _assignments(part, deeper)
        else:
            yield from _pairs(statement, conditions)


def _pairs(statement: ast.stmt, conditions: frozenset[str]) -> Iterator[tuple[str, frozenset[str]]]:
    value = getattr(statement, "value", None)
    targets = getattr(statement, "targets", None) or [getattr(statement, "target", None)]
    for target in targets:
        for one, of in _matched(target, value):
            used = conditions | frozenset(_names(of) if of is not None else ())
            yield from ((name, used) for name in (_names(one, ast.Store) if one is not None else ()))


def _matched(target: ast.expr | None, value: ast.expr | None) -> list[tuple[ast.expr | None, ast.expr | None]]:
    """Targets and values one by one: a, b = c, d computes b from d alone."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
        return list(zip(target.elts, value.elts, strict=True))
    return [(target, value)]


def _names(node: ast.AST, context: type[ast.expr_context] | None = None) -> list[str]:
    every = (n for n in ast.walk(node) if isinstance(n, ast.Name))
    return [n.id for n in every if context is None or isinstance(n.ctx, context)]
