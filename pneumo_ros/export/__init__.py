"""Machines elsewhere: the kernel's step as C99 for controllers, and as functional mock-up units; mechanisms as MJCF."""

from pneumo_ros.export.c_files import c_files
from pneumo_ros.export.fmu import fmu_archive
from pneumo_ros.export.machine import Exported

__all__ = ["Exported", "c_files", "fmu_archive"]
