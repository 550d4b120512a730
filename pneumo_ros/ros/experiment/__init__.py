"""`ros2 run pneumo_ros experiment`: takes a plant through a programme of trials and records each."""

from collections.abc import Sequence

from pneumo_ros.axis.stopping import listen_for_signals


def main(args: Sequence[str] | None = None) -> int:
    """Run the experiment; returns the exit code of the process."""
    listen_for_signals()
    from pneumo_ros.ros.experiment.entry import main as run_node

    return run_node(args)
