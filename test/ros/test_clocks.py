"""A controller whose clock and stamps jump."""

import time
from pathlib import Path

from rclpy.qos import QoSProfile
from ros.axis_probe import AxisProbe
from ros.processes import node, running
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState


def test_clocks_that_jump_back_and_forth(tmp_path: Path) -> None:
    """A bag that loops: stamps and /clock go back, then far ahead; in between, silence still closes the valve."""
    command = node("controller", "-r", "__ns:=/loops", use_sim_time=True)
    with running(*command, cwd=tmp_path) as process:
        one = AxisProbe("loops")
        clock = one.publisher(Clock, "/clock", QoSProfile(depth=10))
        joint = one.publisher(JointState, "joint_states")

        def play(begin: float, seconds: float) -> list[float]:
            """Stamps and clock from `begin` [s]; the piston is at rest. Returns the commands so far."""
            have = len(one.heard["valve/command"])
            for tick in range(round(200 * seconds)):
                message, now = JointState(name=["piston"], position=[0.0]), Clock()
                now.clock.sec, now.clock.nanosec = divmod(round((begin + tick / 200) * 1e9), 1_000_000_000)
                message.header.stamp = now.clock
                clock.publish(now)
                joint.publish(message)
                time.sleep(0.002)
            return [message.data for message in one.heard["valve/command"][have:]]

        play(100.0, 0.1)
        for _ in range(3):  # best effort may lose one
            one.aim(0.3)
        for begin in (100.1, 5.0, 1e6, 50.0):
            commands = play(begin, 0.6)
            assert max(commands) > 0.78, process.said
            assert all(0.0 <= volts <= 10.0 for volts in commands)
        for tick in range(40):  # the clock goes on, nothing is measured
            now = Clock()
            now.clock.sec, now.clock.nanosec = 51, 25_000_000 * (tick % 40)
            clock.publish(now)
            time.sleep(0.005)
        one.wait(lambda: one.voltage == 0.0, "0 V")
        one.close()
        assert process.end() == 0
