"""`ros2 run pneumo_ros controller`: position control as a node."""

from pneumo_ros.ros.controller.entry import main

__all__ = ["main"]
