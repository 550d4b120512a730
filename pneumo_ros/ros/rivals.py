"""Whether another node has the same role in this namespace: two plants or two controllers would conflict.

Every node with a role makes a claim: a latched message with the time of its start. Of two nodes with the same role the
later one ends. Discovery on one PC takes 0.03 to 0.08 s or, where an announcement is lost, 2.4 to 2.8 s (8 and 4 of 12
starts with Fast DDS), so a node waits WAIT before it publishes, and watches while it runs.
"""

import json
import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String

from pneumo_ros.axis.roles import Claim, Role
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.qos import LATCHED

if TYPE_CHECKING:
    from pneumo_ros.ros.node import AxisNode

WAIT = 0.3  # s from the claim to the first look at who publishes
WAIT_FOR_CLAIM = 2.0  # s, if a node publishes: its name and its claim arrive after its publisher
POLL = 0.02  # s between two looks during these times
PERIOD = 1.0  # s between two looks while the node runs
UNKNOWN, UNNAMED = "_NODE_NAME_UNKNOWN_", "a program whose name is unknown"  # of rmw; in messages
CLAIMS = QoSProfile(depth=20, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Rivals:
    """The other nodes with the role of this one."""

    def __init__(self, node: "AxisNode", role: Role) -> None:
        """Make the claim. The node's publishers of the role's topics are made after `settle`."""
        self._node, self._role = node, role
        self._own = Claim(time.time_ns(), uuid.uuid4().hex, str(node.get_fully_qualified_name()))
        self._others: dict[str, Claim] = {}
        self._begun, self._settled = time.monotonic(), False
        self._found: set[str] = set()
        self._sharing: set[str] = set()
        topic = f"claims/{role.name}"
        self._claims = node.create_publisher(String, topic, LATCHED)
        self._subscription = node.create_subscription(String, topic, self._hear, CLAIMS)
        self._claims.publish(String(data=json.dumps(self._own._asdict())))

    def settle(self) -> None:
        """Wait until other nodes should be known. Raises UsageError if one of them has the role already."""
        found = self._wait(bool, self._begun + WAIT)
        if found:
            found = self._wait(lambda nodes: not nodes, time.monotonic() + WAIT_FOR_CLAIM)
        if found:
            raise self._refusal(found)
        self._settled = True
        self._node.create_timer(PERIOD, self.look, clock=self._node.steady_clock)

    def _wait(self, enough: Callable[[set[str]], bool], end: float) -> set[str]:
        """Nodes that publish without a later claim, when they are `enough` or at the time `end` [s, monotonic]."""
        found = self._starting()
        while not enough(found) and time.monotonic() < end:
            time.sleep(POLL)
            found = self._starting()
        return found

    def _starting(self) -> set[str]:
        """Take claims, UsageError for an earlier one; returns nodes that publish without a later claim."""
        self._take_claims()
        self._require_first()
        return self._publishing(self._role.topics)

    @property
    def others(self) -> str:
        """Names of the other nodes that published the role's topics at the last look, empty if there are none."""
        return " and ".join(sorted(self._found))

    @property
    def errors(self) -> list[str]:
        """For /diagnostics: who else has the role."""
        return [self._sentence(self._found)] if self._found else []

    @property
    def warnings(self) -> list[str]:
        """For /diagnostics: who publishes topics that are shared."""
        if not self._sharing:
            return []
        topics = ", ".join(map(self._full, self._role.shared))
        return [f"{_names(self._sharing)} publishes {topics}, too: it must not publish the joint of this node"]

    # --- claims -------------------------------------------------------------------------------------------------------

    def _take_claims(self) -> None:
        """Hear the claims that have arrived; before the executor runs, nobody else takes them."""
        while (taken := self._subscription.handle.take_message(String, False)) is not None:
            self._hear(taken[0])

    def _hear(self, message: String) -> None:
        try:
            claim = Claim(**json.loads(message.data))
        except (ValueError, TypeError):  # anybody may publish anything
            return
        if claim.key in (self._own.key, *self._others):
            return
        self._others[claim.key] = claim
        if self._settled and claim < self._own:
            self._node.fail(self._refusal({claim.node}))
        elif self._settled:
            self._node.get_logger().error(
                f"{claim.node} was started as a second {self._role.name} in namespace "
                f"{self._node.get_namespace()}; it came later and has to end"
            )

    def _require_first(self) -> None:
        earlier = {claim.node for claim in self._others.values() if claim < self._own}
        if earlier:
            self._deliver()
            raise self._refusal(earlier)

    def _deliver(self) -> None:
        """Wait until the earlier nodes have this node's claim: its discovery may take longer."""
        end = time.monotonic() + WAIT_FOR_CLAIM
        while self._claims.get_subscription_count() < 1 + len(self._others) and time.monotonic() < end:
            time.sleep(POLL)
        self._claims.wait_for_all_acked(Duration(seconds=max(end - time.monotonic(), POLL)))

    # --- publishers ---------------------------------------------------------------------------------------------------

    def look(self) -> None:
        """Find out who publishes now; called once a second, and before something depends on it."""
        before, self._found = self._found, self._publishing(self._role.topics)
        self._sharing = self._publishing(self._role.shared) - self._found
        if self._found - before:
            self._node.get_logger().error(self._sentence(self._found))

    def _publishing(self, topics: Iterable[str]) -> set[str]:
        """Full names of the other nodes that publish `topics`, without those whose later claim makes them end."""
        found: set[str] = set()
        for topic in map(self._full, topics):
            if self._node.count_publishers(topic) > self._settled:
                infos = self._node.get_publishers_info_by_topic(topic)
                names = Counter(_name(one.node_namespace, one.node_name) for one in infos)
                names[self._own.node] -= self._settled
                found |= set(+names)
        return found if self._settled else found - {claim.node for claim in self._others.values()}

    def _full(self, topic: str) -> str:
        return str(self._node.resolve_topic_name(topic))

    # --- sentences ----------------------------------------------------------------------------------------------------

    def _sentence(self, nodes: set[str]) -> str:
        topics = ", ".join(map(self._full, self._role.topics))
        return f"{_names(nodes)} publishes {topics}, too: there can be one {self._role.name} in a namespace"

    def _refusal(self, nodes: set[str]) -> UsageError:
        space = self._node.get_namespace()
        free = "/cylinder_2" if space != "/cylinder_2" else "/cylinder_3"
        return UsageError(
            f"{_names(nodes)} is already the {self._role.name} in namespace {space}; stop it, or choose another "
            f"namespace: --ros-args -r __ns:={free}"
        )


def _name(namespace: str, name: str) -> str:
    """Full name of a node; the middleware learns of a publisher before it learns the name of its node."""
    return UNNAMED if name == UNKNOWN else f"{namespace.rstrip('/')}/{name}"


def _names(nodes: set[str]) -> str:
    return " and ".join(sorted(nodes))
