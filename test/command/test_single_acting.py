"""A single-acting cylinder, as a user meets it: simulated, compared, diagnosed, and refused where it cannot be."""

import json
from pathlib import Path

import numpy as np
import pytest
from plant.catalogue import AXIS

from pneumo_ros.command.main import main
from pneumo_ros.plant import Model, load_model, save_model
from pneumo_ros.records import read_recording, write_recording

VISCOUS = "viscous_friction.coefficient"
INPUTS = ("sine:2,0.5", "sine:3,0.3", "sine:1.6,0.8", "sine:2.5,1")


def cylinder(**further: float) -> Model:
    """A spring returns it; a small valve, little friction."""
    values = {name: value for name, value in AXIS.parameters.items() if name.partition(".")[0] != "chambers"}
    values |= {
        "piston.stroke": 0.4, "single_acting.volume_a": 1.5e-4, "single_acting.spring_retracted": 60.0,
        "single_acting.spring_extended": 140.0, "arctan_flow.filling_coefficient": 0.7e-9,
        "arctan_flow.exhaust_coefficient": 0.9e-9, "lugre_friction.static_friction": 30.0,
        "lugre_friction.coulomb_friction": 20.0, "quadratic_drag.coefficient": 400.0,
    }  # fmt: skip
    effects = [*AXIS.effects, *dict.fromkeys(name.partition(".")[0] for name in further)]
    return Model.build(effects, {**values, **further}, frame=("piston", "air", "single_acting"), name="single")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The machine file, and a recording of the same machine with viscous friction."""
    folder = tmp_path_factory.mktemp("single")
    save_model(cylinder(), folder / "single.yaml")
    save_model(cylinder(**{VISCOUS: 90.0}), folder / "hidden.yaml")
    (folder / "runs").mkdir()
    simulate(folder, 3)
    return folder


def simulate(folder: Path, number: int) -> None:
    """Record the machine with viscous friction under one of the inputs."""
    words = ["--input", INPUTS[number], "--seconds", "6", "--out", str(folder / "runs" / f"run_{number}")]
    assert main(["simulate", *words, "--model", str(folder / "hidden.yaml"), "--quiet"]) == 0


def compared(folder: Path, machine: str, capsys: pytest.CaptureFixture[str], bag: str = "runs/run_3") -> dict:
    main(["compare", str(folder / bag), "--model", str(folder / machine), "--json", "-"])
    return json.loads(capsys.readouterr().out)


def test_one_chamber_is_recorded_and_judged(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = compared(folder, "hidden.yaml", capsys)
    assert list(found["equations"]) == ["momentum", "chamber_a"]
    assert all(one["explained_by_noise"] for one in found["equations"].values())
    assert set(found["runs"][0]["error"]) == {"position_m", "pressure_a_pa"}
    recording = read_recording(folder / "runs" / "run_3")
    assert recording.pressure_b is None
    force = load_model(folder / "hidden.yaml")["piston.area_a"] * (recording.pressure_a - 1e5)
    assert np.allclose(recording.effort, force)


def test_the_pressure_of_the_open_side_is_not_asked_for_and_not_used(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = read_recording(folder / "runs" / "run_3")
    wrong = np.full(len(one), 3e5)
    signals = {"time": one.time, "position": one.position, "pressure_a": one.pressure_a, "voltage": one.voltage}
    write_recording(folder / "both", **signals, pressure_b=wrong)
    assert compared(folder, "hidden.yaml", capsys, "both")["equations"]["momentum"]["explained_by_noise"]


def test_the_momentum_fails_alone_without_the_hidden_friction(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    equations = compared(folder, "single.yaml", capsys)["equations"]
    assert not equations["momentum"]["explained_by_noise"]
    assert equations["chamber_a"]["explained_by_noise"]


@pytest.mark.check
def test_the_hidden_friction_is_found(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for number in range(3):
        simulate(folder, number)
    capsys.readouterr()
    words = [str(folder / "runs"), "--holdout", str(folder / "runs" / "run_3"), "--model", str(folder / "single.yaml")]
    assert main(["diagnose", *words, "--json", "-", "--out", str(folder / "found.yaml")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [one["effect"] for one in found["added"]] == ["viscous_friction"]
    assert found["added"][0]["parameters"]["coefficient"]["value"] == pytest.approx(90.0, rel=0.01)
    assert load_model(folder / "found.yaml").actuator is load_model(folder / "single.yaml").actuator


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["tune", "--out", "tuned.yaml"], "a law of control needs chambers on both sides of the piston"),
        (["commission", "--out", "found.yaml"], "commissioning needs chambers on both sides of the piston"),
    ],
)
def test_what_needs_two_chambers_says_so(
    folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], why: str
) -> None:
    assert main([*words, "--model", str(folder / "single.yaml")]) == 2
    assert why in " ".join(capsys.readouterr().err.split())


def test_a_spring_pushes_back_as_its_data_sheet_says() -> None:
    model = cylinder()
    states = np.array([model.state(y=y) for y in (-0.2, 0.0, 0.2)])
    atmosphere = model["air.atmospheric_pressure"] * (model["piston.area_a"] - model["piston.area_b"])
    assert model.outputs(states)["drive"] - atmosphere == pytest.approx([-60.0, -100.0, -140.0])


def test_a_gas_spring_is_one_without_a_valve(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Sealed, it needs no command, and swings with p V^gamma constant."""
    effects = ["rod_atmospheric_force", "viscous_friction"]
    known = {**cylinder().parameters, VISCOUS: 5.0}
    values = {name: value for name, value in known.items() if name.partition(".")[0] in ("piston", "air", *effects)}
    values |= {"single_acting.volume_a": 1.5e-4}
    model = Model.build(effects, values, frame=("piston", "air", "single_acting"), name="spring")
    save_model(model, folder / "spring.yaml")
    states = model.simulate(np.zeros(3000), model.state(p_a=1.2e5, v=0.3))
    volume = model["single_acting.volume_a"] + model["piston.area_a"] * states[:, 0]
    assert states[:, 2] * volume**1.4 == pytest.approx(states[0, 2] * volume[0] ** 1.4, rel=1e-5)
    signals = {"time": 1e-3 * np.arange(3000), "position": states[:, 0], "pressure_a": states[:, 2]}
    write_recording(folder / "swing", **signals, effort=np.zeros(3000))
    found = compared(folder, "spring.yaml", capsys, "swing")
    assert all(one["explained_by_noise"] for one in found["equations"].values())
    assert list(found["equations"]) == ["momentum", "chamber_a"]
