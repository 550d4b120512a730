"""/diagnostics at 1 Hz: one status per node, from what the node reports about itself."""

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

from pneumo_ros.axis.health import Health

PERIOD = 1.0  # s


class Diagnostics:
    """Publishes what `health` returns, every second of wall time, paused or not."""

    def __init__(self, node: Node, health: Callable[[], Health]) -> None:
        self._node, self._health = node, health
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_timer(PERIOD, self.publish, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def publish(self) -> None:
        """Publish now."""
        health = self._health()
        status = DiagnosticStatus(
            level=_level(health),
            name=self._node.get_fully_qualified_name().lstrip("/"),
            message=health.message,
            hardware_id=self._node.get_namespace(),
            values=[KeyValue(key=key, value=_text(value)) for key, value in health.values.items()],
        )
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)


def _level(health: Health) -> bytes:
    if health.errors:
        return DiagnosticStatus.ERROR
    return DiagnosticStatus.WARN if health.warnings else DiagnosticStatus.OK


def _text(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
