"""A recorded supply pressure takes the place of the machine file's constant, as a user meets it."""

import json
from pathlib import Path

import numpy as np
import pytest
from identify.making import POSITION_NOISE, PRESSURE_NOISE, voltage

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model
from pneumo_ros.plant.machine_file import machine_text
from pneumo_ros.records import write_recording

N, DT = 8000, 1e-3


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One motion under a supply that swings by 1.2 bar, recorded with and without its sensor, and with a wrong one."""
    folder, random = tmp_path_factory.mktemp("supply"), np.random.default_rng(5)
    time = np.arange(N) * DT
    volts, supply = voltage("steps", time), 6.4e5 + 0.6e5 * np.sin(2.0 * np.pi * 0.4 * time)
    model = load_model("axis").measuring(["measured_supply"])
    begin = model.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([begin, model.simulate(np.column_stack([volts, supply])[:-1], begin)])
    y = states[:, 0] + random.normal(0.0, POSITION_NOISE, N)
    p_a, p_b, p_s = (p + random.normal(0.0, PRESSURE_NOISE, N) for p in (states[:, 2], states[:, 3], supply))
    signals = {"time": time, "position": y, "pressure_a": p_a, "pressure_b": p_b, "voltage": volts}
    write_recording(folder / "with", **signals, supply_pressure=p_s)
    write_recording(folder / "without", **signals)
    write_recording(folder / "gauge", **signals, supply_pressure=p_s - 4e5)
    return folder


def compared(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[dict[str, float], str]:
    """Error over noise of each equation of the first recording, and the messages."""
    main(["compare", *words, "--json", "-"])
    shown = capsys.readouterr()
    equations = json.loads(shown.out)["equations"]
    return {name: one["ratio_to_noise"] for name, one in equations.items()}, shown.err


def test_the_chambers_are_predicted_with_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    exact, said = compared(capsys, str(folder / "with"))
    assert "The supply pressure is measured, in place of air.supply_pressure" in said
    constant, quiet = compared(capsys, str(folder / "without"))
    assert "The supply pressure" not in quiet
    assert max(exact.values()) < 1.3
    assert min(constant["chamber_a"], constant["chamber_b"]) > 5.0


def test_all_recordings_must_have_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, said = compared(capsys, str(folder / "with"), str(folder / "without"))
    assert "measured, in place of" not in said


def test_one_that_the_chambers_contradict_is_not_used(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ratio, said = compared(capsys, str(folder / "gauge"))
    assert "its supply pressure is not used" in said
    assert "one of them is gauge pressure, or in another unit" in said
    assert ratio["chamber_a"] > 5.0


def test_the_machine_file_does_not_change(folder: Path) -> None:
    axis = load_model("axis")
    model = axis.measuring(["measured_supply"])
    assert model.inputs == ("U", "measured_supply")
    assert machine_text(model) == machine_text(axis)
    assert model.with_effects([*axis.effects, "payload_mass"]).inputs == model.inputs
    assert model.measuring(()).composition is axis.composition
    assert load_model("emps").measuring(["measured_supply"]).inputs == ("U",), "no flow depends on it"


def test_droop_lowers_a_measured_supply_as_it_does_a_constant() -> None:
    axis = load_model("axis")
    drooping = axis.with_effects([*axis.effects, "supply_pressure_droop"])
    constant, measured = drooping, drooping.measuring(["measured_supply"])
    volts = voltage("steps", np.arange(500) * DT)
    inputs = np.column_stack([volts, np.full(500, axis["air.supply_pressure"])])
    begin = axis.state(p_a=3e5, p_b=3.9e5)
    x = constant.simulate(volts, constant.continued(axis, begin))
    assert measured.simulate(inputs, measured.continued(axis, begin)).tobytes() == x.tobytes()
