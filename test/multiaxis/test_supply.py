"""The pressure of a shared supply, computed from what all axes draw along their measured motion."""

from pathlib import Path

import numpy as np
import pytest
from multiaxis.machines import record, two

from pneumo_ros.multiaxis.supply import Timed, supplied
from pneumo_ros.reading.read import ReadOptions, read_run


@pytest.mark.parametrize("resistance", [2e7, 3e8])
def test_the_computed_drop_is_that_of_the_machine(resistance: float, tmp_path: Path) -> None:
    """Also where the drop limits the flow itself: 3e8 Pa s/kg take 3 bar at a third of what the valves would pass."""
    line = {"resistance_supply": resistance, "time_constant": 0.2}
    machine = two(line)
    states = record(machine, tmp_path / "run", 3, 4.0)
    axes = {}
    for name, model in machine.axes.items():
        reading = read_run(tmp_path / "run", model, ReadOptions(namespace=name))
        axes[name] = Timed(1e-9 * reading.recording.start_ns, reading.run, model)
    found = supplied(axes, line)
    drop = states[:, -1]
    for one in found.values():
        assert one.run.computed == {"measured_supply"}
        held = one.run.further["measured_supply"].reshape(-1, 10).mean(axis=1)
        middle = 0.5 * (drop[:-1] + drop[1:])
        np.testing.assert_allclose(7e5 - held[250:], middle[250:], atol=0.02 * drop.max())  # the start is a guess
