"""Messages as bytes, straight from the middleware's queues, at a tenth of an executor's cost.

The middleware's own thread puts messages into a deep queue and notes when each arrived, so nothing depends on how soon
they are fetched. The sequence numbers of the publishers show how many messages never arrived.
"""

import time
from typing import Any, NamedTuple

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pneumo_ros.axis.losses import LossCount
from pneumo_ros.ros.message_classes import message_class

EARLY = 3.0  # s, in which publishers that were there before are discovered; 2.8 s where an announcement is lost
DEPTH = 5000  # messages of one topic that may wait: 5 s at 1 kHz

_PROCESS = 12  # bytes of a publisher's identity that its process has (DDSI-RTPS: 12 of 16 are the participant's)
# A best-effort subscriber hears every publisher. Latched messages come only to reliable, transient local subscribers.
_PLAIN = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
_LATCHED = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Taken(NamedTuple):
    """One message as it arrived; times of the system clock in ns."""

    received: int
    topic: str
    payload: bytes
    published: int


class Intake:
    """Subscriptions whose messages `take` fetches; no executor serves them."""

    def __init__(self, owner: Node) -> None:
        """Topics are named as `owner` would name them."""
        self._owner = owner
        # No executor spins this node: it would take the messages itself and give no time of arrival.
        self._node = Node(
            f"_{owner.get_name()}_intake",
            namespace=owner.get_namespace(),
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._subscriptions: dict[str, Subscription] = {}
        self._losses: dict[str, LossCount] = {}
        self._early: set[bytes] = set()  # publishers that were there before
        self._began = time.monotonic()
        self.types: dict[str, str] = {}
        self._latched: set[str] = set()

    def subscribe(self, topic: str, message_type: str, latched: bool) -> None:
        """Subscribe to `topic` (a full name), or change it. Raises UsageError when its type is not installed."""
        kind = message_class(message_type)
        if topic in self._subscriptions:
            self._node.destroy_subscription(self._subscriptions[topic])
        profile = _LATCHED if latched else _PLAIN
        self._subscriptions[topic] = self._node.create_subscription(kind, topic, _unused, profile, raw=True)
        self._losses.setdefault(topic, LossCount())
        self.meet(topic)
        self.types[topic] = message_type
        (self._latched.add if latched else self._latched.discard)(topic)

    def meet(self, topic: str) -> None:
        """Note the publishers of `topic` that are there while this begins: some of their messages came before."""
        if time.monotonic() - self._began < EARLY:
            offered = self._owner.get_publishers_info_by_topic(topic)
            self._early |= {bytes(one.endpoint_gid) for one in offered}

    def relax(self) -> None:
        """Subscribe as volatile to topics that should be latched, but whose publishers do not latch them."""
        for topic in self._subscriptions:
            self.meet(topic)
        for topic in list(self._latched):
            offered = self._owner.get_publishers_info_by_topic(topic)
            if offered and not any(latches(one.qos_profile) for one in offered):
                self.subscribe(topic, self.types[topic], False)

    def take(self) -> list[Taken]:
        """Everything that has arrived, topic by topic."""
        taken: list[Taken] = []
        settled = time.monotonic() - self._began > EARLY
        for topic, subscription in self._subscriptions.items():
            loss, fetch, kind = self._losses[topic], subscription.handle.take_message, subscription.msg_type
            while (found := fetch(kind, True)) is not None:
                payload, info = found
                publisher = _publisher(info)
                later = settled and bool(publisher) and bool(self._early) and not self._is_early(publisher)
                loss.note(publisher, info["publication_sequence_number"], began_later=later)
                taken.append(Taken(info["received_timestamp"], topic, payload, info["source_timestamp"]))
        return taken

    def _is_early(self, publisher: bytes) -> bool:
        """Whether its process was there before: on a busy machine a second topic of it is discovered later."""
        return any(publisher[:_PROCESS] == one[:_PROCESS] for one in self._early)

    @property
    def lost(self) -> dict[str, int]:
        """How many messages are known to be lost, on the topics where any are."""
        return {topic: loss.lost for topic, loss in self._losses.items() if loss.lost}

    def close(self) -> None:
        """End all subscriptions."""
        self._subscriptions.clear()
        self._node.destroy_node()


def latches(profile: QoSProfile) -> bool:
    """Whether a publisher with `profile` keeps its last messages for late subscribers."""
    return profile.durability == DurabilityPolicy.TRANSIENT_LOCAL


def _publisher(info: dict[str, Any]) -> bytes:
    """Which publisher a message came from; the same for all where rclpy does not report it."""
    return bytes((info.get("publisher_gid") or {}).get("data", b""))


def _unused(message: bytes) -> None:
    """Callback of subscriptions that no executor serves."""
