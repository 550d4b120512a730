"""The simulator with a single-acting cylinder: one pressure, an effort that knows the open side, and its spring."""

from pathlib import Path

import numpy as np
import pytest
from command.test_single_acting import cylinder
from ros.probe import probe
from ros.processes import node, running

from pneumo_ros.plant import save_model


@pytest.mark.check
def test_the_node_has_the_sensors_of_the_machine(tmp_path: Path) -> None:
    model = cylinder()
    save_model(model, tmp_path / "single.yaml")
    with running(*node("simulator", "--params-file", str(tmp_path / "single.yaml")), cwd=tmp_path), probe() as one:
        one.matched(one.command)
        one.more("joint_states")
        one.send(3.0, 0.5)
        joint, pressure = one.heard["joint_states"], one.heard["chamber_a/pressure"]
        one.wait(lambda: pressure and pressure[-1].fluid_pressure > 2e5, "air in the chamber")
        one.wait(lambda: joint and joint[-1].effort[0] > 30.0, "a force")
        assert not one.heard["chamber_b/pressure"]
        both = {m.header.stamp.sec * 10**9 + m.header.stamp.nanosec: m.fluid_pressure for m in pressure}
        at = [(both.get(m.header.stamp.sec * 10**9 + m.header.stamp.nanosec), m.effort[0]) for m in joint]
        found = [(p, effort) for p, effort in at if p is not None]
        assert len(found) > 10
        for p, effort in found:
            assert effort == pytest.approx(model["piston.area_a"] * (p - 1e5), abs=1e-9)
        assert np.ptp([effort for _, effort in found]) > 10.0
