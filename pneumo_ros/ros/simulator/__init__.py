"""`ros2 run pneumo_ros simulator`: the plant as a node."""

from pneumo_ros.ros.simulator.entry import main

__all__ = ["main"]
