"""Expressions of the kernel's Python as C99. Every number is a double; a comparison is an int and counts as 0 or 1."""

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pneumo_ros.export.calls import call_text
from pneumo_ros.export.identifiers import identifier
from pneumo_ros.export.signature import CONDITIONS, InexpressibleError, Signature, called, number_text

_OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}


@dataclass
class Scope:
    """What the names in a function mean: functions of the kernel, parameters of the machine, and flags (0 or 1)."""

    functions: Mapping[str, Signature]
    parameters: Mapping[str, str]  # name in the kernel -> C expression
    struct: str  # C type of all parameters
    flags: set[str] = field(default_factory=set)
    used: set[str] = field(default_factory=set)  # helpers of `helpers.HELPERS`

    def variable(self, name: str) -> str:
        """The C expression of a name."""
        return self.parameters.get(name) or identifier(name)

    def is_flag(self, node: ast.expr) -> bool:
        """Whether an expression is true or false, not a number."""
        if isinstance(node, ast.BoolOp):
            return all(map(self.is_flag, node.values))
        if isinstance(node, ast.UnaryOp):
            return isinstance(node.op, ast.Not)
        if isinstance(node, ast.Call):
            return called(node) in (*CONDITIONS, "bool")
        if isinstance(node, ast.Name):
            return node.id in self.flags
        return isinstance(node, ast.Compare) or (isinstance(node, ast.Constant) and isinstance(node.value, bool))

    def number(self, node: ast.expr) -> str:
        """The C text of an expression; raises InexpressibleError."""
        write = _WRITERS.get(type(node))
        if write is None:
            raise InexpressibleError(node, f"it knows no {type(node).__name__}: an export takes plain numbers only")
        return write(self, node)

    def truth(self, node: ast.expr) -> str:
        """The C text of a condition."""
        if isinstance(node, ast.BoolOp):
            return _joined(self, node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return f"(!{self.truth(node.operand)})"
        return self.number(node) if self.is_flag(node) else f"({self.number(node)} != 0.0)"

    def helper(self, name: str) -> str:
        """The C name of a small function beside those of the kernel, which will be written."""
        self.used.add(name)
        return f"kernel_{name}"

    def call(self, node: ast.Call, signature: Signature, targets: tuple[str, ...] = ()) -> str:
        """The C text of a call of a function of the kernel, whose results go to `targets`."""
        given = self._bound(node, signature)
        arguments = [self.number(given[name]) for name in signature.arguments]
        if signature.takes_parameters:
            arguments.append("p")
        return f"{signature.name}({', '.join([*arguments, *targets])})"

    def _bound(self, node: ast.Call, signature: Signature) -> dict[str, ast.expr]:
        last = signature.arguments[len(signature.arguments) - len(signature.defaults) :]
        bound: dict[str, ast.expr] = dict(zip(last, signature.defaults, strict=True))
        bound |= zip(signature.arguments, node.args, strict=False)
        bound |= {keyword.arg: keyword.value for keyword in node.keywords if keyword.arg}
        if any(name not in bound for name in signature.arguments):
            raise InexpressibleError(node, "an argument of the call is missing, or hidden behind a *")
        return bound


def _joined(scope: Scope, node: ast.BoolOp) -> str:
    return "(" + (" && " if isinstance(node.op, ast.And) else " || ").join(map(scope.truth, node.values)) + ")"


def _constant(_: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.Constant)
    if isinstance(node.value, bool):
        return str(int(node.value))
    if not isinstance(node.value, int | float):
        raise InexpressibleError(node, "it has numbers only")
    return number_text(float(node.value))


def _name(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.Name)
    return scope.variable(node.id)


def _unary(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.UnaryOp)
    if isinstance(node.op, ast.Not):
        return scope.truth(node)
    if isinstance(node.op, ast.Invert):
        raise InexpressibleError(node, "operators on bits are for whole numbers")
    return f"({'-' if isinstance(node.op, ast.USub) else '+'}{scope.number(node.operand)})"


def _binary(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.BinOp)
    left, right = scope.number(node.left), scope.number(node.right)
    if type(node.op) in _OPERATORS:
        cast = "(double)" if scope.is_flag(node.left) else ""
        return f"({cast}{left} {_OPERATORS[type(node.op)]} {right})"
    if isinstance(node.op, ast.Pow):
        whole = isinstance(node.right, ast.Constant) and isinstance(node.right.value, int)
        if whole or _is_minus_whole(node.right):
            return f"{scope.helper('power')}({left}, {int(float(ast.literal_eval(node.right)))})"
        return f"pow({left}, {right})"
    if isinstance(node.op, ast.Mod | ast.FloorDiv):
        scope.helper("modulo")
        return f"{scope.helper('modulo' if isinstance(node.op, ast.Mod) else 'quotient')}({left}, {right})"
    raise InexpressibleError(node, "operators on bits and matrices are not for doubles")


def _is_minus_whole(node: ast.expr) -> bool:
    return (
        isinstance(node, ast.UnaryOp)
        and isinstance(node.op, ast.USub)
        and isinstance(node.operand, ast.Constant)
        and isinstance(node.operand.value, int)
    )


def _compare(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.Compare)
    sides, terms = [node.left, *node.comparators], []
    for left, operator, right in zip(sides, node.ops, sides[1:], strict=False):
        if type(operator) not in _COMPARISONS:
            raise InexpressibleError(node, "`is` and `in` are not for numbers")
        terms.append(f"({scope.number(left)} {_COMPARISONS[type(operator)]} {scope.number(right)})")
    return terms[0] if len(terms) == 1 else f"({' && '.join(terms)})"


def _choice(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.IfExp)
    return f"({scope.truth(node.test)} ? {scope.number(node.body)} : {scope.number(node.orelse)})"


def _logic(scope: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.BoolOp)
    if not scope.is_flag(node):
        raise InexpressibleError(node, "`and` and `or` join conditions here; write: a if condition else b")
    return _joined(scope, node)


def _attribute(_: Scope, node: ast.expr) -> str:
    assert isinstance(node, ast.Attribute)
    value = getattr(math, node.attr, None)
    if isinstance(node.value, ast.Name) and node.value.id in ("math", "np") and isinstance(value, float):
        return number_text(value)
    raise InexpressibleError(node, f"{ast.unparse(node)} is no number that C has")


_WRITERS: dict[type[ast.expr], Callable[[Scope, ast.expr], str]] = {
    ast.Constant: _constant, ast.Name: _name, ast.UnaryOp: _unary, ast.BinOp: _binary, ast.Compare: _compare,
    ast.IfExp: _choice, ast.BoolOp: _logic, ast.Attribute: _attribute, ast.Call: call_text,
}  # fmt: skip
