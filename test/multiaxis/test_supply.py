"""The pressure of a shared supply, computed from what all axes draw along their measured motion."""

from pathlib import Path

import numpy as np
import pytest
from multiaxis.machines import STEP, Array, record, two

from pneumo_ros.multiaxis import Machine
from pneumo_ros.multiaxis.supply import Timed, supplied
from pneumo_ros.reading.read import ReadOptions, read_run
from pneumo_ros.records import read_recording
from pneumo_ros.records.writing import write_axes


def timed(machine: Machine, path: Path) -> dict[str, Timed]:
    """All axes of a recording."""
    found = {}
    for name, model in machine.axes.items():
        reading = read_run(path, model, ReadOptions(namespace=name))
        found[name] = Timed(1e-9 * reading.recording.start_ns, reading.run, model)
    return found


def from_the_middle(machine: Machine, path: Path, skip: float) -> Array:
    """A recording of 4 s that begins `skip` [s] after the start; the supply's drop at its samples (n,) [Pa]."""
    states = record(machine, path.with_name("whole"), 3, 4.0 + skip)
    first, recordings = round(skip / STEP), {}
    for axis, own in machine.split(states[first:]).items():
        whole = read_recording(path.with_name("whole"), axis)
        held = np.flatnonzero(whole.time >= skip - 1e-9)
        recordings[axis] = {
            "time": whole.time[held] - whole.time[held[0]], "position": whole.position[held],
            "pressure_a": whole.pressure_a[held], "pressure_b": whole.pressure_b[held], "voltage": whole.voltage[held],
        }  # fmt: skip
        assert len(held) == len(own)
    write_axes(path, recordings)
    return np.asarray(states[first:, -1])


def test_a_start_in_motion_is_left_out_until_it_does_not_matter(tmp_path: Path) -> None:
    """Nobody knows what the axes drew before; a stiff line forgets it sooner than its time constant says."""
    line = {"resistance_supply": 2e8, "time_constant": 0.3}
    machine = two(line)
    drop = from_the_middle(machine, tmp_path / "run", 2.5)
    found = supplied(timed(machine, tmp_path / "run"), line)["elbow"]
    held = found.run.further["measured_supply"].reshape(-1, 10).mean(axis=1)
    off = np.abs(7e5 - held - 0.5 * (drop[:-1] + drop[1:]))
    both = found.run.measured[1:] & found.run.measured[:-1]
    assert off.max() > 1e4  # Pa, at the start
    assert off[both].max() < 1e3
    assert 0.1 < STEP * (~found.run.measured).sum() < 0.9


@pytest.mark.parametrize("resistance", [2e7, 3e8])
def test_the_computed_drop_is_that_of_the_machine(resistance: float, tmp_path: Path) -> None:
    """Also where the drop limits the flow itself: 3e8 Pa s/kg take 3 bar at a third of what the valves would pass."""
    line = {"resistance_supply": resistance, "time_constant": 0.2}
    machine = two(line)
    states = record(machine, tmp_path / "run", 3, 4.0)
    found = supplied(timed(machine, tmp_path / "run"), line)
    drop = states[:, -1]
    for one in found.values():
        assert one.run.measured.all()  # it begins at rest, with a full supply
        assert one.run.computed == {"measured_supply"}
        held = one.run.further["measured_supply"].reshape(-1, 10).mean(axis=1)
        middle = 0.5 * (drop[:-1] + drop[1:])
        np.testing.assert_allclose(7e5 - held[250:], middle[250:], atol=0.02 * drop.max())  # the start is a guess
