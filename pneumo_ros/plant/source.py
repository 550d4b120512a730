"""Copy the functions of effects, and all they call, into the text of one self-contained module.

Numba's cache does not see edits in another file; therefore everything a kernel runs is copied into its text, whose hash
names the kernel.
"""

import ast
import builtins
import inspect
import math
import textwrap
import types
from collections.abc import Callable
from functools import lru_cache
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import maths
from pneumo_ros.plant.effect import Function

_BUILTINS = ("abs", "min", "max", "float", "int", "bool", "range", "len", "round", "True", "False", "None")
_REPLACED = ("power_of_two", "exponent", "mantissa")  # bit operations, imported from `jit`
_MODULES = {math: "math", np: "np"}
_Helpers = list[tuple[Callable[..., Any], str]]  # functions that a function calls, and their names in its text
_written = WeakKeyDictionary[ast.FunctionDef, tuple[str, _Helpers]]()  # texts, as rewriting takes most of the time


class SourceBook:
    """Collects functions in the order in which they must be defined, each under a unique name."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self._names: dict[str, str] = {}  # definition text -> name
        self._taken: set[str] = set(_REPLACED)
        self._written: dict[object, str] = {}  # function or its tree -> name
        self._open: list[Callable[..., Any]] = []  # helpers being written

    def add(self, function: Function, name: str, title: str) -> str:
        """Add an effect's function under `name`; `title` is its name in error messages."""
        if function.tree not in self._written:
            self._written[function.tree] = self._define(function.tree, function.globals, name, title)
        return self._written[function.tree]

    def _define(self, tree: ast.FunctionDef, scope: dict[str, Any], name: str, title: str) -> str:
        text = self._text(tree, scope, title)
        if text not in self._names:
            while name in self._taken:
                name += "_"
            self._taken.add(name)
            self._names[text] = name
            self.texts.append(f"@inline\ndef {name}{text.removeprefix(f'def {tree.name}')}")
        return self._names[text]

    def _text(self, tree: ast.FunctionDef, scope: dict[str, Any], title: str) -> str:
        """The text of a function under its own name, after the functions that it calls."""
        text, helpers = _written.get(tree, ("", []))
        if not text or any(self.helper(function, title) != name for function, name in helpers):
            rewriter = _Rewriter(self, tree, scope, title)
            text = ast.unparse(ast.fix_missing_locations(rewriter.rewrite()))
            _written[tree] = text, rewriter.helpers
        return text

    def helper(self, function: Callable[..., Any], title: str) -> str:
        """Add a plain Python function that an effect calls."""
        if function in self._open:
            raise UsageError(f"{title} calls {function.__name__}, which calls itself; write a loop of fixed length")
        if function not in self._written:
            tree = _tree(function)
            if not isinstance(tree, ast.FunctionDef):
                raise UsageError(f"{title} calls {function.__name__}, which is no plain function")
            self._open.append(function)
            name = self._define(tree, function.__globals__, function.__name__, f"{title}, {function.__name__}")
            self._written[function] = name
            self._open.pop()
        return self._written[function]


@lru_cache(1024)
def _tree(function: Callable[..., Any]) -> ast.stmt:
    return ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]


class _Rewriter(ast.NodeTransformer):
    """Replaces free names of one function: constants by their value, functions by their name in the module."""

    def __init__(self, book: SourceBook, tree: ast.FunctionDef, scope: dict[str, Any], title: str) -> None:
        self.book, self.scope, self.title = book, scope, title
        self.tree = ast.parse(ast.unparse(tree)).body[0]
        stored = {n.id for n in ast.walk(self.tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        self.local = stored | {a.arg for a in tree.args.args}
        self.helpers: _Helpers = []

    def rewrite(self) -> ast.FunctionDef:
        tree = self.tree
        assert isinstance(tree, ast.FunctionDef)
        tree.decorator_list, tree.returns = [], None
        for argument in tree.args.args:
            argument.annotation = None
        if ast.get_docstring(tree) is not None:
            tree.body = tree.body[1:]
        tree.body = [self.visit(node) for node in tree.body]
        return tree

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        if node.value is None:
            return ast.Pass()
        plain = ast.copy_location(ast.Assign(targets=[node.target], value=node.value), node)
        assignment: ast.AST = self.visit(plain)
        return assignment

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        module = self.scope.get(node.value.id) if isinstance(node.value, ast.Name) else None
        ours = getattr(maths, node.attr, None) if module in (math, np) else None
        if isinstance(ours, types.FunctionType) and self.scope is not vars(maths):  # math.exp and np.exp mean our exp
            return self._called(ours, node.ctx)
        return self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        name = node.id
        if name in self.local or name in _BUILTINS:
            return node
        value = self.scope.get(name, getattr(maths, name, None))
        if isinstance(value, bool | int | float):
            return ast.Constant(value)
        if isinstance(value, types.ModuleType) and value in _MODULES:
            return ast.Name(_MODULES[value], node.ctx)
        if isinstance(value, types.BuiltinFunctionType) and value.__module__ == math.__name__:
            value = getattr(maths, value.__name__, value)  # `from math import exp` means our exp
            if isinstance(value, types.BuiltinFunctionType):
                return ast.Name(f"math.{value.__name__}", node.ctx)
        if isinstance(value, types.FunctionType):
            if value.__module__ == maths.__name__ and name in _REPLACED:
                return node
            return self._called(value, node.ctx)
        known = [*self.local, *(n for n in vars(maths) if not n.startswith("_"))]
        hint = " This builtin does not compile." if hasattr(builtins, name) else ""
        raise UsageError(f"{self.title}: {unknown_name('name', name, known)}{hint}")

    def _called(self, function: Callable[..., Any], context: ast.expr_context) -> ast.Name:
        self.helpers.append((function, self.book.helper(function, self.title)))
        return ast.Name(self.helpers[-1][1], context)
