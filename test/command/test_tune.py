"""pneumo tune: a usable control file that is better than its start; refusals."""

import json
from pathlib import Path

import pytest

from pneumo_ros.command.main import main
from pneumo_ros.command.rated_motions import begin_at, harsher, rated_motions, task_for, top_speed
from pneumo_ros.control.control_file import load_control
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
SHORT = ("--amplitude", "0.05", "--frequency", "0.25", "--quiet", "--executor", "one", "--evaluations")


def test_it_writes_a_control_file_and_says_what_changed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, data = tmp_path / "pid.yaml", tmp_path / "pid.json"
    assert main(["tune", "--law", "pid", *SHORT, "3", "--out", str(out), "--json", str(data)]) == 0
    said, told = capsys.readouterr().out, json.loads(data.read_text())
    assert "Tuned pid for axis" in said
    assert "proportional" in said
    assert told["cost"]["after"] <= told["cost"]["before"]
    assert told["evaluations"] == 3
    found = load_control(out)
    assert {name: found.gains[name] for name in told["gains"]} == told["gains"]
    assert "pneumo tune" in out.read_text().splitlines()[0]
    assert main(["tune", "--control", str(out), *SHORT, "1", "--out", str(out), "--json", str(data)]) == 0
    assert json.loads(data.read_text())["cost"]["before"] == pytest.approx(told["cost"]["after"])


@pytest.mark.check
def test_processes_find_the_same_gains_to_the_bit(tmp_path: Path) -> None:
    found = []
    for executor in ("one", "processes=2"):
        data = tmp_path / f"{executor}.json"
        words = ["tune", "--law", "pid", *SHORT, "4", "--executor", executor, "--out", str(tmp_path / "pid.yaml")]
        assert main([*words, "--json", str(data)]) == 0
        found.append({name: json.loads(data.read_text())[name] for name in ("gains", "cost")})
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["--law", "pidd"], 2, "did you mean pid"),
        (["--evaluations", "0"], 2, "--evaluations is 0"),
        (["--amplitude", "nan"], 2, "--amplitude is nan"),
        (["--amplitude", "5"], 2, "--amplitude is 5 m; the stroke of 2 m allows 0.9 m"),
        (["--step", "1"], 2, "--step is 1 m"),
        (["--spool", "-1"], 2, "--spool is -1"),
        (["--control", "cascade", "--law", "pid"], 2, "leave one of them out"),
        (["--control", "no_such"], 3, "no_such cannot be read"),
        (["--model", "emps"], 2, "no valve"),
    ],
)
def test_what_makes_no_sense_is_refused(
    arguments: list[str], code: int, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["tune", "--out", str(tmp_path / "c.yaml"), *arguments]) == code
    assert said in capsys.readouterr().err
    assert not (tmp_path / "c.yaml").exists()


def test_the_task_is_within_what_the_machine_can_do() -> None:
    assert top_speed(AXIS) == pytest.approx(0.1467, abs=1e-3)  # extending it is faster
    task = task_for(AXIS)
    assert (task.amplitude, task.step) == (pytest.approx(0.3), pytest.approx(0.06))
    assert task.frequency == pytest.approx(0.05, rel=0.01)
    heavy = task_for(AXIS.with_parameters({"piston.mass": 400.0}))
    assert heavy.duration > 1.2 * task.duration  # for lack of force
    assert task_for(AXIS, 0.1, 0.3, 0.02).frequency == 0.3


def test_a_machine_that_hardly_moves_is_refused() -> None:
    """Its sine would take days."""
    with pytest.raises(UsageError, match="look at supply_pressure"):
        task_for(AXIS.with_parameters({"air.supply_pressure": 1.1e5}))


def test_the_other_machine_is_heavier_and_stickier_and_one_without_lugre_friction_is_fine() -> None:
    assert harsher(AXIS)["piston.mass"] == 10.0
    assert harsher(AXIS)["lugre_friction.static_friction"] == pytest.approx(120.0)
    assert "valve_spool_dynamics" not in harsher(AXIS).effects
    assert harsher(AXIS, 400.0)["valve_spool_dynamics.angular_frequency"] == 400.0
    bare = AXIS.with_effects(["dead_zone", "arctan_flow", "quadratic_drag", "end_stop"])
    assert len(rated_motions(bare, task_for(bare))) == 4


def test_trials_begin_in_balance() -> None:
    states = AXIS.simulate([0.0] * 200, begin_at(AXIS, 0.3))
    assert abs(states[-1, 0] - 0.3) < 1e-4
