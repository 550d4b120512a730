"""The `description` topic: the machine, sent often enough for every recording to contain it."""

import json
from collections.abc import Callable, Mapping

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from std_msgs.msg import String

from pneumo_ros import __version__
from pneumo_ros.records.contract import DESCRIPTION
from pneumo_ros.ros.qos import LATCHED

SCHEMA_VERSION = 1
PERIOD = 10.0  # s; players that start in the middle of a bag skip latched messages


def describe(machine: Mapping[str, object], seed: int) -> dict[str, object]:
    """Content of the topic for a machine file as a dictionary and the seed of the noise."""
    return {"schema_version": SCHEMA_VERSION, "model": dict(machine), "package_version": __version__, "seed": seed}


class Description:
    """Publishes what `content` returns (see `describe`) as JSON, latched and every 10 s."""

    def __init__(self, node: Node, content: Callable[[], Mapping[str, object]]) -> None:
        self._content = content
        self._publisher = node.create_publisher(String, DESCRIPTION, LATCHED)
        node.create_timer(PERIOD, self.publish, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.publish()

    def publish(self) -> None:
        """Publish now: at the start and after every change."""
        self._publisher.publish(String(data=json.dumps(self._content())))
