"""Nodes run on the ordinary executor where rclpy has no EventsExecutor, and end though the middleware hangs."""

import signal
from pathlib import Path

from ros.probe import probe
from ros.processes import running

PROGRAM = """
import sys
sys.modules["rclpy.experimental"] = None
from pneumo_ros.ros import run
from pneumo_ros.ros.simulator import main
assert run.EventsExecutor is None
sys.exit(main(sys.argv[1:]))
"""


def test_the_simulator_runs_and_ends_on_the_ordinary_executor(tmp_path: Path) -> None:
    with running("-c", PROGRAM, "--ros-args", "-r", "__ns:=/old", cwd=tmp_path) as process, probe("old") as one:
        one.matched(one.command)

        def moving() -> bool:
            one.send(2.0, 0.05)
            return bool(one.heard["joint_states"]) and one.heard["joint_states"][-1].velocity[0] > 0.05

        one.wait(moving, "motion")
        assert one.set("simulator", piston__mass=6.0) == (True, "")
        assert process.end(signal.SIGTERM) == 0, process.said


HANGS = """
import sys, time
from pneumo_ros.ros import run
from pneumo_ros.ros.simulator import main
from pneumo_ros.ros.simulator.node import Simulator
run.LETS_GO = 1.0
Simulator.destroy_node = lambda node: time.sleep(1e6)
sys.exit(main(sys.argv[1:]))
"""


def test_a_node_ends_though_the_middleware_does_not_let_it_go(tmp_path: Path) -> None:
    """A controller once ran on at full load after Ctrl-C, inside Fast DDS."""
    with running("-c", HANGS, "--ros-args", "-r", "__ns:=/held", cwd=tmp_path) as process, probe("held") as one:
        one.more("joint_states", 10)
        assert process.end(signal.SIGINT) == 1
        assert "Timeout" in process.said
