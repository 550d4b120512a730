"""Command line of the identification."""

from collections.abc import Sequence

from pneumo_ros.axis.identification.settings import SETTINGS
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.identification.node import Identification
from pneumo_ros.ros.run import run


def main(args: Sequence[str] | None = None) -> int:
    """Run the node; returns the exit code of the process."""
    given = parse("identification", "Identify a machine from recordings.", SETTINGS, args, effects=True)
    return run(lambda: [Identification(given.effects)], "identification", given.ros)
