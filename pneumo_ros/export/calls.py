"""Calls of the kernel's own functions, of Python's, and of the C library's, as C99."""

import ast
from collections.abc import Callable
from typing import TYPE_CHECKING

from pneumo_ros.export.signature import CONDITIONS, InexpressibleError, called, number_text

if TYPE_CHECKING:
    from pneumo_ros.export.expression import Scope

_SAME = """acosh asin acos asinh atan2 atanh cbrt ceil copysign cosh erf erfc expm1 fabs floor fmod hypot lgamma log10
log1p log2 pow sinh sqrt tan trunc"""
_LIBRARY = {name: name for name in _SAME.split()} | {
    "gamma": "tgamma", "maximum": "max", "minimum": "min", "abs": "fabs", "absolute": "fabs",
}  # fmt: skip
_BITS = ("power_of_two", "exponent", "mantissa")


def call_text(scope: "Scope", node: ast.expr) -> str:
    """The C text of a call that gives one number; raises InexpressibleError."""
    assert isinstance(node, ast.Call)
    name, plain = called(node), isinstance(node.func, ast.Name)
    signature = scope.functions.get(name) if plain else None
    if signature is not None:
        if signature.width:
            raise InexpressibleError(node, f"{name} returns several values: assign them to names first")
        return scope.call(node, signature)
    write = _BUILTINS.get(name)
    if node.keywords or not node.args or any(isinstance(a, ast.Starred) for a in node.args):
        write = None
    elif write is None and name in _LIBRARY:
        write = _BUILTINS.get(_LIBRARY[name], _library)
    if write is None:
        raise InexpressibleError(node, f"it has no {ast.unparse(node.func)} for these arguments")
    return write(scope, node)


def _library(scope: "Scope", node: ast.Call) -> str:
    return f"{_LIBRARY[called(node)]}({', '.join(map(scope.number, node.args))})"


def _one(text: str) -> Callable[["Scope", ast.Call], str]:
    """Writes a call of one argument as `text`."""

    def write(scope: "Scope", node: ast.Call) -> str:
        if len(node.args) != 1:
            raise InexpressibleError(node, f"{called(node)} takes one number here")
        return text.format(scope.number(node.args[0]))

    return write


def _bits(scope: "Scope", node: ast.Call) -> str:
    return _one(scope.helper(called(node)) + "({})")(scope, node)


def _extreme(scope: "Scope", node: ast.Call) -> str:
    name = scope.helper("max" if called(node).startswith("max") else "min")
    if len(node.args) < 2:
        raise InexpressibleError(node, "min and max take two or more numbers here")
    text = scope.number(node.args[0])
    for other in node.args[1:]:
        text = f"{name}({text}, {scope.number(other)})"
    return text


def _float(scope: "Scope", node: ast.Call) -> str:
    only = node.args[0]
    if isinstance(only, ast.Constant) and isinstance(only.value, str):
        try:
            return number_text(float(only.value))
        except ValueError as error:
            raise InexpressibleError(node, "that is no number") from error
    return _one("(double){}")(scope, node)


_BUILTINS: dict[str, Callable[["Scope", ast.Call], str]] = {
    "abs": _one("fabs({})"), "fabs": _one("fabs({})"), "float": _float, "int": _one("trunc({})"),
    "bool": _one("({} != 0.0)"), "round": _one("rint({})"), "min": _extreme, "max": _extreme,
    **{name: _one(f"({name}({{}}) != 0)") for name in CONDITIONS}, **dict.fromkeys(_BITS, _bits),
}  # fmt: skip
