"""Command line of the simulator."""

import sys
from collections.abc import Sequence

from pneumo_ros.axis.simulator.settings import FIXED, LIVE
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.run import run
from pneumo_ros.ros.simulator.several import simulators

SWITCH_INTERVAL = 5e-4  # s; Python's own 5 ms would let a busy callback make the next tick late


def main(args: Sequence[str] | None = None) -> int:
    """Run the simulator; returns the exit code of the process."""
    given = parse(
        "simulator",
        "Simulate a pneumatic axis, or several on one supply, as ROS 2 nodes.",
        [*FIXED, *LIVE],
        args,
        effects=True,
    )
    sys.setswitchinterval(SWITCH_INTERVAL)
    return run(lambda: simulators(given.effects, given.ros), "simulator", given.ros)
