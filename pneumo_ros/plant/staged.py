"""Write functions that are evaluated for a block of lanes effect by effect, so that effects may be passed over.

One kernel serves all models that a search compares: it has every effect, and in each lane all but a few are at their
neutral values. In one loop over lanes a branch would keep lanes from advancing side by side; a loop for each effect can
be passed over as a whole. All variables of a block stand in one array `cells`, LANES entries each. The loops run over
the `width` lanes that are filled. Were their number known when they are compiled, they would be unrolled before they
can become loops over vectors.
"""

import ast
from collections.abc import Collection, Iterable, Sequence
from functools import lru_cache

from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.entries import LANES
from pneumo_ros.plant.flow import Line
from pneumo_ros.plant.reach import fades


class Block:
    """Places of variables in the array `cells` of a block of lanes, and the loops that work on them."""

    def __init__(self, effects: Sequence[type[Effect]], states: Collection[str], uniform: Sequence[str]) -> None:
        """`uniform`: names that are alike in all lanes: arguments of the functions that hold the loops."""
        self.switches = [effect.name for effect in effects if fades(effect)]
        self.states, self.uniform = frozenset(states), frozenset(uniform)
        self.idle: dict[str, float] = {}  # values of variables that no loop assigns where an effect is passed over
        self._places: dict[str, int] = {}

    def __len__(self) -> int:
        return len(self._places)

    def place(self, name: str) -> int:
        """Which variable of the block this is; a new one has the next place."""
        return self._places.setdefault(name, len(self._places))

    def same(self, name: str, other: str) -> None:
        """Let `name` mean the variable `other`."""
        self._places[name] = self._places[other]

    def loop(self, lines: Sequence[str], effect: str | None = None, suffix: str = "") -> list[str]:
        """The lines for every lane; only if the block has `effect`, where that is given.

        States in the lines mean the variables with this suffix.
        """
        if not lines:
            return []
        reads, writes = dict[str, None](), dict[str, None]()
        for line in lines:
            loaded, stored = _names(line)
            reads |= dict.fromkeys(name for name in loaded if name not in {*self.uniform, *writes})
            writes |= dict.fromkeys(name for name in stored if name != "_")

        def entry(name: str) -> str:
            place = self.place(name + suffix if name in self.states else name)
            return f"{LANES * place}, i"

        body = [*(f"{name} = get(cells, {entry(name)})" for name in reads), *lines]
        body += [f"put(cells, {entry(name)}, {name})" for name in writes]
        loop = ["for i in range(width):", *indented(body)]
        return [f"if {self.has(effect)}:", *indented(loop)] if effect else loop

    def has(self, effect: str) -> str:
        """Whether a block has an effect."""
        return f"acting[{self.switches.index(effect)}]"

    def stages(self, written: Sequence[Line], suffix: str) -> list[str]:
        """The lines of a function body, those of each effect in loops of their own."""
        found, todo = list[str](), list(written)
        while todo:
            owner = todo[0].effect
            count = next((k for k, line in enumerate(todo) if line.effect is not owner), len(todo))
            taken, todo = todo[:count], todo[count:]
            found += self.loop([line.text for line in taken], owner.name if owner else None, suffix)
            instead = self.loop([text for line in taken for text in line.instead], None, suffix)
            found += ["else:", *indented(instead)] if owner and instead else []
            self.idle |= {name: value for line in taken if owner for name, value in line.idle}
        return found


def in_order(written: Sequence[Line]) -> list[Line]:
    """Lines of which none is assigned twice, in as few loops as data flow allows.

    All that is ready of effects comes before what no effect may be without.
    """
    todo, found = list(written), list[Line]()
    unknown = {name for line in written for name in _names(line.text)[1]}
    owner: type[Effect] | None = None
    while todo:
        ready = [line for line in todo if not _needed(line) & unknown]
        line = min(ready, key=lambda one: (one.effect is not owner, one.effect is None))
        owner = line.effect
        todo.remove(line)
        found.append(line)
        unknown -= set(_names(line.text)[1])
    return found


def _needed(line: Line) -> set[str]:
    """Names that a line, or what stands for it, reads."""
    return {name for text in (line.text, *line.instead) for name in _names(text)[0]}


@lru_cache(4096)
def _names(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of variables that a line reads, and that it assigns."""
    nodes = list(ast.walk(ast.parse(text)))
    called = {n.func.id for n in nodes if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
    names = [node for node in nodes if isinstance(node, ast.Name) and node.id not in called]
    loaded = dict.fromkeys(node.id for node in names if isinstance(node.ctx, ast.Load))
    return tuple(loaded), tuple(node.id for node in names if isinstance(node.ctx, ast.Store))


def indented(lines: Iterable[str], depth: int = 1) -> list[str]:
    """The lines, further to the right."""
    return ["    " * depth + line for line in lines]
