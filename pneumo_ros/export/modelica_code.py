"""Functions of the kernel's Python as Modelica functions: assignments of Reals and Booleans in an algorithm."""

import ast
from collections import Counter
from collections.abc import Iterable, Mapping

from pneumo_ros.export.assigned import conditions
from pneumo_ros.export.expression import Scope
from pneumo_ros.export.signature import InexpressibleError, called

_WORDS = """algorithm and annotation assert block break class connect connector constant constrainedby der discrete each
else elseif elsewhen encapsulated end enumeration equation expandable extends external false final flow for function if
import impure in initial inner input loop model not operator or outer output package parameter partial protected public
pure record redeclare replaceable return stream then true type when while within time Real Integer Boolean String abs
sign sqrt div mod rem ceil floor integer sin cos tan asin acos atan atan2 sinh cosh tanh exp log log10 min max sum
product"""
_TAKEN = {*_WORDS.split()}
_OF_ONE = "abs sqrt sin cos tan asin acos atan sinh cosh tanh exp log log10 floor ceil"
BUILT_IN = {name: name for name in _OF_ONE.split()} | {"fabs": "abs"}
_COMPARED = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "<>"}
_OPERATED = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "^"}
_FALLS = "(if {1} < 0.0 then -abs({0}) else abs({0}))"
_WRITTEN = {  # name -> text of its arguments
    "copysign": _FALLS, "expm1": "(exp({0}) - 1.0)", "log1p": "log(1.0 + {0})", "pow": "({0} ^ {1})",
    "hypot": "sqrt({0} * {0} + {1} * {1})", "atan2": "atan2({0}, {1})", "float": "{0}",
}  # fmt: skip
OUT = "out_{}_"


def word(name: str) -> str:
    """`name` as an identifier of Modelica."""
    return f"{name}_" if name in _TAKEN or name.endswith("_") else name


