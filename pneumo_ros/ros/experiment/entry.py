"""Command line of the experiment."""

from collections.abc import Sequence

from pneumo_ros.axis.experiment.settings import SETTINGS
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.experiment.node import Experiment
from pneumo_ros.ros.run import run


def main(args: Sequence[str] | None = None) -> int:
    """Run the node; returns the exit code of the process."""
    given = parse("experiment", "Take a plant through trials and record each.", SETTINGS, args, effects=True)
    return run(lambda: [Experiment(given.effects)], "experiment", given.ros)
