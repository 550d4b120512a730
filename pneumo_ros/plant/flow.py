"""Order the calls of effects by data flow: whoever reads a signal runs after all who write it."""

import ast
from typing import TYPE_CHECKING, Any

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import maths
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.signals import SIGNALS
from pneumo_ros.plant.source import SourceBook

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


class FlowWriter:
    """Writes one function body: every signal that the wanted names depend on, each once, in order of data flow."""

    def __init__(self, resolver: "Resolver", book: SourceBook) -> None:
        self.resolver, self.book = resolver, book
        self.lines: list[str] = []
        self._done: dict[str, str] = {}  # signal or der_/rate_ name -> variable or literal
        self._called: set[tuple[str, str]] = set()
        self._open: list[str] = []

    def value(self, name: str, effect: type[Effect] | None = None) -> str:
        """Variable that holds `name` (state, signal, derivative or parameter), after writing whatever it needs."""
        if name in self.resolver.states:
            return name
        if effect is not None and name in effect.parameters:
            return f"{effect.name}__{name}"
        if name in SIGNALS or name.startswith(("der_", "rate_")):
            return self._signal(name)
        variable = self.resolver.parameter(name, effect)
        assert variable is not None, name
        return variable

    def _signal(self, name: str) -> str:
        if name not in self._done:
            if name in self._open:
                chain = " -> ".join([*self._open[self._open.index(name) :], name])
                raise UsageError(f"these signals wait for each other: {chain}; one effect of the loop needs a state")
            self._open.append(name)
            self._done[name] = self._assemble(name)
            self._open.pop()
        return self._done[name]

    def _assemble(self, name: str) -> str:
        writers = self.resolver.writers.get(name, [])
        if name not in SIGNALS:
            self._call(*writers[0])
            return f"{writers[0][0].name}__{name}"
        kind = SIGNALS[name].kind
        if kind == "input":
            return name
        if kind == "single":
            return self._single(name, writers)
        for writer in writers:
            self._call(*writer)
        terms = [f"{effect.name}__{name}" for effect, _ in writers]
        if len(terms) < 2:
            return terms[0] if terms else SIGNALS[name].default
        self.lines.append(f"{name} = {(' + ' if kind == 'sum' else ' * ').join(terms)}")
        return name

    def _single(self, name: str, writers: list[tuple[type[Effect], str]]) -> str:
        changes = [w for w in writers if name in w[0].functions[w[1]].reads]
        origins = [w for w in writers if w not in changes]
        if len(origins) > 1:
            raise UsageError(
                f"effects {' and '.join(w.name for w, _ in origins)} both set {name}; leave one of them out"
            )
        for origin in origins:
            self._call(*origin)
        value = f"{origins[0][0].name}__{name}" if origins else self._default(name)
        for change in changes:
            self._done[name] = value
            self._call(*change)
            value = f"{change[0].name}__{name}"
        return value

    def _default(self, name: str) -> str:
        """Emit the default expression of a single signal with every name in it resolved."""
        tree: Any = ast.parse(SIGNALS[name].default, mode="eval")
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and hasattr(maths, node.id):
                node.id = self.book.helper(getattr(maths, node.id), f"signal {name}")
            elif isinstance(node, ast.Name):
                node.id = self._known(node.id, name)
        if isinstance(tree.body, ast.Name | ast.Constant):
            return ast.unparse(tree)
        self.lines.append(f"{name} = {ast.unparse(tree)}")
        return name

    def _known(self, name: str, wanted: str) -> str:
        if name not in self.resolver.states and name not in SIGNALS and self.resolver.parameter(name, None) is None:
            raise UsageError(f"{wanted} is needed, but no effect listed sets it and its default needs {name}")
        return self.value(name)

    def _call(self, effect: type[Effect], function: str) -> None:
        if (effect.name, function) in self._called:
            return
        data = effect.functions[function]
        arguments = ", ".join(self.value(name, effect) for name in data.reads)
        if (effect.name, function) in self._called:  # meanwhile, to rewrite a signal that it reads
            return
        self._called.add((effect.name, function))
        called = self.book.add(data, f"{effect.name}__{function}", f"effect {effect.name}")
        targets = ", ".join(f"{effect.name}__{name}" for name in data.writes)
        self.lines.append(f"{targets} = {called}({arguments})")

    def advance(self, effect: type[Effect]) -> None:
        """Write the once-per-step function of an effect, assigning its states."""
        self._call(effect, "advance")
        for name in effect.functions["advance"].writes:
            self.lines.append(f"{name} = {effect.name}__{name}")
