"""The functions of a kernel's module as static C functions."""

import ast

from pneumo_ros.export.expression import Scope
from pneumo_ros.export.helpers import helpers_text
from pneumo_ros.export.machine import Exported
from pneumo_ros.export.refusal import refusal
from pneumo_ros.export.signature import InexpressibleError, Signature
from pneumo_ros.export.statements import function_text

ROOTS = ("step", "derivatives", "observation", "after_step")  # what the public functions call


def functions_text(machine: Exported) -> tuple[str, dict[str, Signature]]:
    """C text of all that `ROOTS` need, and the signatures by name in the kernel.

    Raises UsageError, with effect, file and line, for what C cannot say.
    """
    needed = _reachable(machine.functions)
    signatures: dict[str, Signature] = {}
    used: set[str] = set()
    texts = []
    for name, tree in machine.functions.items():
        if name in needed:
            signatures[name] = _signature(machine, tree, signatures)
            texts.append(_translated(machine, tree, signatures, used))
    return "\n\n".join([helpers_text(used), *texts]), signatures


def _reachable(functions: dict[str, ast.FunctionDef]) -> set[str]:
    found: set[str] = set()
    open_ = list(ROOTS)
    for name in open_:  # grows while it is read; every function enters once
        if name not in found:
            found.add(name)
            calls = (n.func for n in ast.walk(functions[name]) if isinstance(n, ast.Call))
            called = {function.id for function in calls if isinstance(function, ast.Name)}
            open_ += [other for other in functions if other in called and other not in found]
    return found


def _names(machine: Exported) -> list[str]:
    """The parameters as the kernel calls them."""
    return [variable.name.replace(".", "__") for variable in machine.parameters]


def _signature(machine: Exported, tree: ast.FunctionDef, known: dict[str, Signature]) -> Signature:
    """A function whose last arguments are all parameters of the machine takes the struct of them instead."""
    arguments, names = [a.arg for a in tree.args.args], _names(machine)
    takes = bool(names) and arguments[-len(names) :] == names
    plain = arguments[: -len(names)] if takes else arguments
    widths = {_width(n.value, known) for n in ast.walk(tree) if isinstance(n, ast.Return)}
    return Signature(f"{machine.prefix}_fn_{tree.name}", tuple(plain), tuple(tree.args.defaults), takes, max(widths))


def _width(value: ast.expr | None, known: dict[str, Signature]) -> int:
    if isinstance(value, ast.Tuple):
        return len(value.elts)
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in known:
        return known[value.func.id].width
    return 0


def _translated(machine: Exported, tree: ast.FunctionDef, signatures: dict[str, Signature], used: set[str]) -> str:
    members = {n: f"p->{v.member}" for n, v in zip(_names(machine), machine.parameters, strict=True)}
    takes = signatures[tree.name].takes_parameters
    scope = Scope(signatures, members if takes else {}, f"{machine.prefix}_parameters", used=used)
    try:
        return function_text(tree, signatures[tree.name], scope)
    except InexpressibleError as problem:
        raise refusal(machine.model.composition.effects, tree, problem) from problem
