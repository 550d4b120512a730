"""A measured supply pressure takes the place of the constant one in identification, too: verb and node."""

import json
from pathlib import Path

import numpy as np
import pytest
from identify.constant import VOLTAGES, truth
from identify.making import POSITION_NOISE, PRESSURE_NOISE

from pneumo_ros.axis.identification.work import Report, work
from pneumo_ros.command.main import main
from pneumo_ros.identify.flow import fit_flow
from pneumo_ros.identify.steady import find_windows
from pneumo_ros.plant import Model
from pneumo_ros.reading.read import read_runs
from pneumo_ros.records import write_recording
from pneumo_ros.runs.inputs import measuring

FILLING = "arctan_flow.filling_coefficient"
LOW = 0.85  # of the machine file's supply pressure


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Model]:
    """Constant voltages under a supply that is lower than the machine file says, and a sensor for it."""
    folder, random, model = tmp_path_factory.mktemp("sagging"), np.random.default_rng(9), truth()
    low = LOW * model["air.supply_pressure"]
    actual, time = model.with_parameters({"air.supply_pressure": low}), np.arange(4000) * 1e-3
    for volts in VOLTAGES:
        begin = actual.state(y=-0.3 * np.sign(volts), p_a=3e5, p_b=3.9e5)
        states = np.vstack([begin, actual.simulate(np.full(len(time) - 1, volts), begin)])
        y = states[:, 0] + random.normal(0.0, POSITION_NOISE, len(time))
        p_a, p_b = (states[:, k] + random.normal(0.0, PRESSURE_NOISE, len(time)) for k in (2, 3))
        supply = low + random.normal(0.0, PRESSURE_NOISE, len(time))
        write_recording(
            folder / f"constant_{1e3 * volts:+.0f}", time=time, position=y, pressure_a=p_a, pressure_b=p_b,
            voltage=np.full(len(time), volts), supply_pressure=supply,
        )  # fmt: skip
    return folder, model


def test_steady_flow_is_fitted_with_it(campaign: tuple[Path, Model]) -> None:
    folder, model = campaign
    runs = read_runs([str(path) for path in sorted(folder.iterdir())], model).runs
    fits = []
    for one in (measuring(model, runs), model):
        wrong = one.with_parameters({FILLING: 1.1 * one[FILLING]})
        fits.append(fit_flow(wrong, [w for run in runs for w in find_windows(one, run)]))
    assert fits[0].values[FILLING] == pytest.approx(model[FILLING], rel=5e-3)
    assert FILLING not in fits[1].values or abs(fits[1].values[FILLING] / model[FILLING] - 1.0) > 0.05


@pytest.mark.check
def test_the_flow_is_that_of_the_measured_supply(
    campaign: tuple[Path, Model], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, model = campaign
    main(["identify", str(folder), "--json", str(tmp_path / "found.json")])
    assert "The supply pressure is measured, in place of air.supply_pressure" in capsys.readouterr().err
    found = json.loads((tmp_path / "found.json").read_text())["parameters"]
    assert found[FILLING]["determined"]
    assert found[FILLING]["value"] == pytest.approx(model[FILLING], rel=5e-3)
    main(["identify", str(folder), "--read-as", "no-supply", "--json", str(tmp_path / "without.json")])
    without = json.loads((tmp_path / "without.json").read_text())["parameters"]
    assert not without[FILLING]["determined"] or abs(without[FILLING]["value"] / model[FILLING] - 1.0) > 0.05


@pytest.mark.check
def test_so_it_is_in_the_node(campaign: tuple[Path, Model]) -> None:
    folder, model = campaign
    job = {
        "machine": model.as_dict(), "name": model.name, "files": [], "axis": "", "joint_name": "", "whole_model": False,
        "bags": [str(path) for path in sorted(folder.iterdir())],
    }  # fmt: skip
    result = work(job, Report())
    assert result["machine"]["arctan_flow"]["filling_coefficient"] == pytest.approx(model[FILLING], rel=5e-3)
    assert result["judged"].startswith("Judged: momentum, chamber a, chamber b. Not judged: load apart")
    assert result["machine"]["air"]["supply_pressure"] == model["air.supply_pressure"]
