"""Whether the node on the other side of a loop of two topics is connected."""

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription


def loop_closed(node: Node, sent: Publisher, heard: Subscription) -> bool:
    """Whether some node hears what `sent` sends and sends what `heard` hears, and all of these are matched."""
    listeners = node.get_subscriptions_info_by_topic(sent.topic_name)
    talkers = node.get_publishers_info_by_topic(heard.topic_name)
    both = {(e.node_namespace, e.node_name) for e in listeners} & {(e.node_namespace, e.node_name) for e in talkers}
    if not both or sent.get_subscription_count() < len(listeners):
        return False
    count = getattr(heard, "get_publisher_count", None)  # not in every rclpy
    return count is None or count() >= len(talkers)
