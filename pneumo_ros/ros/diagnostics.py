"""/diagnostics at 1 Hz: one status per node, from what the node says about itself."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node

PERIOD = 1.0  # s


@dataclass
class Health:
    """What a node says about itself: numbers by name (units in the names), warnings and errors as sentences."""

    values: Mapping[str, object] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    @property
    def level(self) -> bytes:
        """OK, WARN or ERROR of DiagnosticStatus."""
        if self.errors:
            return DiagnosticStatus.ERROR
        return DiagnosticStatus.WARN if self.warnings else DiagnosticStatus.OK

    @property
    def message(self) -> str:
        """All sentences, errors first; "running" if there are none."""
        return "; ".join([*self.errors, *self.warnings]) or "running"


class Diagnostics:
    """Publishes what `health` returns, every second of the wall's time, paused or not."""

    def __init__(self, node: Node, health: Callable[[], Health]) -> None:
        self._node, self._health = node, health
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_timer(PERIOD, self.publish, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def publish(self) -> None:
        """Publish now."""
        health = self._health()
        status = DiagnosticStatus(
            level=health.level,
            name=self._node.get_fully_qualified_name().lstrip("/"),
            message=health.message,
            hardware_id=self._node.get_namespace(),
            values=[KeyValue(key=key, value=_text(value)) for key, value in health.values.items()],
        )
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)


def _text(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
