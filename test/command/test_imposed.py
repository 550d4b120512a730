"""`--imposed`: a test machine imposed the motion, though no map says so; the force is predicted, not the position."""

import json
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.command.main import main
from pneumo_ros.records import write_recording

MACHINE = """\
/**:
  ros__parameters:
    effects: [lugre_friction, viscous_friction]
    piston: {mass: 2.0, area_a: 4.1e-4, area_b: 3.0e-4, stroke: 1.0}
    lugre_friction: {static_friction: 40.0, coulomb_friction: 30.0, stribeck_velocity: 0.01, bristle_stiffness: 1.4e6,
                     bristle_damping: 50.0, breakaway_ratio: 0.9}
    viscous_friction: {coefficient: 100.0}
"""
TIME = np.arange(0.0, 20.0, 2e-3)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a friction rig's recording: its motion, and the force of its load cell, integrated by hand."""
    folder = tmp_path_factory.mktemp("friction_rig")
    random = np.random.default_rng(0)
    velocity = 0.1 * np.sin(2.0 * np.pi * 0.5 * TIME) * (1.0 + 0.3 * np.sin(0.7 * TIME))
    position = np.concatenate([[0.0], np.cumsum(velocity[1:] + velocity[:-1]) * 1e-3])
    slipping = np.sign(velocity) * (30.0 + 10.0 * np.exp(-((velocity / 0.01) ** 2)))
    force = 2.0 * np.gradient(velocity, TIME) + slipping + 100.0 * velocity
    write_recording(
        folder / "friction", time=TIME, position=position + 5e-6 * random.normal(size=len(TIME)),
        load_cell=force + 0.2 * random.normal(size=len(TIME)),
    )  # fmt: skip
    (folder / "machine.yaml").write_text(MACHINE, encoding="utf-8")
    return folder


def compared(rig: Path, *options: str) -> tuple[int, dict]:
    """Exit code and JSON of `pneumo compare`."""
    out = rig / "compared.json"
    code = main(["compare", str(rig / "friction"), "--model", str(rig / "machine.yaml"), "--json", str(out), *options])
    return code, json.loads(out.read_text(encoding="utf-8")) if code in (0, 1) else {}


def test_the_force_is_predicted(rig: Path) -> None:
    code, found = compared(rig, "--imposed")
    assert code in (0, 1)
    error = found["runs"][0]["error"]
    assert set(error) == {"force_n"}
    assert error["force_n"]["rms"] < 10.0
    assert set(found["equations"]) == {"momentum"}


def test_without_it_the_recording_lacks_a_drive(rig: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert compared(rig)[0] == 3
    assert "--imposed" in capsys.readouterr().err
