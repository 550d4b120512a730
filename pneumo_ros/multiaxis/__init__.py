"""Machines of several axes on one supply: their files, one kernel for all, and the supply that they share."""

from pneumo_ros.multiaxis.machine import Machine
from pneumo_ros.multiaxis.machine_file import load_machine, machine_text

__all__ = ["Machine", "load_machine", "machine_text"]
