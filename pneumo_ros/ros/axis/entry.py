"""Simulator and controller in one process, the fastest lockstep.

They are the same nodes with the same topics; in one process their messages need not wait for the operating system.
"""

import sys
from collections.abc import Sequence

from pneumo_ros.axis.controller import settings as controller_settings
from pneumo_ros.axis.simulator import settings as simulator_settings
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.controller.node import Controller
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.run import run
from pneumo_ros.ros.simulator.entry import SWITCH_INTERVAL
from pneumo_ros.ros.simulator.node import Simulator
from pneumo_ros.ros.simulator.several import has_axes

_SIMULATORS = [*simulator_settings.FIXED, *simulator_settings.LIVE]


def main(args: Sequence[str] | None = None) -> int:
    """Run both nodes; returns the exit code of the process."""
    settings = {setting.name: setting for setting in (*_SIMULATORS, *controller_settings.SETTINGS)}
    given = parse("axis", "Simulate and control the pneumatic axis.", settings.values(), args, effects=True)
    sys.setswitchinterval(SWITCH_INTERVAL)
    return run(lambda: _nodes(given.effects), "axis", given.ros)


def _nodes(effects_files: Sequence[str]) -> list[AxisNode]:
    """Both nodes; both are given all parameters, and each ignores those of the other."""
    if has_axes():
        raise UsageError("axis is simulator and controller of one axis; start a simulator, which moves all, and a "
                         "controller in the namespace of each, such as -r __ns:=/lift")  # fmt: skip
    theirs = {setting.name for setting in controller_settings.SETTINGS} - controller_settings.OF_THE_MACHINE
    simulator = Simulator(effects_files, lambda name: name in theirs)
    clock = simulator.simulated_clock  # it stops when the plant pauses; /clock would halve the speed
    return [simulator, Controller(lambda name: name in simulator.parameters, clock, simulated=True)]
