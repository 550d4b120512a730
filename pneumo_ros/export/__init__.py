"""Machines elsewhere: the kernel's step as C99 and as functional mock-up units; equations as Modelica; MJCF."""

from pneumo_ros.export.c_files import c_files
from pneumo_ros.export.fmu import fmu_archive
from pneumo_ros.export.machine import Exported
from pneumo_ros.export.modelica import modelica_text

__all__ = ["Exported", "c_files", "fmu_archive", "modelica_text"]
