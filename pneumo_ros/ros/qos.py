"""Quality of service of topics: reliable publishers, best-effort subscribers of sensors, keep last."""

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

# A reliable publisher serves reliable and best-effort subscribers alike; a best-effort subscriber hears both kinds.
PUBLISH = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
SUBSCRIBE = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)  # references and trajectories: each one counts
LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ACKNOWLEDGED = Duration(seconds=1.0)  # longest wait, at the end of a node, for subscribers that lack messages
