"""A boom in MuJoCo, and its load along the rod from its URDF by Pinocchio: two codes of rigid bodies agree."""

import importlib
from pathlib import Path
from types import ModuleType

import pytest

import pneumo_ros as pn
from pneumo_ros.plant import load_model

pytest.importorskip("mujoco", reason="comes with the mujoco extra")
pytest.importorskip("pinocchio", reason="comes with the arm extra")
ROOT = Path(__file__).parents[2]
LOADS = {"payload_mass", "constant_load", "spring_load", "load_compliance", "position_dependent_friction"}


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The benchmark that records the boom."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    return importlib.import_module("bench_arm_load")


def test_noise_explains_what_the_urdf_leaves_of_a_recording(bench: ModuleType, tmp_path: Path) -> None:
    machine = load_model(ROOT / "config" / "arm" / "lever.yaml")
    bag = bench.record(tmp_path, machine, 3, 4.0)
    equations = pn.compare([bag], model=machine).as_dict()["equations"]
    assert all(one["explained_by_noise"] for one in equations.values()), equations
    plain = machine.with_effects([name for name in machine.effects if name != "arm_load"])
    assert pn.compare([bag], model=plain).as_dict()["equations"]["momentum"]["residual_rms"] > 100.0  # N


@pytest.mark.check
def test_a_diagnosis_takes_no_geometry_for_an_effect(bench: ModuleType, tmp_path: Path) -> None:
    machine = load_model(ROOT / "config" / "arm" / "lever.yaml")
    bags = [bench.record(tmp_path, machine, seed, 10.0) for seed in (1, 2, 3)]
    plain = machine.with_effects([name for name in machine.effects if name != "arm_load"])
    without, with_it = (pn.diagnose(bags[:2], holdout=bags[2:], model=model).as_dict() for model in (plain, machine))
    taken = LOADS.intersection(one["effect"] for one in without["added"])
    assert taken or (without["verdict"] == "unknown_effect" and "momentum" in without["failing"])
    assert with_it["verdict"] == "adequate"
    assert not with_it["added"]
