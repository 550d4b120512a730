"""`pneumo fleet` on recordings of machines that wear and machines that do not."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from fleet.making import record_fleet

import pneumo_ros as pn
from pneumo_ros.command.main import main
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.fleet.folder import campaigns
from pneumo_ros.fleet.history import history
from pneumo_ros.records import read_recording

COULOMB = "lugre_friction.coulomb_friction"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One machine whose friction grows from the second week on, one that stays as it is."""
    return record_fleet(tmp_path_factory.mktemp("fleet"), {"old": [70.0, 80.0, 90.0], "young": [70.0, 70.0]})


def test_a_campaign_is_a_folder_or_a_day(folder: Path, tmp_path: Path) -> None:
    found, passed = campaigns(folder)
    assert [one.key for one in found] == ["old/week_0", "old/week_1", "old/week_2", "young/week_0", "young/week_1"]
    assert not passed
    assert [one.date[:10] for one in found[:3]] == ["2023-11-14", "2023-11-21", "2023-11-28"]
    (tmp_path / "axis").mkdir()
    for week in (0, 1):
        for path in (folder / "young" / f"week_{week}").iterdir():
            (tmp_path / "axis" / f"{path.name}_{week}").symlink_to(path)
    (tmp_path / "axis" / "broken.mcap").write_bytes(b"nothing")
    (tmp_path / "axis" / "machine.yaml").write_text("")
    found, passed = campaigns(tmp_path)
    assert [one.name for one in found] == ["2023-11-14", "2023-11-21"]
    assert all(one.machine_file == tmp_path / "axis" / "machine.yaml" for one in found)
    assert list(passed) == [str(tmp_path / "axis" / "broken.mcap")]


def test_folders_without_machines_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no folder"):
        campaigns(tmp_path / "none")
    with pytest.raises(DataError, match="FOLDER/MACHINE/RECORDING"):
        campaigns(tmp_path)


