"""Order the calls of effects by data flow: an effect that reads a signal runs after all that write it."""

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import maths
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.reach import default_of, fades, names_in
from pneumo_ros.plant.signals import SIGNALS
from pneumo_ros.plant.source import SourceBook

if TYPE_CHECKING:
    from pneumo_ros.plant.compose import Resolver


@dataclass(frozen=True)
class Line:
    """A line of a function body, and the effect without which it may be passed over: None if it never may.

    `instead`: lines that then give what it assigns; `idle`: what it assigns then that is constant, by variable.
    """

    text: str
    effect: type[Effect] | None = None
    instead: tuple[str, ...] = ()
    idle: tuple[tuple[str, float], ...] = ()


class FlowWriter:
    """Writes one function body: every signal that the wanted names depend on, each once, in order of data flow."""

    def __init__(self, resolver: "Resolver", book: SourceBook) -> None:
        self.resolver, self.book = resolver, book
        self.written: list[Line] = []
        self._done: dict[str, str] = {}  # signal or der_/rate_ name -> variable or literal
        self._stages: dict[tuple[str, int], str] = {}  # single signal, how often rewritten -> variable or literal
        self._called: set[tuple[str, str]] = set()
        self._open: list[str] = []

    @property
    def lines(self) -> list[str]:
        """The texts of its lines."""
        return [line.text for line in self.written]

    def value(self, name: str, effect: type[Effect] | None = None) -> str:
        """Variable that holds `name` (state, signal, derivative or parameter), after writing the lines it needs."""
        if name in self.resolver.states:
            return name
        if name in self.resolver.open_side:
            return self._open_side(name)
        if effect is not None and name in effect.parameters:
            return f"{effect.name}__{name}"
        if name in SIGNALS or name.startswith(("der_", "rate_")):
            return self._signal(name)
        variable = self.resolver.parameter(name, effect)
        assert variable is not None, name
        return variable

    def _open_side(self, name: str) -> str:
        """What stands for a name of a side that is no chamber: a constant, or the signal that is there."""
        there = self.resolver.open_side[name]
        return self.value(there) if there in SIGNALS else there

    def _signal(self, name: str) -> str:
        if name not in self._done:
            if name in self._open:
                chain = " -> ".join([*self._open[self._open.index(name) :], name])
                raise UsageError(f"these signals depend on each other: {chain}; one effect of the loop needs a state")
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
        if kind in ("input", "measured"):
            return name
        if kind == "single":
            return self._single(name, writers)
        for writer in writers:
            self._call(*writer)
        terms = [f"{effect.name}__{name}" for effect, _ in writers]
        if len(terms) < 2:
            return terms[0] if terms else SIGNALS[name].default
        self.written.append(Line(f"{name} = {(' + ' if kind == 'sum' else ' * ').join(terms)}"))
        return name

    def _single(self, name: str, writers: list[tuple[type[Effect], str]]) -> str:
        origins = [writer for writer in writers if writer not in self._changes(name)]
        if len(origins) > 1:
            raise UsageError(
                f"effects {' and '.join(w.name for w, _ in origins)} both set {name}; leave one of them out"
            )
        return self._after(name, len(self._changes(name)))

    def _changes(self, name: str) -> list[tuple[type[Effect], str]]:
        """Functions that rewrite a signal: they read it and return it."""
        return [w for w in self.resolver.writers.get(name, []) if name in w[0].functions[w[1]].reads]

    def _after(self, name: str, count: int) -> str:
        """Variable that holds a single signal after the first `count` functions that rewrite it."""
        if (name, count) not in self._stages:
            changes = self._changes(name)
            origins = [w for w in self.resolver.writers.get(name, []) if w not in changes]
            writers = [changes[count - 1]] if count else origins
            for writer in writers:
                self._call(*writer)
            self._stages[name, count] = f"{writers[0][0].name}__{name}" if writers else self._default(name)
        return self._stages[name, count]

    def _default(self, name: str) -> str:
        """Variable or literal of the default of a single signal, after writing the line it needs."""
        text = self._default_text(name)
        if isinstance(ast.parse(text, mode="eval").body, ast.Name | ast.Constant):
            return text
        self.written.append(Line(f"{name} = {text}"))
        return name

    def _default_text(self, name: str) -> str:
        """The default expression of a single signal with every name in it resolved."""
        default = default_of(SIGNALS[name], self.resolver.measured)
        tree: Any = ast.parse(default, mode="eval")
        if SIGNALS[name].without and any(self._lacks(key) for key in names_in(default)):
            return SIGNALS[name].without
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and hasattr(maths, node.id):
                node.id = self.book.helper(getattr(maths, node.id), f"signal {name}")
            elif isinstance(node, ast.Name):
                node.id = self._known(node.id, name)
        return ast.unparse(tree)

    def _known(self, name: str, wanted: str) -> str:
        if self._lacks(name):
            raise UsageError(f"{wanted} is needed, but no effect listed sets it and its default needs {name}")
        return self.value(name)

    def _lacks(self, name: str) -> bool:
        states = self.resolver.states
        return name not in states and name not in SIGNALS and self.resolver.parameter(name, None) is None

    def _call(self, effect: type[Effect], function: str) -> None:
        if (effect.name, function) in self._called:
            return
        data = effect.functions[function]
        arguments = ", ".join(self._argument(name, effect, function) for name in data.reads)
        self._called.add((effect.name, function))
        called = self.book.add(data, f"{effect.name}__{function}", f"effect {effect.name}")
        targets = ", ".join(f"{effect.name}__{name}" for name in data.writes)
        self.written.append(self._passable(f"{targets} = {called}({arguments})", effect, function))

    def _passable(self, text: str, effect: type[Effect], function: str) -> Line:
        """The line `text`, which calls a function, with what stands for its values where its effect adds nothing."""
        instead, idle = list[str](), list[tuple[str, float]]()
        for name in () if function == "advance" else effect.functions[function].writes:
            variable, kind = f"{effect.name}__{name}", SIGNALS[name].kind if name in SIGNALS else "sum"
            if kind in ("sum", "product"):
                idle.append((variable, 0.0 if kind == "sum" else 1.0))
            elif (effect, function) in self._changes(name):
                instead.append(f"{variable} = {self._argument(name, effect, function)}")
            elif self._stands_alone(name, effect):
                instead.append(f"{variable} = {self._default_text(name)}")
            else:
                return Line(text)
        return Line(text, effect if fades(effect) else None, tuple(instead), tuple(idle))

    def _stands_alone(self, name: str, effect: type[Effect]) -> bool:
        """Whether the default of a single signal needs, at an instant, neither `effect` nor what the machine lacks."""
        todo, seen = [one for one in self._defaults(name) if not hasattr(maths, one)], set[str]()
        if any(map(self._lacks, todo)):
            return False
        while todo:  # each signal once
            one = todo.pop()
            if one in seen or one not in SIGNALS or one in self.resolver.states:
                continue
            seen.add(one)
            writers = self.resolver.writers.get(one, [])
            if any(writer is effect for writer, _ in writers):
                return False
            todo += [*self._defaults(one), *(n for writer, key in writers for n in writer.functions[key].reads)]
        return True

    def _defaults(self, name: str) -> list[str]:
        return names_in(default_of(SIGNALS[name], self.resolver.measured))

    def _argument(self, name: str, effect: type[Effect], function: str) -> str:
        """Variable of an argument; for a signal that the function rewrites, its value after the rewrites before."""
        rewrites = name in effect.functions[function].writes and name in SIGNALS
        changes = self._changes(name) if rewrites and name not in self.resolver.open_side else []
        if (effect, function) in changes:
            return self._after(name, changes.index((effect, function)))
        return self.value(name, effect)

    def advance(self, effect: type[Effect]) -> None:
        """Write the once-per-step function of an effect, assigning its states."""
        self._call(effect, "advance")
        for name in effect.functions["advance"].writes:
            self.written.append(Line(f"{name} = {effect.name}__{name}", effect if fades(effect) else None))
