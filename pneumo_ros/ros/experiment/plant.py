"""The plant as its topics show it: missing topics, and topics that have stopped."""

import time
from collections.abc import Mapping

from rclpy.node import Node
from rclpy.publisher import Publisher

from pneumo_ros.records.contract import JOINT_STATES, PRESSURE_A, PRESSURE_B

PRESSURES = (PRESSURE_A, PRESSURE_B)


class Plant:
    """Checks a plant before and during an experiment."""

    def __init__(self, node: Node, heard: Mapping[str, float], commands: Publisher) -> None:
        """`heard`: when each of the contract's topics was last heard [s, monotonic]; `commands` drives the valve."""
        self.other_joints: list[str] = []  # joints of joint states that lack the wanted joint
        self._node, self._heard, self._commands = node, heard, commands

    def missing(self, placed: bool) -> str:
        """A sentence on what is missing, empty when the plant is complete; `placed`: positions have arrived."""
        if not placed:
            return self._no_joint()
        silent = [self._node.resolve_topic_name(name) for name in PRESSURES if name not in self._heard]
        if silent:
            return f"no message on {' and '.join(silent)}: without both pressures the recordings would be of no use"
        if not self._commands.get_subscription_count():
            return f"no node subscribes to {self._commands.topic_name}: start the simulator, or the driver of the valve"
        return ""

    def silent(self, timeout: float, placed: float) -> str:
        """The topic without a new message for `timeout` [s], empty if none; `placed`: last position [s, monotonic]."""
        now = time.monotonic()
        if now - placed > timeout:
            return f"new {JOINT_STATES}"
        return next((name for name in PRESSURES if now - self._heard[name] > timeout), "")

    def _no_joint(self) -> str:
        topic = self._node.resolve_topic_name(JOINT_STATES)
        if self.other_joints:
            return f"{topic} holds no position of the joint wanted, but of: {', '.join(self.other_joints)}"
        there = [name for name, _ in self._node.get_topic_names_and_types() if name.endswith(f"/{JOINT_STATES}")]
        others = [name for name in there if name != topic and self._node.count_publishers(name)]
        if others:
            spaces = ", ".join(name.removesuffix(f"/{JOINT_STATES}") or "/" for name in others)
            return f"no message on {topic}, but there is an axis in the namespace {spaces}; choose it as namespace"
        return f"no message on {topic}: start the simulator, or the driver of the rig"
