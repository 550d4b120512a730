"""The line of an effect that C cannot say, as a sentence for its author."""

import ast
import inspect
import textwrap
from collections.abc import Callable
from types import FunctionType
from typing import Any

from pneumo_ros.errors import UsageError
from pneumo_ros.export.signature import InexpressibleError
from pneumo_ros.plant import Effect


def refusal(
    effects: tuple[type[Effect], ...], function: ast.FunctionDef, problem: InexpressibleError, language: str = "C"
) -> UsageError:
    """UsageError that names effect, file and line of what could not be translated in a function of the kernel."""
    assert isinstance(problem.node, ast.stmt)
    text = ast.unparse(problem.node).splitlines()[0]
    owner, source = _origin(effects, function.name)
    place = _place(source, function, problem.node) if source is not None else f"function {function.name}"
    effect = f"effect {owner}" if owner else "the machine"
    return UsageError(
        f"{effect} cannot be exported to {language}: {place}: `{text}`: {problem.what}; rewrite that line"
    )


def _origin(effects: tuple[type[Effect], ...], name: str) -> tuple[str, Callable[..., Any] | None]:
    """The effect that a function of the kernel comes from, and the function as its author wrote it."""
    for effect in effects:
        for key in effect.functions:
            if name.rstrip("_") == f"{effect.name}__{key}":
                return effect.name, vars(effect)[key]
    for effect in effects:
        for function in effect.functions.values():
            helper = function.globals.get(name.rstrip("_"))
            if isinstance(helper, FunctionType):
                return effect.name, helper
    return "", None


def _place(source: Callable[..., Any], function: ast.FunctionDef, wanted: ast.stmt) -> str:
    """File and line of a statement: the kernel's copy has the same statements, without docstring and comments."""
    code = source.__code__
    tree = ast.parse(textwrap.dedent(inspect.getsource(source))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    if ast.get_docstring(tree) is not None:
        tree.body = tree.body[1:]
    pairs = zip(_statements(function), _statements(tree), strict=False)
    line = next((theirs.lineno for ours, theirs in pairs if ours is wanted), 1)
    return f"{code.co_filename}, line {code.co_firstlineno + line - 1}"


def _statements(tree: ast.FunctionDef) -> list[ast.stmt]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.stmt)]
