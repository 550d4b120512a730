"""`ros2 run pneumo_ros simulator`: the plant as a node."""

from collections.abc import Sequence

from pneumo_ros.axis.stopping import listen_for_signals


def main(args: Sequence[str] | None = None) -> int:
    """Run the simulator; returns the exit code of the process."""
    listen_for_signals()
    from pneumo_ros.ros.simulator.entry import main as run_node

    return run_node(args)
