"""The MJCF of a machine, with its cylinder attached as its comment says, moves as the plant does."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.export.mjcf import mjcf_text
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
LOADED = AXIS.with_effects(
    [*AXIS.effects, "constant_load", "payload_mass"], {"constant_load.load": 40.0, "payload_mass.mass_added": 3.0}
)
VOLTS = 3.0 * np.sin(3.0 * np.arange(1000) * 1e-3)


@pytest.mark.parametrize("model", [AXIS, LOADED], ids=["axis", "loaded"])
def test_it_moves_as_the_plant(model: object, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="comes with the mujoco extra")
    from pneumo_ros.couple.mujoco import Cylinders, Mount

    (tmp_path / "axis.xml").write_text(mjcf_text(model, "axis"))
    arm = mujoco.MjModel.from_xml_path(str(tmp_path / "axis.xml"))
    data = mujoco.MjData(arm)
    cylinders = Cylinders(arm, data, {"axis": Mount(model, joint="piston")})
    expected = model.simulate(VOLTS, model.state())
    for k, volts in enumerate(VOLTS):
        cylinders.step({"axis": float(volts)})
        assert data.qpos[0] == pytest.approx(expected[k, 0], abs=1e-4)  # dt v/2
    assert float(np.ptp(expected[:, 0])) > 0.02


def test_what_a_slide_joint_is_not_is_refused() -> None:
    with pytest.raises(UsageError, match="load_compliance, which a slide joint is not"):
        mjcf_text(AXIS.with_effects([*AXIS.effects, "load_compliance"]), "axis")
    with pytest.raises(UsageError, match="has no chambers"):
        mjcf_text(load_model("emps"), "emps")