def test_a_worn_machine_is_found_again_from_kept_results(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, kept, page = tmp_path / "fleet.json", tmp_path / "kept", tmp_path / "page.html"
    words = ["fleet", str(folder), "--results", str(kept), "--json", str(out), "--quiet"]
    assert main([*words, "--executor", "processes=2"]) == 0
    assert COULOMB in capsys.readouterr().out
    first = json.loads(out.read_text())
    old, young = first["machines"]
    moved = old["drifted"][COULOMB]
    assert (moved["since"], young["drifted"]) == ("week_1", {})
    assert moved["low"] < 90.0 < moved["high"]
    assert 65.0 < moved["first"] < 75.0
    before = kept.read_bytes()
    assert main([*words, "--executor", "one", "--report", str(page)]) == 0
    assert kept.read_bytes() == before  # nothing was computed again
    assert json.loads(out.read_text())["machines"] == first["machines"]
    assert "1 of 2 machines drifted" in page.read_text(encoding="utf-8")
    assert main([*words, "--identify-only"]) == UsageError.exit_code  # results of another question


def test_a_campaign_that_cannot_be_examined_is_named(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for week in (0, 1):
        (tmp_path / "lame" / f"week_{week}").mkdir(parents=True)
    for path in (folder / "young" / "week_0").iterdir():
        (tmp_path / "lame" / "week_0" / path.name).symlink_to(path)
    from records.axis_bag import streams, write

    write(tmp_path / "lame" / "week_1" / "noise", streams())
    assert main(["fleet", str(tmp_path), "--executor", "one", "--quiet"]) == 1
    assert "lame/week_1: none of 1 recordings can be used" in capsys.readouterr().out


# --- comparing over time ----------------------------------------------------------------------------------------------


def examined(
    campaign: int, value: float, half: float = 1.0, added: tuple[str, ...] = (), verdict: str | None = "adequate"
):
    """A campaign in the history of a machine with one parameter."""
    known = {"f.c": {"value": value, "low": value - half, "high": value + half, "unit": "N"}}
    effects = [{"effect": name, "rivals": []} for name in added]
    date = f"2026-01-{campaign + 1:02d}T00:00:00Z"
    return {"machine": "m", "campaign": str(campaign), "date": date, "problem": "", "verdict": verdict,
            "parameters": known, "added": effects}  # fmt: skip


@pytest.mark.parametrize(
    ("values", "since"),
    [
        ((10.0, 10.5, 9.6), None),
        ((10.0, 20.0, 21.0), "1"),
        ((10.0, 10.1, 21.0), "2"),
        ((10.0, 20.0, 10.1), None),  # it returned
        ((10.0, 20.0, 10.0, 20.0, 20.0), "3"),
        ((10.0,), None),
    ],
)
def test_a_drift_leaves_its_interval_and_does_not_return(values: tuple[float, ...], since: str | None) -> None:
    (one,) = history([examined(k, value) for k, value in enumerate(values)])
    assert (one["drifted"]["f.c"]["since"] if one["drifted"] else None) == since


def test_a_change_within_the_scatter_of_machines_is_no_drift() -> None:
    (one,) = history([examined(0, 1000.0, 1e-3), examined(1, 1025.0, 1e-3)])
    assert not one["drifted"]


def test_machines_that_scatter_beyond_their_intervals_do_not_drift_for_that() -> None:
    import numpy as np

    values = np.random.default_rng(2).normal(100.0, 6.0, (40, 6))
    values[0] += [0.0, 0.0, 0.0, 60.0, 60.0, 60.0]
    values[1] += np.arange(6) * 12.0
    fleet = [examined(k, values[m, k], 0.1) | {"machine": str(m)} for m in range(40) for k in range(6)]
    drifted = [one["machine"] for one in history(fleet) if one["drifted"]]
    assert drifted == ["0", "1"]


def test_in_a_large_fleet_chance_alone_causes_no_drift() -> None:
    import numpy as np

    noise = np.random.default_rng(1).normal(10.0, 0.51, (2000, 2))
    fleet = [examined(k, noise[m, k]) | {"machine": str(m)} for m in range(2000) for k in (0, 1)]
    assert not [one for one in history(fleet) if one["drifted"]]


def test_effects_appear_and_stay_or_come_and_go() -> None:
    leak, load = "cross_piston_leakage", "constant_load"
    ours = [
        examined(0, 1.0, added=(load,)), examined(1, 1.0, verdict=None), examined(2, 1.0, added=(leak, load)),
        examined(3, 1.0, added=(leak,)),
    ]  # fmt: skip
    (one,) = history(ours)
    assert one["effects"][leak] | {"date": ""} == {
        "since": "2", "date": "", "from_the_start": False, "steady": True, "campaigns": 2,
    }  # fmt: skip
    assert (one["effects"][load]["from_the_start"], one["effects"][load]["steady"]) == (True, False)


def test_a_machine_in_bar_is_read_as_its_rig_file_says(folder: Path, tmp_path: Path) -> None:
    for path in sorted((folder / "young" / "week_0").iterdir()):
        one = read_recording(path)
        assert one.pressure_a is not None
        assert one.pressure_b is not None
        in_bar = replace(one, pressure_a=1e-5 * one.pressure_a, pressure_b=1e-5 * one.pressure_b)
        pn.save(in_bar, tmp_path / "rigs" / "young" / "week_0" / path.name)
    words = ["fleet", str(tmp_path / "rigs"), "--executor", "one", "--identify-only", "--quiet"]
    assert main([*words, "--json", str(tmp_path / "unread.json")]) == 1
    (tmp_path / "rig.yaml").write_text("rig: {machine: axis, read_as: bar}")
    assert main([*words, "--json", str(tmp_path / "common.json"), "--rig", str(tmp_path / "rig.yaml")]) == 0
    (tmp_path / "rigs" / "young" / "rig.yaml").write_text("rig: {read_as: bar}")
    assert main([*words, "--json", str(tmp_path / "own.json")]) == 0
    (found,) = json.loads((tmp_path / "own.json").read_text())["machines"]
    (common,) = json.loads((tmp_path / "common.json").read_text())["machines"]
    assert found == common
