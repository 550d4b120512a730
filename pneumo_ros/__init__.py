"""A pneumatic axis for ROS 2: its plant, control, recordings, and what its model is missing."""

__version__ = "0.1.0"
