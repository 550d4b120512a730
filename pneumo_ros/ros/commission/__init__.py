"""`ros2 run pneumo_ros commission`: takes a new axis from its data sheet to a machine file."""

from collections.abc import Sequence

from pneumo_ros.axis.stopping import listen_for_signals


def main(args: Sequence[str] | None = None) -> int:
    """Run the commissioning; returns the exit code of the process."""
    listen_for_signals()
    from pneumo_ros.ros.commission.entry import main as run_node

    return run_node(args)
