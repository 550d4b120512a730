"""`ros2 run pneumo_ros identification`: identifies a machine from recordings as they come in."""

from collections.abc import Sequence

from pneumo_ros.axis.stopping import listen_for_signals


def main(args: Sequence[str] | None = None) -> int:
    """Run the identification; returns the exit code of the process."""
    listen_for_signals()
    from pneumo_ros.ros.identification.entry import main as run_node

    return run_node(args)
