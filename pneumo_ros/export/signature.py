"""What the translation knows of a function, and how it says that C cannot say something."""

import ast
import math
from dataclasses import dataclass

from pneumo_ros.export.identifiers import identifier

CONDITIONS = ("isnan", "isinf", "isfinite")


class InexpressibleError(Exception):
    """C cannot say `node`; `what` says why."""

    def __init__(self, node: ast.AST, what: str) -> None:
        super().__init__(what)
        self.node, self.what = node, what


@dataclass(frozen=True)
class Signature:
    """A function of the kernel: its arguments without the parameters of the machine, and how many values it returns.

    `takes_parameters`: it also takes the struct of all parameters; `width` is 0 where it returns one plain number.
    """

    name: str
    arguments: tuple[str, ...]
    defaults: tuple[ast.expr, ...]
    takes_parameters: bool
    width: int


def number_text(value: float) -> str:
    """A finite or infinite double as C text that reads back to the same bits."""
    if math.isinf(value) or math.isnan(value):
        return "NAN" if math.isnan(value) else ("INFINITY" if value > 0 else "-INFINITY")
    return repr(value)


def called(node: ast.Call) -> str:
    """The name of a called function, without math. or np. before it."""
    if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name):
        return node.func.attr if node.func.value.id in ("math", "np") else ""
    return node.func.id if isinstance(node.func, ast.Name) else ""


def head(signature: Signature, struct: str) -> str:
    """The first line of a function, without its brace."""
    arguments = [f"double {identifier(name)}" for name in signature.arguments]
    if signature.takes_parameters:
        arguments.append(f"const {struct} *restrict p")
    arguments += [f"double *out_{i}_" for i in range(signature.width)]
    return (
        f"MACHINE_FUNCTION {'void' if signature.width else 'double'} {signature.name}({', '.join(arguments) or 'void'})"
    )
