"""Recordings of several axes: each is found by its prefix, with the supply that they share."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import read_recording
from pneumo_ros.records.writing import write_axes

TIME = np.arange(50) * 1e-3
GAS = np.full(50, 3e5)


def one(position: float) -> dict[str, np.ndarray]:
    """What is recorded of one axis."""
    return {
        "time": TIME,
        "position": position + 0.01 * TIME,
        "pressure_a": GAS,
        "pressure_b": GAS,
        "voltage": 0.0 * TIME,
    }


def test_an_axis_is_found_below_any_namespace_with_the_shared_supply(tmp_path: Path) -> None:
    supply = 7e5 - 1e4 * TIME
    axes = {"shoulder": one(0.1), "elbow": {**one(-0.2), "supply_pressure": GAS}}
    write_axes(tmp_path / "run", axes, supply_pressure=supply, namespace="robot")
    shoulder = read_recording(tmp_path / "run", "shoulder")
    assert (shoulder.namespace, shoulder.joint_name) == ("robot/shoulder", "shoulder")
    np.testing.assert_array_equal(shoulder.supply_pressure, supply)
    elbow = read_recording(tmp_path / "run", "/robot/elbow")
    np.testing.assert_array_equal(elbow.supply_pressure, GAS)  # its own counts more
    np.testing.assert_array_equal(elbow.position, axes["elbow"]["position"])
    with pytest.raises(DataError, match="did you mean /robot/elbow"):
        read_recording(tmp_path / "run", "/robot/elbo")


def test_shapes_are_checked(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="supply_pressure has shape"):
        write_axes(tmp_path / "run", {"a": one(0.0)}, supply_pressure=GAS[:3])
    with pytest.raises(UsageError, match="at least one axis"):
        write_axes(tmp_path / "run", {})
    assert not (tmp_path / "run").exists()
