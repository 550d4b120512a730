"""Statements and functions of the kernel's Python as C99."""

import ast
from collections import Counter

from pneumo_ros.export.assigned import conditions, pairs
from pneumo_ros.export.expression import Scope
from pneumo_ros.export.identifiers import identifier
from pneumo_ros.export.signature import InexpressibleError, Signature, head

_INDENT = "    "


def function_text(tree: ast.FunctionDef, signature: Signature, scope: Scope) -> str:
    """The C text of one static function; raises InexpressibleError."""
    return _Function(tree, signature, scope).text()


class _Function:
    def __init__(self, tree: ast.FunctionDef, signature: Signature, scope: Scope) -> None:
        self.tree, self.signature, self.scope = tree, signature, scope
        nodes = [n for n in ast.walk(tree) if isinstance(n, ast.Name)]
        self.read = {n.id for n in nodes if isinstance(n.ctx, ast.Load)}
        self.writes = Counter(n.id for n in nodes if isinstance(n.ctx, ast.Store))
        self.temporaries = 0
        scope.flags |= conditions(tree, set(signature.arguments), scope)

    def text(self) -> str:
        """The whole function."""
        single = {n for s in self.tree.body for n, _ in pairs(s) if self.writes[n] == 1}
        self.constants = single - set(self.signature.arguments)
        lines = [f"(void){identifier(a)};" for a in self.signature.arguments if a not in self.read]
        if self.signature.takes_parameters and not self._needs_parameters():
            lines.append("(void)p;")
        for name in self.writes:
            if name not in self.constants and name not in self.signature.arguments:
                lines.append(f"{self._type(name)} {identifier(name)} = 0;")
                lines += [] if name in self.read else [f"(void){identifier(name)};"]
        lines += self._block(self.tree.body)
        return "\n".join([head(self.signature, self.scope.struct), "{", *(_INDENT + line for line in lines), "}"])

    def _needs_parameters(self) -> bool:
        called = {n.func.id for n in ast.walk(self.tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
        inner = any(self.scope.functions[n].takes_parameters for n in called if n in self.scope.functions)
        return inner or any(name in self.scope.parameters for name in self.read - set(self.signature.arguments))

    def _type(self, name: str) -> str:
        return "int" if name in self.scope.flags else "double"

    def _block(self, body: list[ast.stmt]) -> list[str]:
        return [line for statement in body for line in self._statement(statement)]

    def _nested(self, body: list[ast.stmt]) -> list[str]:
        return [_INDENT + line for line in self._block(body)]

    def _statement(self, node: ast.stmt) -> list[str]:
        try:
            return self._write(node)
        except InexpressibleError as problem:
            if not isinstance(problem.node, ast.stmt):
                raise InexpressibleError(node, problem.what) from problem
            raise

    def _write(self, node: ast.stmt) -> list[str]:
        if isinstance(node, ast.Assign):
            return self._assign(node)
        if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
            sum_ = ast.BinOp(ast.Name(node.target.id, ast.Load()), node.op, node.value)
            return [f"{identifier(node.target.id)} = {self.scope.number(sum_)};"]
        if isinstance(node, ast.Return) and node.value is not None:
            return self._return(node.value)
        if isinstance(node, ast.If):
            return self._if(node)
        if isinstance(node, ast.While) and not node.orelse:
            return [f"while ({self.scope.truth(node.test)}) {{", *self._nested(node.body), "}"]
        if isinstance(node, ast.For) and not node.orelse:
            return self._for(node)
        if isinstance(node, ast.Pass) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            return []
        if isinstance(node, ast.Break | ast.Continue):
            return ["break;" if isinstance(node, ast.Break) else "continue;"]
        raise InexpressibleError(node, "an export takes assignments, if, for ... in range(...), while and return")

    def _assign(self, node: ast.Assign) -> list[str]:
        last = node.targets[-1]
        if len(node.targets) > 1:
            if not all(isinstance(target, ast.Name) for target in node.targets):
                raise InexpressibleError(node, "assign to one group of names at a time")
            return [line for target in node.targets for line in self._plain(target, node.value)]
        return self._several(last, node.value) if isinstance(last, ast.Tuple) else self._plain(last, node.value)

    def _plain(self, target: ast.expr, value: ast.expr) -> list[str]:
        if not isinstance(target, ast.Name):
            raise InexpressibleError(target, "an export assigns to plain names only, not into arrays")
        return self._set(target.id, self.scope.number(value))

    def _set(self, name: str, text: str) -> list[str]:
        if name not in self.constants:
            return [f"{identifier(name)} = {text};"]
        unread = [] if name in self.read else [f"(void){identifier(name)};"]
        return [f"const {self._type(name)} {identifier(name)} = {text};", *unread]

    def _several(self, target: ast.Tuple, value: ast.expr) -> list[str]:
        names = [t.id for t in target.elts if isinstance(t, ast.Name)]
        if len(names) != len(target.elts):
            raise InexpressibleError(target, "an export assigns to plain names only")
        if isinstance(value, ast.Tuple) and len(value.elts) == len(names):
            return self._side_by_side(names, value.elts)
        signature = self._several_from(value)
        if signature is None or signature.width != len(names):
            raise InexpressibleError(value, f"the right side does not give {len(names)} numbers")
        assert isinstance(value, ast.Call)
        return [self.scope.call(value, signature, tuple(f"&{identifier(n)}" for n in names)) + ";"]

    def _several_from(self, value: ast.expr) -> Signature | None:
        """The function of the kernel that `value` calls, if it returns several numbers."""
        if not (isinstance(value, ast.Call) and isinstance(value.func, ast.Name)):
            return None
        signature = self.scope.functions.get(value.func.id)
        return signature if signature is not None and signature.width else None

    def _side_by_side(self, names: list[str], values: list[ast.expr]) -> list[str]:
        read = {n.id for value in values for n in ast.walk(value) if isinstance(n, ast.Name)}
        texts = [self.scope.number(value) for value in values]
        if not read & set(names):
            return [line for pair in zip(names, texts, strict=True) for line in self._set(*pair)]
        self.temporaries += len(names)
        held = [f"held_{self.temporaries - i}_" for i in range(len(names))]
        lines = [f"const double {h} = {text};" for h, text in zip(held, texts, strict=True)]
        return lines + [line for pair in zip(names, held, strict=True) for line in self._set(*pair)]

    def _return(self, value: ast.expr) -> list[str]:
        width = self.signature.width
        if not width:
            return [f"return {self.scope.number(value)};"]
        if isinstance(value, ast.Tuple):
            return [f"*out_{i}_ = {self.scope.number(v)};" for i, v in enumerate(value.elts)] + ["return;"]
        signature = self._several_from(value)
        if signature is None or not isinstance(value, ast.Call):
            raise InexpressibleError(value, f"it must return {width} numbers everywhere")
        return [self.scope.call(value, signature, tuple(f"out_{i}_" for i in range(width))) + ";", "return;"]

    def _if(self, node: ast.If) -> list[str]:
        lines = [f"if ({self.scope.truth(node.test)}) {{", *self._nested(node.body), "}"]
        if node.orelse:
            lines = [*lines[:-1], "} else {", *self._nested(node.orelse), "}"]
        return lines

    def _for(self, node: ast.For) -> list[str]:
        call, target = node.iter, node.target
        ranged = isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "range"
        if not ranged or not isinstance(target, ast.Name) or not isinstance(call, ast.Call) or len(call.args) > 2:
            raise InexpressibleError(node, "it counts with: for i in range(n), or range(first, end)")
        ends = [self.scope.number(a) for a in call.args]
        first, end = ends if len(ends) == 2 else ["0.0", *ends]
        self.temporaries += 2
        count, last = f"held_{self.temporaries - 1}_", f"held_{self.temporaries}_"
        head_ = f"for (double {count} = {first}, {last} = {end}; {count} < {last}; {count} += 1.0) {{"
        return [head_, f"{_INDENT}{identifier(target.id)} = {count};", *self._nested(node.body), "}"]
