"""A plant in the test's own process that moves as set, and fails on request."""

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

RATE = 200.0  # Hz
DEPTH = 1000  # queued messages on a busy machine
TOP = 0.4  # m/s, at any voltage beyond 0.1 V


class ScriptedPlant:
    """Moves at TOP to where the voltage points. Set `position`, `pressure`, `silent` or `reverse` to make it fail."""

    def __init__(self, namespace: str) -> None:
        self.context = Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("scripted", namespace=namespace, context=self.context)
        self.commands: list[float] = []
        self.stamps: list[int] = []  # ns, of what was sent
        self.position, self.pressure, self.reverse = 0.0, 3e5, False
        self.silent: set[str] = set()
        self._joint = self.node.create_publisher(JointState, "joint_states", DEPTH)
        self._pressures = {
            f"chamber_{c}/pressure": self.node.create_publisher(FluidPressure, f"chamber_{c}/pressure", DEPTH)
            for c in "ab"
        }
        self.node.create_subscription(Float64, "valve/command", lambda one: self.commands.append(one.data), 10)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._ended = threading.Event()
        self._threads = [threading.Thread(target=target, daemon=True) for target in (self._spin, self._run)]
        for thread in self._threads:
            thread.start()

    def _spin(self) -> None:
        while not self._ended.is_set():
            self._executor.spin_once(timeout_sec=0.1)

    def _run(self) -> None:
        while not self._ended.wait(1.0 / RATE):
            volts = self.commands[-1] if self.commands else 0.0
            if abs(volts) > 0.1:
                self.position += math.copysign(TOP / RATE, volts) * (-1 if self.reverse else 1)
            self._send()

    def _send(self) -> None:
        now = self.node.get_clock().now()
        self.stamps.append(now.nanoseconds)
        stamp = now.to_msg()
        for topic, publisher in self._pressures.items():
            message = FluidPressure(fluid_pressure=self.pressure)
            message.header.stamp = stamp
            if topic not in self.silent:
                publisher.publish(message)
        message = JointState(name=["piston"], position=[self.position])
        message.header.stamp = stamp
        if "joint_states" not in self.silent:
            self._joint.publish(message)

    def moving(self) -> bool:
        """Whether the last command opens the valve."""
        return bool(self.commands) and abs(self.commands[-1]) > 0.1

    def close(self) -> None:
        """End the node."""
        self._ended.set()
        for thread in self._threads:
            thread.join(10.0)
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.shutdown()


@contextmanager
def scripted_plant(namespace: str) -> Iterator[ScriptedPlant]:
    """A plant that ends with the block."""
    plant = ScriptedPlant(namespace)
    try:
        yield plant
    finally:
        plant.close()


def until(condition: object, what: str, seconds: float = 30.0) -> None:
    """Wait until `condition`, a function, holds."""
    end = time.monotonic() + seconds
    while not condition():  # type: ignore[operator]  # callers give functions
        assert time.monotonic() < end, f"in {seconds} s never: {what}"
        time.sleep(0.005)
