"""Topics selected by a list of names and patterns, and their types."""

from collections.abc import Iterable, Iterator, Mapping
from fnmatch import fnmatchcase

from rclpy.node import Node

from pneumo_ros.errors import UsageError
from pneumo_ros.records import contract
from pneumo_ros.ros.intake import latches
from pneumo_ros.ros.message_classes import message_class


class Selection:
    """Topics by name, relative to the node's namespace and remapped, or by pattern with * and ?.

    `known` are those in the contract: (type, latched) by resolved name.
    """

    def __init__(self, node: Node, names: Iterable[str]) -> None:
        """Raises UsageError for an invalid name."""
        self._node = node
        self._refused: set[str] = set()
        self._patterns: list[str] = []
        self.known: dict[str, tuple[str, bool]] = {}
        self.extend(names)

    def extend(self, names: Iterable[str]) -> dict[str, tuple[str, bool]]:
        """Select more topics; returns those of them in the contract, as `known` has them. UsageError as above."""
        fresh = [one for one in (resolve(self._node, name) for name in names) if one not in self._patterns]
        found = {topic: kind for topic in fresh if (kind := _by_contract(topic))}
        self._patterns += fresh
        self.known |= found
        return found

    def appeared(self, present: Mapping[str, str]) -> Iterator[tuple[str, str, bool]]:
        """Selected topics that are published, but not `present` with that type: name, type, whether it is latched."""
        for topic, _ in self._node.get_topic_names_and_types():
            if topic in self._refused or not self._selects(topic):
                continue
            offered = self._node.get_publishers_info_by_topic(topic)
            kinds = [one.topic_type for one in offered]
            if kinds and present.get(topic) not in kinds and self._usable(topic, kinds[0]):
                yield topic, kinds[0], all(latches(one.qos_profile) for one in offered)

    def _selects(self, topic: str) -> bool:
        return any(fnmatchcase(topic, pattern) for pattern in self._patterns)

    def _usable(self, topic: str, kind: str) -> bool:
        """Whether messages of type `kind` can be received here; a warning says once if not."""
        try:
            message_class(kind)
        except UsageError as error:
            self._refused.add(topic)
            self._node.get_logger().warning(f"{topic} is left out: {error}")
            return False
        return True


def resolve(node: Node, name: str) -> str:
    """Full name of a topic of `node`; a pattern only gets the namespace. Raises UsageError for an invalid name."""
    if set(name) & set("*?["):
        return name if name.startswith("/") else f"{node.get_namespace().rstrip('/')}/{name}"
    try:
        return str(node.resolve_topic_name(name))
    except RuntimeError as error:  # RCLError is no class of rclpy's public modules
        raise UsageError(f"'{name}' cannot be the name of a topic: {error}") from error


def _by_contract(topic: str) -> tuple[str, bool] | None:
    """Type of a topic in the contract, and whether it is latched; None for others."""
    if topic in contract.GLOBAL_TYPES:
        return contract.GLOBAL_TYPES[topic], False
    found = contract.split(topic)
    return (contract.TYPES[found[1]], found[1] in contract.LATCHED) if found else None
