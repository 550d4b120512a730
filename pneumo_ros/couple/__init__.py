"""Cylinders that move somebody else's mechanism: one function for a rigid-body simulator's step, and one for MuJoCo."""

from pneumo_ros.couple.cylinder import Cylinder

__all__ = ["Cylinder"]
