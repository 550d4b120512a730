"""A plant without dynamics: joint states at a steady rate, and how long each waits for its valve command."""

import threading
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from processes import REFERENCE, cpu_seconds, nodes

Array = NDArray[np.float64]
PATIENCE = 0.1  # s


class Asking:
    """Sends joint states of a piston that moves along a sine, in the ROS domain that the environment names."""

    def __init__(self, rate: float) -> None:
        """`rate` [Hz] of the joint states."""
        import rclpy
        from rclpy.qos import QoSProfile
        from sensor_msgs.msg import JointState
        from std_msgs.msg import Float64

        from pneumo_ros.axis.priority import take_priority
        from pneumo_ros.ros import messages
        from pneumo_ros.ros.run import make_executor

        self._node, self._rate = rclpy.create_node("asking"), rate
        self._message = messages.joint_state("piston")
        self._publisher = self._node.create_publisher(JointState, "joint_states", QoSProfile(depth=10))
        self._node.create_subscription(Float64, "valve/command", self._answer, QoSProfile(depth=1000), raw=True)
        self._executor: Any = make_executor()
        self._executor.add_node(self._node)
        self._answered, self._arrival = threading.Event(), 0
        self._over = False
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()
        self.priority = take_priority(10)

    def _spin(self) -> None:
        from rclpy.task import Future

        while not self._over:
            self._executor.spin_until_future_complete(Future(), timeout_sec=0.2)

    def _answer(self, data: bytes) -> None:
        self._arrival = time.monotonic_ns()
        self._answered.set()

    def ready(self) -> bool:
        """Whether a controller receives joint states and answers."""
        heard, count = self._publisher.get_subscription_count(), self._node.count_publishers("valve/command")
        return bool(heard and count)

    def ask(self, seconds: float) -> tuple[Array, int, float]:
        """Waiting times [s] of joint states sent for `seconds`, how many got no answer in time, and their rate [Hz].

        The next one is sent when it is due and the one before is answered or given up: so the cause of every command
        is known. Joint states that a busy machine sends late are not made up for.
        """
        waits, lost, begin = [], 0, time.monotonic_ns()
        deadline, end = begin, begin + round(seconds * 1e9)
        while (now := time.monotonic_ns()) < end:
            deadline = max(deadline + round(1e9 / self._rate), now)
            time.sleep((deadline - now) * 1e-9)
            position = 0.1 * float(np.sin(1e-9 * (deadline - begin)))
            self._answered.clear()
            sent = time.monotonic_ns()
            self._publisher.publish(self._message.fill(time.time_ns(), position, 0.1, 0.0))
            if self._answered.wait(PATIENCE):
                waits.append(self._arrival - sent)
            else:
                lost += 1
        return np.array(waits) * 1e-9, lost, (len(waits) + lost) / seconds

    def close(self) -> None:
        """End the node."""
        self._over = True
        self._thread.join()
        self._node.destroy_node()


def answers(seconds: float, rate: float) -> None:
    """Print how long valve commands take, law by law, and what the controller needs for it."""
    from pneumo_ros.axis.controller.settings import LAWS

    asking = Asking(rate)
    print(f"\nAnswers at {rate:g} Hz, {seconds:g} s each; target: p99 under 3 ms, controller under 25 %\n")
    print(f"{'':34} {'p50':>9} {'p99':>9} {'largest':>9} {'unanswered':>11} {'rate':>8} {'controller':>11}")
    for law in LAWS:
        # the 0 V that follows a silence must not count as an answer; and no simulator says what closes the valve
        patient = ("-p", "measurement_timeout:=10.0", "-p", "closed_signal:=0V")
        with nodes(("controller", *REFERENCE, *patient, "-p", f"law:={law}")) as pids:
            while not asking.ready():
                time.sleep(0.1)
            asking.ask(2.0)
            before, begin = cpu_seconds(pids[0]), time.monotonic()
            waits, lost, reached = asking.ask(seconds)
            share = (cpu_seconds(pids[0]) - before) / (time.monotonic() - begin)
        p50, p99 = 1e3 * np.percentile(waits, (50, 99))
        columns = f"{p50:6.2f} ms {p99:6.2f} ms {1e3 * waits.max():6.2f} ms {lost:11} {reached:5.0f} Hz {share:11.1%}"
        print(f"{law:34} {columns}", flush=True)
        while asking.ready():  # a late answer must not count as one to the next joint state
            time.sleep(0.1)
    asking.close()
