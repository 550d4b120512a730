"""Command line of the controller."""

from collections.abc import Sequence

from pneumo_ros.axis.controller.settings import SETTINGS
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.controller.node import Controller
from pneumo_ros.ros.run import run


def main(args: Sequence[str] | None = None) -> int:
    """Run the controller; returns the exit code of the process."""
    given = parse("controller", "Control the position of the pneumatic axis as a ROS 2 node.", SETTINGS, args)
    return run(lambda: [Controller()], "controller", given.ros)
