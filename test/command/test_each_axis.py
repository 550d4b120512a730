"""`compare`, `identify` and `diagnose` of a machine of several axes: axis by axis, one result."""

import json
from pathlib import Path
from typing import Any

import pytest
from multiaxis.machines import leaky, record, two

from pneumo_ros.command.main import main
from pneumo_ros.multiaxis import Machine, load_machine, machine_text
from pneumo_ros.records.writing import write_axes

pytestmark = pytest.mark.usefixtures("_in_folder")
LINE = {"resistance_supply": 2e7, "time_constant": 0.3}


@pytest.fixture
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("two.yaml").write_text(machine_text(two(LINE)), encoding="utf-8")


def typed(*arguments: str) -> tuple[int, dict[str, Any]]:
    """Exit code and JSON of a command for the machine of the tests."""
    code = main([*arguments, "--model", "two.yaml", "--quiet", "--json", "out.json"])
    return code, json.loads(Path("out.json").read_text(encoding="utf-8")) if Path("out.json").exists() else {}


def test_compare_names_the_axis_whose_equation_fails(capsys: pytest.CaptureFixture[str]) -> None:
    record(leaky(two(LINE)), Path("run"), 1, 4.0)
    code, found = typed("compare", "run", "--report", "page.html", "--series", "numbers.npz")
    assert code == 0
    explained = {
        axis: {name: one["explained_by_noise"] for name, one in result["equations"].items()}
        for axis, result in found["axes"].items()
    }
    assert "supply" not in found  # nothing is fitted
    assert explained["shoulder"] == {"momentum": True, "chamber_a": True, "chamber_b": True}
    assert explained["elbow"] == {"momentum": True, "chamber_a": False, "chamber_b": True}
    assert found["model"] == "two"
    said = capsys.readouterr().out.splitlines()
    assert any(line.startswith("elbow/: chamber a") or ("elbow/" in line and "chamber" in line) for line in said)
    for name in ("page_shoulder.html", "page_elbow.html", "numbers_shoulder.npz", "numbers_elbow.npz"):
        assert Path(name).exists()


def test_an_axis_that_was_not_recorded_is_named_and_the_other_judged(capsys: pytest.CaptureFixture[str]) -> None:
    Path("two.yaml").write_text(machine_text(two()), encoding="utf-8")
    record(two(), Path("both"), 2, 3.0)
    from pneumo_ros.records import read_recording

    one = read_recording("both", "elbow")
    signals = {name: getattr(one, name) for name in ("time", "position", "pressure_a", "pressure_b", "voltage")}
    write_axes("lone", {"elbow": signals})
    code, found = typed("compare", "lone")
    assert code == 3
    assert "unknown namespace" in found["axes"]["shoulder"]["error"]
    assert all(one["explained_by_noise"] for one in found["axes"]["elbow"]["equations"].values())
    assert "unknown namespace" in capsys.readouterr().out


def test_identify_writes_the_machine_file_of_all_axes() -> None:
    Path("runs").mkdir()
    for volts in (1.2, -1.2, 5.0, -5.0):
        moves = [word for axis in ("shoulder", "elbow") for word in ("--input", f"{axis}=step:{volts}@0.3")]
        start = ["--position", str(-0.3 if volts > 0.0 else 0.3), "--seconds", "4"]
        assert main(["simulate", *moves, *start, "--model", "two.yaml", "--out", f"runs/at_{volts}", "--quiet"]) == 0
    code, found = typed("identify", "runs", "--out", "found.yaml")
    assert code in (0, 1)
    assert set(found["axes"]) == {"shoulder", "elbow"}
    machine = load_machine("found.yaml")
    assert machine.supply == pytest.approx(LINE, rel=0.01)  # the simulator records supply/pressure, without noise
    assert found["supply"]["recordings"] == 4
    elbow = machine.axes["elbow"]
    assert elbow["lugre_friction.coulomb_friction"] == pytest.approx(70.0, rel=0.05)
    assert elbow["lugre_friction.coulomb_friction"] != 70.0
    assert main(["identify", "runs", "--model", "two.yaml", "--out", "found.yaml", "--quiet"]) == 2  # it exists


