"""All axes of the recordings of a command: what each drew from the supply that they share."""

import argparse
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pneumo_ros.command.axes_playing import namespace_of
from pneumo_ros.multiaxis.drawing import MEASURED
from pneumo_ros.multiaxis.supply import Timed, supplied

if TYPE_CHECKING:
    from pneumo_ros.multiaxis import Machine
    from pneumo_ros.reading.read import Reading


class Together:
    """The recordings of a machine of several axes, each axis read once."""

    def __init__(self, machine: "Machine", options: argparse.Namespace) -> None:
        """`options` of `add_recordings`; their namespace is that of the machine."""
        self.machine, self.options = machine, options
        self._read: dict[str, dict[str, Timed]] = {}  # by path and axis

    def supplied(self, usable: "Mapping[str, Reading]") -> "Mapping[str, Reading]":
        """The readings of one axis, with the supply's computed pressure where the machine has a line and no sensor."""
        if self.machine.supply is None:
            return usable
        return {path: self._supplied(path, reading) for path, reading in usable.items()}

    def _supplied(self, path: str, reading: "Reading") -> "Reading":
        if MEASURED in reading.run.further:
            return reading
        axes = self.axes(path)
        mine = reading.recording.namespace.rpartition("/")[2]
        if mine not in axes:
            return reading
        own = Timed(1e-9 * reading.recording.start_ns, reading.run, self.machine.axes[mine])
        return replace(reading, run=supplied({**axes, mine: own}, self.machine.supply or {})[mine].run)

    def axes(self, path: str) -> dict[str, Timed]:
        """Every axis of a recording that draws air, without cuts; DataError where one cannot be read."""
        if path not in self._read:
            self._read[path] = {
                name: self._axis(path, name) for name, one in self.machine.drawing.items() if MEASURED in one.inputs
            }
        return self._read[path]

    def _axis(self, path: str, axis: str) -> Timed:
        from pneumo_ros.command.recordings import read_options
        from pneumo_ros.reading.read import read_run

        how = replace(read_options(self.options), namespace=namespace_of(self.options.namespace, axis))
        reading = read_run(path, self.machine.axes[axis], how)
        return Timed(1e-9 * reading.recording.start_ns, reading.run, self.machine.axes[axis])
