"""Programmes: refusals, their limits from machine files, and programme files that keep them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.command.inputs import read_csv
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.experiment.catalogue import EXPERIMENTS, make_programme
from pneumo_ros.experiment.constant_voltage import constant_voltage, name_of
from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.programme_file import commands_text, programme_text, read_programme
from pneumo_ros.experiment.rehearsal import Rehearsal, rehearse
from pneumo_ros.experiment.voltages import Constant, Steps, Sweep
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
STEPS = Steps(((0.5, 1.0), (1.0, -2.0)))
SWEEP = Sweep(2.5, 0.1, 0.9, 20.0)
TRIALS = (Trial("one", Constant(1.1), 8.0, 25.0, 0.8), Trial("two", STEPS, 1.5), Trial("three", SWEEP, 20.0))
PROGRAMME = Programme("mixed", "axis", -0.9, 0.9, 0.99, 1.1, 1.2, TRIALS, 0.5)


@pytest.fixture(scope="module")
def campaign() -> tuple[Programme, Rehearsal]:
    """The default campaign on the default machine."""
    programme = make_programme("constant-voltage", AXIS)
    return programme, rehearse(programme, AXIS)


def test_names_say_the_voltage() -> None:
    assert [name_of(volts) for volts in (1.1, -1.1, 0.785, -7.0)] == [
        "constant_p1100", "constant_m1100", "constant_p0785", "constant_m7000",
    ]  # fmt: skip


def test_the_default_campaign_goes_both_ways_slowest_first(campaign: tuple[Programme, Rehearsal]) -> None:
    trials = campaign[0].trials
    assert len(trials) >= 14
    volts = [trial.voltage.at(0.0) for trial in trials]
    assert sorted(volts, key=abs) == volts
    assert {trial.direction for trial in trials[::2]} == {1}
    assert {trial.direction for trial in trials[1::2]} == {-1}
    assert min(map(abs, volts)) > AXIS["dead_zone.right_limit"]


def test_the_default_campaign_is_rehearsed_inside_the_stroke(campaign: tuple[Programme, Rehearsal]) -> None:
    programme, rehearsal = campaign
    assert rehearsal.aborted == ""
    assert [one.name for one in rehearsal.outcomes] == [trial.name for trial in programme.trials]
    assert all(one.ended in ("time", "travel", "limit") for one in rehearsal.outcomes)
    positions = [position for _, position in rehearsal.path]
    assert programme.low - 0.05 < min(positions) < max(positions) < programme.high + 0.05
    speeds = [abs(one.speed) for one in rehearsal.outcomes]
    assert max(speeds) > 4.0 * min(speeds)
    assert rehearsal.duration == pytest.approx(sum(np.diff([t for t, _ in rehearsal.commands])), abs=0.01)


def test_the_dead_zone_of_each_side_counts() -> None:
    lopsided = AXIS.with_parameters({"dead_zone.right_limit": 0.3, "dead_zone.left_limit": 1.2})
    programme = constant_voltage(lopsided)
    right = [trial.voltage.at(0.0) for trial in programme.trials if trial.direction > 0]
    left = [trial.voltage.at(0.0) for trial in programme.trials if trial.direction < 0]
    assert right[0] - 0.3 == pytest.approx(-left[0] - 1.2)
    assert programme.return_left - programme.return_right == pytest.approx(0.9)


def test_given_voltages_run_both_ways_in_order() -> None:
    trials = constant_voltage(AXIS, [2.0, 0.9], seconds=3.0).trials
    assert [trial.name for trial in trials] == ["constant_p0900", "constant_m0900", "constant_p2000", "constant_m2000"]
    assert {trial.seconds for trial in trials} == {3.0}


@pytest.mark.parametrize("voltages", [[0.0], [-1.0], [11.0], [float("nan")], [1.0, 1.0001]])
def test_bad_voltages_are_refused(voltages: list[float]) -> None:
    with pytest.raises(UsageError, match=r"volt|twice"):
        constant_voltage(AXIS, voltages)


@pytest.mark.parametrize("name", EXPERIMENTS)
@pytest.mark.parametrize("position", [0.0, 1.0, -0.7])
def test_every_experiment_goes_well_on_the_default_machine_from_anywhere(name: str, position: float) -> None:
    programme = make_programme(name, AXIS, seconds=2.0)
    rehearsal = rehearse(programme, AXIS, position)
    assert rehearsal.aborted == ""
    assert len(rehearsal.outcomes) == len(programme.trials)


def test_experiments_need_a_valve() -> None:
    for name in EXPERIMENTS:
        with pytest.raises(UsageError, match="no chambers"):
            make_programme(name, load_model("emps"))


def test_a_machine_too_stiff_to_move_is_said_to_be_so() -> None:
    stuck = AXIS.with_parameters({"lugre_friction.static_friction": 900.0, "lugre_friction.coulomb_friction": 800.0})
    assert "stays at" in rehearse(make_programme("constant-voltage", AXIS, [1.0], 1.0), stuck).aborted


def test_a_file_keeps_a_programme(tmp_path: Path) -> None:
    (tmp_path / "mixed.yaml").write_text(programme_text(PROGRAMME), encoding="utf-8")
    assert read_programme(tmp_path / "mixed.yaml") == PROGRAMME


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("low: -0.9", "low: 0.95", "-end < low < high < end"),
        ("low: -0.9", "low: left", "low is 'left'; it takes a number"),
        ("rest: 0.5", "rest: 0.0", "at least 0.2 s"),
        ("rest: 0.5", "rset: 0.5", "did you mean rest"),
        ("return_left: 1.2", "return_left: 0.0", "return_left is 0 V"),
        ("return_left: 1.2\n", "", "return_left is None"),
        ("constant: 1.1", "constant: 11.0", "one is 11 V"),
        ("constant: 1.1", "constant: .nan", "trial 'one': constant is nan"),
        ("name: one", f"name: {3000 * 'one '}", "one one one': its recording needs a plain file name"),
        ("constant: 1.1", "volts: 1.1", "unknown entry 'volts'"),
        ("constant: 1.1", "constant: 1.1, steps: [[1.0, 1.0]]", "takes one of"),
        ("steps: [[0.5, 1.0], [1.0, -2.0]]", "steps: []", "trial 'two': steps is []"),
        ("steps: [[0.5, 1.0], [1.0, -2.0]]", "steps: [[0.0, 1.0]]", "trial 'two': steps is"),
        ("rest: 0.5", f"rest: 1{350 * '0'}", "rest is 1000"),
        ("[1.0, -2.0]", "[1.0, .nan]", "trial 'two': steps is"),
        ("first: 0.1, ", "", "trial 'three': sweep is"),
        ("name: two", "name: one", "trial one is listed twice"),
        ("name: two", "name: ../two", "plain file name"),
        ("seconds: 8.0", "seconds: -8.0", "a time above 0"),
        ("trials:", "trails:", "did you mean trials"),
        ("- {", "{", "cannot read the programme"),
    ],
)  # fmt: skip
def test_a_bad_file_is_refused_with_the_place(old: str, new: str, said: str, tmp_path: Path) -> None:
    text = programme_text(PROGRAMME)
    assert old in text
    path = tmp_path / "mixed.yaml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises((UsageError, DataError)) as refused:
        read_programme(path)
    assert said in str(refused.value)
    assert str(path) in str(refused.value)


def test_a_missing_file_is_said_to_be_missing(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="No such file"):
        read_programme(tmp_path / "none.yaml")


def test_voltages_over_time_replay_the_rehearsal(tmp_path: Path) -> None:
    programme = constant_voltage(AXIS, [1.5], seconds=1.0)
    rehearsal = rehearse(programme, AXIS)
    path = tmp_path / "programme.csv"
    path.write_text(commands_text(programme, rehearsal.commands), encoding="utf-8")
    drive = read_csv(path)
    time = 0.004 * np.arange(round(rehearsal.duration / 0.004))
    replayed = AXIS.simulate(drive.voltage(time), AXIS.state(), sample_time=0.004)[:, 0]
    kept = [(t, y) for t, y in rehearsal.path if 0.0 < t < time[-1]]
    assert np.abs([replayed[round(t / 0.004) - 1] - y for t, y in kept]).max() < 1e-3


def test_steps_and_sweeps_over_time() -> None:
    assert [STEPS.at(t) for t in (0.0, 0.49, 0.51, 1.49, 9.0)] == [1.0, 1.0, -2.0, -2.0, -2.0]
    assert SWEEP.at(0.0) == 2.5
    assert abs(SWEEP.at(20.0)) == pytest.approx(2.5)  # 10 whole cycles
    times = np.linspace(0.0, 20.0, 20001)
    assert np.count_nonzero(np.diff(np.sign([SWEEP.at(t) for t in times]))) == 20


def test_steps_are_drawn_from_their_seed() -> None:
    first, again = (make_programme("steps", AXIS, seconds=5.0) for _ in "ab")
    assert first == again
    train, holdout = first.trials
    assert train.voltage != holdout.voltage
    assert replace(holdout, name="x", voltage=train.voltage) == replace(train, name="x")
