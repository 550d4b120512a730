"""Machine files: one file gives the model of the commands and the parameters of the nodes, to the bit."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import Model, load_model, save_model
from pneumo_ros.plant.machine_file import machine_text, shipped_machines


@pytest.mark.parametrize("name", ["axis", "paper"])
def test_shipped_machines_load(name: str) -> None:
    assert name in shipped_machines()
    model = load_model(name)
    assert model.name == name
    assert model.states == ("y", "v", "p_a", "p_b", "z")
    assert ("rod_atmospheric_force" in model.effects) == (name == "axis")


def test_shipped_machines_differ_in_the_rod_force_alone() -> None:
    axis, paper = load_model("axis"), load_model("paper")
    assert dict(axis.parameters) == dict(paper.parameters)
    assert [e for e in axis.effects if e != "rod_atmospheric_force"] == list(paper.effects)


@pytest.mark.parametrize("name", shipped_machines())
def test_every_shipped_machine_runs(name: str) -> None:
    model = load_model(name)
    assert np.isfinite(model.simulate(np.full(50, 5.0), model.state())).all()


def test_axis_holds_the_defaults_of_its_effects() -> None:
    model = load_model("axis")
    assert {key: model.specification(key).default for key in model.parameters} == dict(model.parameters)


def awkward(model: Model) -> Model:
    """Values whose decimal text is long, or would be read as text by YAML 1.1."""
    return model.with_parameters(
        {
            "piston.mass": 0.1 + 0.2,
            "air.supply_pressure": 1e6 / 3.0,
            "arctan_flow.filling_coefficient": 1e-9,
            "end_stop.stiffness": 1e8,
            "lugre_friction.static_friction": 0.0,
            "chambers.volume_a": 4.1000000000000005e-4 + 1e-19,
        }
    )


@pytest.mark.parametrize("name", shipped_machines())
def test_saved_and_loaded_again_to_the_bit(tmp_path: Path, name: str) -> None:
    model = load_model(name) if name != "axis" else awkward(load_model(name))
    again = load_model(save_model(model, tmp_path / "saved.yaml"))
    assert again.effects == model.effects
    assert again.values.tobytes() == model.values.tobytes()
    assert again.name == "saved"


def test_a_machine_without_effects_is_saved_and_loaded(tmp_path: Path) -> None:
    bare = load_model("axis").with_effects([])
    assert load_model(save_model(bare, tmp_path / "bare.yaml")).effects == ()


def test_saving_keeps_an_existing_file_if_asked(tmp_path: Path) -> None:
    path = tmp_path / "kept.yaml"
    path.write_text("kept")
    with pytest.raises(DataError, match="exists and is kept"):
        save_model(load_model("axis"), path, overwrite=False)
    assert path.read_text() == "kept"


NODE = """
import json, sys, rclpy
from rclpy.node import Node
rclpy.init(args=["--ros-args", "--params-file", sys.argv[1]])
node = Node("any_name", namespace="cell", automatically_declare_parameters_from_overrides=True)
found = node.get_parameters_by_prefix("")
print(json.dumps({key: [p.type_.name, list(p.value) if p.type_.name.endswith("ARRAY") else p.value]
                  for key, p in found.items() if not key.startswith(("use_sim_time", "start_type"))}))
rclpy.shutdown()
"""


@pytest.mark.parametrize("name", [*shipped_machines(), "awkward", "bare"])
def test_ros_reads_the_same_doubles(tmp_path: Path, name: str) -> None:
    """Through rclpy's own parser, in any node of any namespace; every value a double, none an integer or a text."""
    model = load_model(name if name in shipped_machines() else "axis")
    model = awkward(model) if name == "awkward" else model.with_effects([] if name == "bare" else model.effects)
    path = save_model(model, tmp_path / f"{name}.yaml")
    done = subprocess.run([sys.executable, "-c", NODE, str(path)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert found.pop("effects") == ["STRING_ARRAY", list(model.effects) or [""]]
    assert found.pop("coordinate", ["STRING", "translation"]) == ["STRING", model.coordinate]
    assert found == {key: ["DOUBLE", value] for key, value in model.parameters.items()}


def test_numbers_with_bare_exponents_are_numbers(tmp_path: Path) -> None:
    """YAML 1.1 reads 7e5 as text, ROS as a number: so do we."""
    path = tmp_path / "machine.yaml"
    path.write_text(machine_text(load_model("axis")).replace("supply_pressure: 700000.0", "supply_pressure: 6e5"))
    assert yaml.safe_load("6e5") == "6e5"
    assert load_model(path)["air.supply_pressure"] == 6e5


def test_a_parameter_whose_default_adds_nothing_may_be_left_out(tmp_path: Path) -> None:
    name, axis = "asymmetric_friction", load_model("axis")
    path = save_model(axis.with_effects([*axis.effects, name], {f"{name}.ratio": 0.3}), tmp_path / "saved.yaml")
    path.write_text("\n".join(line for line in path.read_text().splitlines() if "static_ratio" not in line))
    model = load_model(path)
    assert (model[f"{name}.ratio"], model[f"{name}.static_ratio"]) == (0.3, 0.0)


def test_two_machines_in_one_file_are_refused_by_name(tmp_path: Path) -> None:
    inner = yaml.safe_load(machine_text(load_model("axis")))["/**"]
    (tmp_path / "two.yaml").write_text(yaml.safe_dump({"/lift/simulator": inner, "/reach/simulator": inner}))
    with pytest.raises(UsageError, match="2 machines \\(/lift/simulator, /reach/simulator\\)"):
        load_model(tmp_path / "two.yaml")
