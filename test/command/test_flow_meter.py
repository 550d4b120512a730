"""A flow meter in the line of chamber a: read, shown, imported, and judged by one effect."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from identify.making import POSITION_NOISE, PRESSURE_NOISE, voltage
from plant.catalogue import AXIS

from pneumo_ros.command.main import main
from pneumo_ros.diagnose.hypothesis import missing
from pneumo_ros.plant import Model, save_model
from pneumo_ros.reading.read import read_run
from pneumo_ros.records import read_recording, write_recording
from pneumo_ros.records.rates import thinned
from pneumo_ros.runs.inputs import measured_inputs

N, DT = 4000, 1e-3
COEFFICIENTS = ("arctan_flow.filling_coefficient", "arctan_flow.exhaust_coefficient")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with the flow meter, and two machine files with another valve, one of which believes the flow meter."""
    folder, random = tmp_path_factory.mktemp("flow"), np.random.default_rng(5)
    time = np.arange(N) * DT
    volts, begin = voltage("steps", time), AXIS.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([begin, AXIS.simulate(volts[:-1], begin)])
    flow = AXIS.outputs(states, volts)["port_flow_a"]
    y = states[:, 0] + random.normal(0.0, POSITION_NOISE, N)
    p_a, p_b = (p + random.normal(0.0, PRESSURE_NOISE, N) for p in states[:, 2:4].T)
    signals = {"time": time, "position": y, "pressure_a": p_a, "pressure_b": p_b, "voltage": volts}
    write_recording(folder / "run", **signals, further={"flow_a": flow})
    other = AXIS.with_parameters({name: 1.5 * AXIS[name] for name in COEFFICIENTS})
    save_model(other, folder / "valve.yaml")
    save_model(other.with_effects([*other.effects, "metered_flow"]), folder / "meter.yaml")
    return folder


def judged(folder: Path, machine: str, capsys: pytest.CaptureFixture[str]) -> dict[str, float]:
    """Residual over noise by equation."""
    main(["compare", str(folder / "run"), "--model", str(folder / machine), "--json", "-"])
    equations = json.loads(capsys.readouterr().out)["equations"]
    return {name: one["ratio_to_noise"] for name, one in equations.items()}


def test_it_is_read_back_and_shown(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    flow = read_recording(folder / "run").signals["flow_a"]
    assert np.ptp(flow) > 1e-3
    assert main(["view", str(folder / "run")]) == 0
    assert "flow a" in capsys.readouterr().out


def test_chamber_a_is_judged_without_the_law_of_the_valve(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong, right = (judged(folder, machine, capsys) for machine in ("valve.yaml", "meter.yaml"))
    assert wrong["chamber_a"] > 10.0
    assert right["chamber_a"] < wrong["chamber_a"] / 5.0
    assert right["chamber_b"] == pytest.approx(wrong["chamber_b"], rel=1e-3)  # which has no flow meter


def test_the_flow_is_predicted_by_the_law_of_the_valve(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_model(AXIS, folder / "true.yaml")
    found = {}
    for machine in ("true", "valve", "meter"):
        main(["compare", str(folder / "run"), "--model", str(folder / f"{machine}.yaml"), "--json", "-"])
        found[machine] = json.loads(capsys.readouterr().out)["runs"][0]["error"]["flow_a_kg_s"]["rms"]
    assert found["true"] < 0.02 * found["valve"]  # 1.5 times the flow coefficients
    assert found["meter"] > 0.3 * found["valve"]  # which takes the flow from the meter: its valve is as wrong


def test_a_flow_that_one_recording_has_is_not_judged(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = read_recording(folder / "run")
    signals = {"time": one.time, "position": one.position, "pressure_a": one.pressure_a, "pressure_b": one.pressure_b}
    write_recording(folder / "without", **signals, voltage=voltage("steps", one.time))
    runs = [str(folder / "run"), str(folder / "without")]
    assert main(["compare", *runs, "--model", str(folder / "valve.yaml"), "--json", "-"]) == 0
    assert "flow_a_kg_s" not in json.loads(capsys.readouterr().out)["runs"][0]["error"]


def test_the_effect_is_tried_where_it_was_measured(folder: Path) -> None:
    model: Model = AXIS
    run = read_run(folder / "run", model).run
    assert "metered_flow" in missing(model, measured_inputs([run]))
    assert "metered_flow" not in missing(model, ["U"])


def test_it_is_thinned_with_the_rest(folder: Path) -> None:
    one = read_recording(folder / "run")
    fast, said = thinned(replace(one, time=0.1 * one.time))
    assert said
    assert len(fast.signals["flow_a"]) == len(fast) < len(one)


def test_a_table_has_it_in_litres_per_minute(tmp_path: Path) -> None:
    rows = [f"{0.01 * k},{0.001 * k},{2e5 + k},{60.0 / 1.185}" for k in range(100)]
    (tmp_path / "run.csv").write_text("\n".join(["t (s),x (m),p (Pa),q (Nl/min)", *rows]))
    plan = "time: t (s)\nsignals: {position: x (m), pressure_a: p (Pa), flow_a: {column: q (Nl/min), unit: Nl/min}}"
    (tmp_path / "map.yaml").write_text(plan)
    words = [str(tmp_path / "run.csv"), "--map", str(tmp_path / "map.yaml"), "--out", str(tmp_path / "bag")]
    assert main(["import", *words]) == 0
    assert read_recording(tmp_path / "bag").signals["flow_a"] == pytest.approx(1e-3)
