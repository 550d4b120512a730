"""`ros2 run pneumo_ros axis`: simulator and controller in one process."""

from collections.abc import Sequence

from pneumo_ros.axis.stopping import listen_for_signals


def main(args: Sequence[str] | None = None) -> int:
    """Run both nodes; returns the exit code of the process."""
    listen_for_signals()
    from pneumo_ros.ros.axis.entry import main as run_node

    return run_node(args)