@pytest.mark.check
def test_a_refit_of_all_axes_fits_the_line_that_they_share(capsys: pytest.CaptureFixture[str]) -> None:
    true = {"resistance_supply": 3e7, "time_constant": 0.2}
    record(two(true), Path("run"), 1, 4.0, 2000.0)
    code, found = typed("compare", "run", "--refit", "--out", "found.yaml")
    assert code == 0
    for name, value in true.items():
        one = found["supply"]["parameters"][name]
        assert one["value"] == pytest.approx(value, rel=0.05)
        assert one["before"] == LINE[name]
        assert load_machine("found.yaml").supply[name] == pytest.approx(one["value"], rel=1e-5)
    assert "supply line: resistance supply 3" in capsys.readouterr().out


@pytest.mark.check
def test_a_leak_in_one_axis_is_found_there_and_nothing_in_the_other() -> None:
    for k in (1, 2, 3):
        record(leaky(two(LINE)), Path(f"run_{k}"), k, 8.0)
    code, found = typed("diagnose", "run_1", "run_2", "--holdout", "run_3", "--out", "better.yaml")
    assert code == 0
    assert found["verdict"] == "effects_found"
    assert found["axes"]["shoulder"]["verdict"] == "adequate"
    assert not found["axes"]["shoulder"]["added"]
    (added,) = found["axes"]["elbow"]["added"]
    assert added["effect"] == "leakage_to_atmosphere"
    better = load_machine("better.yaml")
    assert better.axes["elbow"]["leakage_to_atmosphere.conductance_a"] == pytest.approx(6e-10, rel=0.1)
    assert "leakage_to_atmosphere" not in better.axes["shoulder"].effects
    assert better.supply == LINE


def test_an_axis_is_not_taken_for_one_whose_name_ends_as_its_own() -> None:
    shoulder, elbow = two().axes.values()
    machine = Machine("two", {"arm": shoulder, "forearm": elbow}, {"resistance_supply": 5e7, "time_constant": 0.3})
    Path("two.yaml").write_text(machine_text(machine), encoding="utf-8")
    record(machine, Path("run"), 3, 4.0)
    _, found = typed("compare", "run")
    for axis in machine.axes:
        assert all(one["explained_by_noise"] for one in found["axes"][axis]["equations"].values()), axis


@pytest.mark.check
def test_an_effect_is_added_to_one_axis_and_the_machine_kept(capsys: pytest.CaptureFixture[str]) -> None:
    for k in (1, 2):
        record(leaky(two(LINE)), Path(f"run_{k}"), k, 6.0)
    line = ["add", "leakage_to_atmosphere", "run_1", "--holdout", "run_2", "--model", "two.yaml:elbow"]
    code = main([*line, "--namespace", "elbow", "--out", "more.yaml", "--json", "out.json"])
    found = json.loads(Path("out.json").read_text(encoding="utf-8"))
    assert (code, found["machine_file"]) == (0, "more.yaml")
    more, given = load_machine("more.yaml"), load_machine("two.yaml")
    assert more.supply == LINE
    assert more.axes["elbow"]["leakage_to_atmosphere.conductance_a"] == pytest.approx(6e-10, rel=0.1)
    assert more.axes["shoulder"].as_dict() == given.axes["shoulder"].as_dict()
    said = "".join(capsys.readouterr())
    assert "compare run_2 --model more.yaml:elbow --namespace elbow" in said
    assert "Machine file of all axes written to more.yaml" in said
    assert main([*line, "--out", "more.yaml", "--quiet"]) == 2  # it exists
    assert main(["compare", "run_2", "--model", "more.yaml", "--quiet", "--json", "out.json"]) == 0
    found = json.loads(Path("out.json").read_text(encoding="utf-8"))
    assert all(one["explained_by_noise"] for axis in found["axes"].values() for one in axis["equations"].values())


def test_an_unknown_axis_is_refused_before_any_work(capsys: pytest.CaptureFixture[str]) -> None:
    record(two(LINE), Path("run"), 1, 1.0)
    assert main(["add", "viscous_friction", "run", "--model", "two.yaml:elbw", "--out", "more.yaml", "--quiet"]) == 2
    assert "elbow" in capsys.readouterr().err
