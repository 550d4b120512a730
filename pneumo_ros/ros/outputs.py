"""Publishers for the topics of a recording: the name under which each is played, and whether it can be played."""

from collections.abc import Iterable

from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, ReliabilityPolicy

from pneumo_ros.errors import PneumoError
from pneumo_ros.records.bag import is_latched
from pneumo_ros.records.block import Channel
from pneumo_ros.records.contract import GLOBAL_TYPES, split
from pneumo_ros.records.message_types import channel_types, same_fields, types_of
from pneumo_ros.ros.message_classes import definition, message_class
from pneumo_ros.ros.qos import ACKNOWLEDGED, LATCHED

REPLAY = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)  # bursts must not overflow the queue


class Outputs:
    """Publishers by recorded topic. Topics that cannot be played are left out with a warning."""

    def __init__(self, node: Node, channels: Iterable[Channel]) -> None:
        self._node = node
        self._publishers: dict[str, Publisher] = {}
        channels = list(channels)
        axes = {found[0] for one in channels if (found := split(one.topic))}
        for channel in channels:
            name = played_name(channel.topic, node.get_namespace(), len(axes) > 1)
            try:
                self._publishers[channel.topic] = self._publisher(channel, name)
            except (PneumoError, InvalidTopicNameException) as error:
                node.get_logger().warning(f"{channel.topic} is not played: {error}")

    def __contains__(self, topic: str) -> bool:
        return topic in self._publishers

    @property
    def names(self) -> list[str]:
        """Names under which topics are played."""
        return [publisher.topic_name for publisher in self._publishers.values()]

    def name(self, topic: str) -> str:
        """Name under which a recorded topic is played."""
        return str(self._publishers[topic].topic_name)

    def send(self, topic: str, payload: bytes) -> None:
        """Publish one message of a recorded topic."""
        self._publishers[topic].publish(payload)

    def heard(self) -> bool:
        """Whether every topic has a subscriber."""
        return all(publisher.get_subscription_count() for publisher in self._publishers.values())

    def flush(self) -> None:
        """Wait until reliable subscribers have everything."""
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(ACKNOWLEDGED)

    def _publisher(self, channel: Channel, name: str) -> Publisher:
        """Raises UsageError or DataError when the type is not installed, or has other fields than in the recording."""
        kind = message_class(channel.type)
        installed = types_of(channel.type, "ros2msg", definition(channel.type))
        if not same_fields(channel_types(channel), installed, channel.type):
            raise PneumoError(f"{channel.type} was recorded with other fields than those installed here")
        return self._node.create_publisher(kind, name, LATCHED if is_latched(channel) else REPLAY)


def played_name(topic: str, namespace: str, several_axes: bool) -> str:
    """Name under which a recorded topic is played by a node in `namespace`.

    In the root namespace that is the recorded name. In another one, the topics of the axis move there; with several
    axes in the recording they keep their own namespaces below it. Global topics stay where they are.
    """
    found = split(topic)
    if namespace == "/":
        return "/" + topic.lstrip("/")
    if topic in GLOBAL_TYPES or found is None:
        return topic
    inner, name = found
    return f"{inner}/{name}" if several_axes and inner else name
