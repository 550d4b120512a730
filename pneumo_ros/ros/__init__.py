"""The nodes: the only place that imports rclpy. Importing it without ROS 2 says in one sentence how to get it."""

import sys
from pathlib import Path

from pneumo_ros.environment import MissingDependencyError, require_ros

_EXECUTABLES = ("simulator", "controller", "axis", "recorder", "player", "experiment", "identification", "commission")

try:
    require_ros()
except MissingDependencyError as absent:
    # While `python -m` imports this package, argv[0] is "-m"; a program that merely imports it gets the exception.
    if Path(sys.argv[0]).name in (*_EXECUTABLES, "-m"):
        print(f"pneumo_ros: error: {absent}", file=sys.stderr)
        raise SystemExit(absent.exit_code) from None
    raise
