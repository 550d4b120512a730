"""Command line of the commissioning."""

from collections.abc import Sequence

from pneumo_ros.axis.commission.settings import SETTINGS
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.commission.node import Commission
from pneumo_ros.ros.run import run


def main(args: Sequence[str] | None = None) -> int:
    """Run the node; returns the exit code of the process."""
    given = parse("commission", "Take a new axis from its data sheet to a machine file.", SETTINGS, args, effects=True)
    return run(lambda: [Commission(given.effects)], "commission", given.ros)
