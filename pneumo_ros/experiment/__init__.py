"""Programmes of trials, which of them separate two effects, and how a live plant is taken through one. No ROS."""