class Writer:
    """Writes one function after the other; `widths` has the numbers of results of those before."""

    def __init__(self) -> None:
        self.widths: dict[str, int] = {}
        self.scope = Scope({}, {}, "")

    # --- expressions --------------------------------------------------------------------------------------------------

    def number(self, node: ast.expr) -> str:
        """An expression of type Real; raises InexpressibleError."""
        if self.scope.is_flag(node):
            return f"(if {self.truth(node)} then 1.0 else 0.0)"
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            return repr(float(node.value))
        if isinstance(node, ast.Name):
            return self.name(node.id)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            return f"({'-' if isinstance(node.op, ast.USub) else '+'}{self.number(node.operand)})"
        if isinstance(node, ast.BinOp):
            return self._operated(node)
        if isinstance(node, ast.IfExp):
            return f"(if {self.truth(node.test)} then {self.number(node.body)} else {self.number(node.orelse)})"
        if isinstance(node, ast.Call):
            return self._called(node)
        raise InexpressibleError(node, f"it knows no {type(node).__name__}: an export takes plain numbers only")

    def truth(self, node: ast.expr) -> str:
        """An expression of type Boolean."""
        if isinstance(node, ast.BoolOp):
            return "(" + (" and " if isinstance(node.op, ast.And) else " or ").join(map(self.truth, node.values)) + ")"
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return f"(not {self.truth(node.operand)})"
        if isinstance(node, ast.Compare):
            return self._compared(node)
        if isinstance(node, ast.Name) and self.scope.is_flag(node):
            return self.name(node.id)
        if isinstance(node, ast.Constant) and isinstance(node.value, bool):
            return str(node.value).lower()
        if self.scope.is_flag(node):
            raise InexpressibleError(node, "Modelica does not ask whether a number is finite")
        return f"({self.number(node)} <> 0.0)"

    def name(self, name: str) -> str:
        """A variable of the present function."""
        return word(name)

    def _operated(self, node: ast.BinOp) -> str:
        left, right = self.number(node.left), self.number(node.right)
        if type(node.op) in _OPERATED:
            return f"({left} {_OPERATED[type(node.op)]} {right})"
        if isinstance(node.op, ast.Mod | ast.FloorDiv):
            return f"mod({left}, {right})" if isinstance(node.op, ast.Mod) else f"floor({left} / {right})"
        raise InexpressibleError(node, "operators on bits and matrices are not for Reals")

    def _compared(self, node: ast.Compare) -> str:
        sides, terms = [node.left, *node.comparators], []
        for left, operator, right in zip(sides, node.ops, sides[1:], strict=False):
            if type(operator) not in _COMPARED:
                raise InexpressibleError(node, "`is` and `in` are not for numbers")
            terms.append(f"({self.number(left)} {_COMPARED[type(operator)]} {self.number(right)})")
        return terms[0] if len(terms) == 1 else f"({' and '.join(terms)})"

    def _called(self, node: ast.Call) -> str:
        name = called(node)
        given = [self.number(one) for one in node.args]
        if name in ("min", "max", "minimum", "maximum") and len(given) > 1:
            text = given[0]
            for other in given[1:]:
                text = f"{name[:3]}({text}, {other})"
            return text
        if name in BUILT_IN and len(given) == 1:
            return f"{BUILT_IN[name]}({given[0]})"
        if name in _WRITTEN and len(given) == 1 + ("{1}" in _WRITTEN[name]):
            return _WRITTEN[name].format(*given)
        if self.widths.get(name) == 0:
            return self.call(node)
        raise InexpressibleError(node, f"Modelica has no {ast.unparse(node.func)} for these arguments")

    def call(self, node: ast.Call) -> str:
        """A call of a function that was written before."""
        named = [f"{word(one.arg)} = {self.number(one.value)}" for one in node.keywords if one.arg]
        return f"{word(called(node))}({', '.join([*map(self.number, node.args), *named])})"

    # --- functions ----------------------------------------------------------------------------------------------------

    def function(self, tree: ast.FunctionDef) -> list[str]:
        """The lines of a function; raises InexpressibleError."""
        arguments = [one.arg for one in tree.args.args]
        stored = Counter(n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store))
        self.scope.flags = set()
        self.scope.flags = conditions(tree, set(arguments), self.scope)
        self.width, self._held, self._counters = self._width(tree), 0, set[str]()
        body = self._block(tree.body)
        body = body[:-1] if body[-1] == "return;" else body  # the end returns, too
        changed = [name for name in arguments if name in stored]  # inputs of a function cannot be assigned
        last = dict(zip(arguments[::-1], tree.args.defaults[::-1], strict=False))
        inputs = [self._input(name, name in changed, last.get(name)) for name in arguments]
        own = [f"{self._type(name)} {word(name)};" for name in stored if name not in self._counters]
        own += [f"Real {self._temporary(k)};" for k in range(self._held)]
        taken = [f"{word(name)} := {self._taken(name)};" for name in changed]
        self.widths[tree.name] = self.width
        return [
            f"function {word(tree.name)}",
            *_indented(inputs), *_indented(f"output Real {OUT.format(k)};" for k in range(max(self.width, 1))),
            *(["protected", *_indented(own)] if own else []), "algorithm", *_indented([*taken, *body]),
            f"end {word(tree.name)};",
        ]  # fmt: skip

    def _input(self, name: str, changed: bool, default: ast.expr | None) -> str:
        start = f" = {self.number(default)}" if default is not None else ""
        return f"input Real {self._taken(name) if changed else word(name)}{start};"

    @staticmethod
    def _taken(name: str) -> str:
        return f"{name}_given_"

    @staticmethod
    def _temporary(k: int) -> str:
        return f"held_{k}_"

    def _type(self, name: str) -> str:
        return "Boolean" if name in self.scope.flags else "Real"

    def _width(self, tree: ast.FunctionDef) -> int:
        values = [n.value for n in ast.walk(tree) if isinstance(n, ast.Return)]
        found = [len(v.elts) for v in values if isinstance(v, ast.Tuple)]
        found += [self.widths.get(called(v), 0) for v in values if isinstance(v, ast.Call)]
        return max(found, default=0)

    def _block(self, body: Iterable[ast.stmt]) -> list[str]:
        return [line for statement in body for line in self._statement(statement)]

    def _statement(self, node: ast.stmt) -> list[str]:
        try:
            return self._written(node)
        except InexpressibleError as problem:
            raise problem if isinstance(problem.node, ast.stmt) else InexpressibleError(node, problem.what) from problem

    def _written(self, node: ast.stmt) -> list[str]:
        if isinstance(node, ast.Assign):
            return [line for target in node.targets for line in self._assigned(target, node.value)]
        if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
            value = ast.BinOp(ast.Name(node.target.id, ast.Load()), node.op, node.value)
            return self._assigned(node.target, value)
        if isinstance(node, ast.Return) and node.value is not None:
            return [*self._returned(node.value), "return;"]
        if isinstance(node, ast.If):
            return [*self._branches(node, "if"), "end if;"]
        if isinstance(node, ast.While) and not node.orelse:
            return [f"while {self.truth(node.test)} loop", *_indented(self._block(node.body)), "end while;"]
        if isinstance(node, ast.For) and not node.orelse:
            return self._counted(node)
        if isinstance(node, ast.Pass) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            return []
        if isinstance(node, ast.Break):
            return ["break;"]
        raise InexpressibleError(node, "an export takes assignments, if, for ... in range(...), while and return")

    def _branches(self, node: ast.If, begin: str) -> list[str]:
        lines = [f"{begin} {self.truth(node.test)} then", *_indented(self._block(node.body))]
        if len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If):
            return [*lines, *self._branches(node.orelse[0], "elseif")]
        return [*lines, *(["else", *_indented(self._block(node.orelse))] if node.orelse else [])]

    def _assigned(self, target: ast.expr, value: ast.expr) -> list[str]:
        if isinstance(target, ast.Name):
            text = self.truth(value) if target.id in self.scope.flags else self.number(value)
            return [f"{word(target.id)} := {text};"]
        if not isinstance(target, ast.Tuple) or not all(isinstance(one, ast.Name) for one in target.elts):
            raise InexpressibleError(target, "an export assigns to plain names only, not into arrays")
        names = [one.id for one in target.elts if isinstance(one, ast.Name)]
        if isinstance(value, ast.Tuple) and len(value.elts) == len(names):
            return self._side_by_side(names, value.elts)
        if isinstance(value, ast.Call) and self.widths.get(called(value)) == len(names):
            return [f"({', '.join(map(word, names))}) := {self.call(value)};"]
        raise InexpressibleError(value, f"the right side does not give {len(names)} numbers")

    def _side_by_side(self, names: list[str], values: list[ast.expr]) -> list[str]:
        read = {n.id for value in values for n in ast.walk(value) if isinstance(n, ast.Name)}
        if not read & {*names}:
            pairs = zip(names, values, strict=True)
            return [line for n, v in pairs for line in self._assigned(ast.Name(n, ast.Store()), v)]
        held = [self._temporary(self._held + k) for k in range(len(names))]
        self._held += len(names)
        lines = [f"{h} := {self.number(v)};" for h, v in zip(held, values, strict=True)]
        return lines + [f"{word(n)} := {h};" for n, h in zip(names, held, strict=True)]

    def _returned(self, value: ast.expr) -> list[str]:
        if isinstance(value, ast.Tuple):
            return [f"{OUT.format(k)} := {self.number(one)};" for k, one in enumerate(value.elts)]
        if not self.width:
            return [f"{OUT.format(0)} := {self.number(value)};"]
        if isinstance(value, ast.Call) and self.widths.get(called(value)) == self.width:
            return [f"({', '.join(OUT.format(k) for k in range(self.width))}) := {self.call(value)};"]
        raise InexpressibleError(value, f"it must return {self.width} numbers everywhere")

    def _counted(self, node: ast.For) -> list[str]:
        call, target = node.iter, node.target
        ranged = isinstance(call, ast.Call) and called(call) == "range" and 0 < len(call.args) < 3
        if not ranged or not isinstance(target, ast.Name) or not isinstance(call, ast.Call):
            raise InexpressibleError(node, "it counts with: for i in range(n), or range(first, end)")
        ends = [f"integer({self.number(one)})" for one in call.args]
        first, end = ends if len(ends) == 2 else ["0", *ends]
        self._counters.add(target.id)
        return [f"for {word(target.id)} in {first}:{end} - 1 loop", *_indented(self._block(node.body)), "end for;"]


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"  {line}" for line in lines]


def functions_text(functions: Mapping[str, ast.FunctionDef], roots: Iterable[str]) -> tuple[list[str], dict[str, int]]:
    """Lines of all functions that `roots` need, and how many results each has; those built in are Modelica's own.

    Raises InexpressibleError, with the function's name as its second argument.
    """
    writer, needed, lines = Writer(), _needed(functions, roots), list[str]()
    for name, tree in functions.items():
        if name in needed:
            try:
                lines += [*writer.function(tree), ""]
            except InexpressibleError as problem:
                problem.args = (*problem.args, name)
                raise
    return lines, writer.widths


def _needed(functions: Mapping[str, ast.FunctionDef], roots: Iterable[str]) -> set[str]:
    found, open_ = set[str](), list(roots)
    while open_:
        name = open_.pop()
        if name in functions and name not in found and name not in BUILT_IN:
            found.add(name)
            open_ += [called(n) for n in ast.walk(functions[name]) if isinstance(n, ast.Call)]
    return found
