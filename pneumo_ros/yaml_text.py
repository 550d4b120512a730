"""Untrusted YAML: only its safe subset, with limits of depth and length, and one error class for every problem."""

from collections.abc import Callable
from typing import Any

import yaml

from pneumo_ros.errors import UsageError

DEPTH = 64  # levels of lists and sections; at some hundreds Python raises an error that does not help a user
DIGITS = 400  # of a number: a double never has more, and the time to read 1:59:59... grows with its length squared


def load_yaml(text: str) -> Any:
    """The content of `text`: dictionaries, lists, text, numbers, dates. Nothing in it is run.

    Raises UsageError, with the line, for text that is no YAML, is nested deeper than DEPTH, gives a name twice, or
    names another kind of object.
    """
    try:
        return yaml.load(text, _Loader)
    except Exception as error:  # a bad date or a set of lists raises other errors: all mean bad YAML
        place = getattr(error, "problem_mark", None)
        where = f" at line {place.line + 1}" if place else ""
        reason = str(getattr(error, "problem", None) or error).splitlines() or ["it is no YAML"]
        raise UsageError(f"this cannot be read as YAML{where}: {reason[0][:200]}") from error


class _Loader(yaml.SafeLoader):
    """The safe loader with limits: by itself it accepts any depth, any length, and a name that is given twice."""

    _depth = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        self._depth += 1
        if self._depth > DEPTH:
            raise yaml.composer.ComposerError(None, None, f"it is nested deeper than {DEPTH} levels", self.get_mark())
        try:
            node: yaml.Node | None = super().compose_node(parent, index)
            return node
        finally:
            self._depth -= 1

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen: dict[str, yaml.Mark] = {}
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in seen:
                    raise yaml.constructor.ConstructorError(None, None, f"{key.value} is given twice", seen[key.value])
                seen[key.value] = key.start_mark
        return super().construct_mapping(node, deep)


def _within(construct: Callable[[yaml.SafeLoader, yaml.ScalarNode], Any]) -> Callable[[Any, Any], Any]:
    """`construct`, limited to numbers of at most DIGITS digits."""

    def number(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> Any:
        if len(node.value) > DIGITS:
            raise yaml.constructor.ConstructorError(
                None, None, f"a number of {len(node.value)} digits", node.start_mark
            )
        return construct(loader, node)

    return number


_Loader.add_constructor("tag:yaml.org,2002:int", _within(yaml.SafeLoader.construct_yaml_int))
_Loader.add_constructor("tag:yaml.org,2002:float", _within(yaml.SafeLoader.construct_yaml_float))
