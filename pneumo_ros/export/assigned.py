"""Which names a function assigns, and which of them only ever hold a condition."""

import ast
from collections import Counter

from pneumo_ros.export.expression import Scope


def conditions(tree: ast.FunctionDef, arguments: set[str], scope: Scope) -> set[str]:
    """The names, none of `arguments`, that get nothing but conditions in a function."""
    stored = (n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store))
    times, values = Counter(stored), dict[str, list[ast.expr]]()
    for node in ast.walk(tree):
        for name, value in pairs(node):
            values.setdefault(name, []).append(value)
    seen = {name: given for name, given in values.items() if name not in arguments and len(given) == times[name]}
    return {name for name, given in seen.items() if all(map(scope.is_flag, given))}


def pairs(node: ast.AST) -> list[tuple[str, ast.expr]]:
    """The names that an assignment sets, each with the expression it gets, where that can be seen."""
    if not isinstance(node, ast.Assign) or len(node.targets) != 1:
        return []
    target, value = node.targets[0], node.value
    if isinstance(target, ast.Name):
        return [(target.id, value)]
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
        return [(t.id, v) for t, v in zip(target.elts, value.elts, strict=True) if isinstance(t, ast.Name)]
    return []
