"""A plant that only asks: joint states at a steady rate, and how long each waits for its valve command."""

import threading
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Asking:
    """Sends joint states of a piston that moves along a sine, in the ROS domain that the environment names by now."""

    def __init__(self, rate: float) -> None:
        """`rate` [Hz] of the joint states."""
        import rclpy
        from rclpy.qos import QoSProfile
        from sensor_msgs.msg import JointState
        from std_msgs.msg import Float64

        from pneumo_ros.ros import messages
        from pneumo_ros.ros.priority import take_priority
        from pneumo_ros.ros.run import make_executor

        self._node, self._rate = rclpy.create_node("asking"), rate
        self._message = messages.joint_state("piston")
        self._publisher = self._node.create_publisher(JointState, "joint_states", QoSProfile(depth=10))
        self._node.create_subscription(Float64, "valve/command", self._answer, QoSProfile(depth=1000), raw=True)
        self._executor: Any = make_executor()
        self._executor.add_node(self._node)
        self.sent: list[int] = []
        self.answered: list[int] = []
        self._over = False
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()
        self.priority = take_priority(10)

    def _spin(self) -> None:
        from rclpy.task import Future

        while not self._over:
            self._executor.spin_until_future_complete(Future(), timeout_sec=0.2)

    def _answer(self, data: bytes) -> None:
        self.answered.append(time.monotonic_ns())

    def ready(self) -> bool:
        """Whether a controller hears and answers."""
        heard, count = self._publisher.get_subscription_count(), self._node.count_publishers("valve/command")
        return bool(heard and count)

    def ask(self, seconds: float) -> tuple[Array, int]:
        """Waiting times [s] of the joint states sent in `seconds`, and how many were never answered.

        The n-th command answers the n-th joint state: the controller sends one for each.
        """
        self.sent.clear()
        self.answered.clear()
        begin, period = time.monotonic_ns(), round(1e9 / self._rate)
        for tick in range(round(seconds * self._rate)):
            time.sleep(max(begin + tick * period - time.monotonic_ns(), 0) * 1e-9)
            stamp, position = time.time_ns(), 0.1 * np.sin(1e-3 * tick)
            self.sent.append(time.monotonic_ns())
            self._publisher.publish(self._message.fill(stamp, float(position), 0.1, 0.0))
        time.sleep(0.5)
        answers = min(len(self.sent), len(self.answered))
        waits = np.array(self.answered[:answers]) - np.array(self.sent[:answers])
        return waits * 1e-9, len(self.sent) - len(self.answered)

    def close(self) -> None:
        """End the node."""
        self._over = True
        self._thread.join()
        self._node.destroy_node()
