"""A servo in its own position loop, recorded with its goal and no command: read, judged, fitted, imported."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pneumo_ros.command.main import main
from pneumo_ros.diagnose import polishing, search
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import missing
from pneumo_ros.diagnose.polishing import longest, polish
from pneumo_ros.diagnose.search import Search
from pneumo_ros.errors import DataError
from pneumo_ros.identify import by_motion
from pneumo_ros.plant import Model, load_model, save_model
from pneumo_ros.reading.read import read_run
from pneumo_ros.records import read_recording, write_recording
from pneumo_ros.runs.inputs import measured_inputs, measuring
from pneumo_ros.shooting.estimates import Refit
from pneumo_ros.shooting.segments import Segments

N, DT, NOISE = 3000, 2e-3, 1e-4
MOTOR = "dc_motor.force_per_volt"
SERVO = """/**:
  ros__parameters:
    effects: [position_loop, dc_motor, lugre_friction, pendulum_load]
    piston: {mass: 0.007, area_a: 1.0e-4, area_b: 1.0e-4, stroke: 7.0}
    position_loop: {proportional_gain: 1.0}
    dc_motor: {force_per_volt: 0.1, back_emf: 0.4, source_voltage: 7.4}
    lugre_friction: {static_friction: 0.03, coulomb_friction: 0.02, stribeck_velocity: 0.2, bristle_stiffness: 20.0,
      bristle_damping: 0.02, breakaway_ratio: 0.9}
    pendulum_load: {amplitude: 0.48, hanging: 0.0, radius: 1.0}
"""


def goal(seed: int) -> np.ndarray:
    """A smooth goal (N,) [rad], another one for each seed."""
    time = np.arange(N) * DT
    return 0.8 * np.sin((1.5 + seed) * time) + 0.3 * np.sin(5.0 * time + seed)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs at different gains, written with goal and gain alone, and the machine file."""
    folder, random = tmp_path_factory.mktemp("servo"), np.random.default_rng(3)
    (folder / "servo.yaml").write_text(SERVO)
    model = load_model(folder / "servo.yaml")
    for k, gain in enumerate((0.6, 1.2)):
        y, wanted = moved(model, gain, goal(k)), goal(k)
        write_recording(
            folder / f"run_{k}", time=np.arange(N) * DT, position=y + random.normal(0.0, NOISE, N),
            further={"reference": wanted, "loop_gain": np.full(N, gain)},
        )  # fmt: skip
    return folder


def moved(model: Model, gain: float, wanted: np.ndarray) -> np.ndarray:
    """Positions (N,) under a goal."""
    held = measured(model).inputs
    given = {"U": np.zeros(N), "reference": wanted, "loop_gain": np.full(N, gain)}
    states = measured(model).simulate(np.stack([given[n][:-1] for n in held], axis=1), model.state(), sample_time=DT)
    return np.concatenate([[0.0], states[:, 0]])


def measured(model: Model) -> Model:
    """With the recorded gain in place of its constant."""
    return model.measuring(("loop_gain",))


def judged(folder: Path, machine: str, capsys: pytest.CaptureFixture[str]) -> tuple[float, str]:
    """Residual over noise of the momentum equation, and what was said beside it."""
    main(["compare", str(folder / "run_0"), "--model", str(folder / machine), "--json", "-"])
    out, said = capsys.readouterr()
    return json.loads(out)["equations"]["momentum"]["ratio_to_noise"], said


def test_the_goal_and_the_recorded_gain_drive_the_loop(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    right, said = judged(folder, "servo.yaml", capsys)
    assert right < 2.0  # the goal is known at the samples alone
    assert "Judged: momentum, in its position loop" in said
    assert "gain of the position loop is measured, in place of position_loop.proportional_gain" in said
    weak = load_model(folder / "servo.yaml").with_parameters({"dc_motor.force_per_volt": 0.08})
    save_model(weak, folder / "weak.yaml")
    assert judged(folder, "weak.yaml", capsys)[0] > 5.0 * right


def test_without_a_goal_it_says_what_is_missing(folder: Path, tmp_path: Path) -> None:
    one = read_recording(folder / "run_0")
    write_recording(tmp_path / "bag", time=one.time, position=one.position, effort=np.ones(len(one)))
    with pytest.raises(DataError, match="no position/reference, which effect position_loop of 'servo' reads"):
        read_run(tmp_path / "bag", load_model(folder / "servo.yaml"))


def test_only_what_acts_on_the_servo_is_tried(folder: Path) -> None:
    model = load_model(folder / "servo.yaml")
    run = read_run(folder / "run_0", model).run
    found = missing(measuring(model, [run]), measured_inputs([run]))
    assert {"voltage_sag", "drive_delay", "load_dependent_friction", "viscous_friction"} <= {*found}
    assert not {"supply_pressure_droop", "command_delay", "dead_volume"} & {*found}


def test_segments_of_a_loop_are_whole_recordings_or_what_gaps_leave(folder: Path) -> None:
    run = read_run(folder / "run_1", load_model(folder / "servo.yaml")).run
    assert longest([run, run]) == N - 1
    assert longest([run, run], 1.0) * DT == pytest.approx(1.0)
    gap = replace(run, measured=np.abs(np.arange(N) - 1000) > 2)
    assert longest([run, gap]) == (N - 1) // 2
    assert longest([replace(run, measured=np.zeros(N, dtype=bool))]) * DT <= 1.0


@pytest.mark.check
def test_predictions_fit_whole_recordings_of_a_loop(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Short segments would take in with their free starts what parameters explain; bristles show as well."""
    truth = load_model(folder / "servo.yaml")
    off = truth.with_parameters({MOTOR: 0.09, "lugre_friction.bristle_stiffness": 40.0}).with_uncertainty({MOTOR: 0.02})
    run = read_run(folder / "run_1", off).run
    model = measuring(off, [run])
    known = Fitter(model, [run], [run], []).known(model, presliding=True).names
    assert "lugre_friction.bristle_stiffness" in known
    fits, usual = list[tuple[float, float, float]](), polishing.refit_segments

    def noted(begin: Model, segments: Segments, *others: Any, **more: Any) -> Refit:
        found = usual(begin, segments, *others, **more)
        fits.append((begin[MOTOR], segments.samples * segments.sample_time, found.model[MOTOR]))
        return found

    monkeypatch.setattr(polishing, "refit_segments", noted)
    found = polish(Fitter(model, [run], [run], []), model, [run], 4)
    (first, short, found_first), (second, long, _) = fits
    assert (first, second) == (0.09, found_first)
    assert (short, long) == (pytest.approx(1.0), pytest.approx((N - 1) * DT))
    assert found.segments == 1
    assert {*found.estimates} == {*known}
    assert found.model[MOTOR] == pytest.approx(truth[MOTOR], rel=0.01)


def test_a_loop_is_fitted_from_the_values_of_the_machine_file_too(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its equations are biased; and what fits whole recordings worse than before is not taken."""
    runs = [read_run(folder / f"run_{k}", load_model(folder / "servo.yaml")).run for k in range(2)]
    model, effect = measuring(load_model(folder / "servo.yaml"), runs), "viscous_friction"
    begins, usual = list[Model](), search.polish

    def noted(fitter: Fitter, begin: Model, *others: Any, **more: Any) -> Refit:
        begins.append(begin)
        found = usual(fitter, model, [runs[0]], 4)
        return replace(found, model=begin.with_parameters({MOTOR: 0.1}), costs=(1.0 + len(begins),))

    monkeypatch.setattr(search, "polish", noted)
    larger = model.with_effects([*model.effects, effect], {f"{effect}.coefficient": 0.05, MOTOR: 0.08})
    found = Search(model, runs[:1], runs[1:]).settled(larger, model.with_parameters({MOTOR: 0.09}))
    assert [(one[MOTOR], one[f"{effect}.coefficient"]) for one in begins] == [(0.09, 0.05), (0.1, 0.0)]
    assert found[f"{effect}.coefficient"] == 0.05  # the cheaper of both, which predicts whole recordings better
    assert found[MOTOR] == 0.1


def test_the_voltage_sags_by_the_ratio_of_resistances() -> None:
    """A motor that stalls at full duty has V_0 / (1 + r), whatever its size; one that generates raises the voltage."""
    library = load_model("axis").library
    drop = library.find("voltage_sag").equations
    assert drop(0.0, 1.0, 0.25, 0.3, 7.4) == pytest.approx(7.4 * 0.2)
    assert drop(0.0, 0.0, 0.25, 0.3, 7.4) == 0.0
    assert drop(30.0, 1.0, 0.25, 0.3, 7.4) < 0.0


def test_its_friction_is_identified(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two runs determine Coulomb friction and the motor within their intervals, from values that are a quarter off."""
    truth = load_model(folder / "servo.yaml")
    off = truth.with_parameters({"lugre_friction.coulomb_friction": 0.025, "lugre_friction.static_friction": 0.035})
    save_model(off, folder / "off.yaml")
    runs = [str(folder / f"run_{k}") for k in range(2)]
    assert main(["compare", *runs, "--model", str(folder / "off.yaml"), "--fit", *runs, "--json", "-"]) in (0, 1)
    found = json.loads(capsys.readouterr().out)["refit"]["parameters"]["lugre_friction.coulomb_friction"]
    assert abs(found["value"] - 0.02) < max(3.0 * found["std"], 0.001)


def test_identify_takes_a_goal_without_a_command(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The loop drives: friction and motor are found from values that are a quarter and a tenth off."""
    truth = load_model(folder / "servo.yaml")
    wanted = {"lugre_friction.coulomb_friction": 0.025, "dc_motor.force_per_volt": 0.09}
    off = truth.with_parameters(wanted).with_uncertainty({name: 0.3 * value for name, value in wanted.items()})
    save_model(off, folder / "guess.yaml")
    monkeypatch.setattr(by_motion, "parameters_of", lambda *_: tuple(wanted))  # all take longer
    words = ["--model", str(folder / "guess.yaml"), "--out", str(folder / "found.yaml"), "--json", "-"]
    assert main(["identify", str(folder / "run_1"), *words]) == 0
    out, said = capsys.readouterr()
    assert "Judged: momentum, in its position loop" in said
    assert json.loads(out)["motion"]["in_position_loop"]
    found = load_model(folder / "found.yaml")
    assert found["position_loop.proportional_gain"] == truth["position_loop.proportional_gain"]
    for name, share in {"lugre_friction.coulomb_friction": 0.1, "dc_motor.force_per_volt": 0.01}.items():
        assert found[name] == pytest.approx(truth[name], rel=share), name


def test_a_table_gives_goal_and_gain(tmp_path: Path) -> None:
    rows = [f"{0.01 * k},{0.01 * k},{0.02 * k},{int(k > 50)}" for k in range(100)]
    (tmp_path / "run.csv").write_text("\n".join(["t (s),x (rad),goal (rad),power", *rows]))
    plan = """time: t (s)
constants: {kp: 2.0}
signals:
  position: x (rad)
  reference: goal (rad)
  loop_gain: {columns: [power], gains: [kp], unit: "1"}
  motor_on: {column: power, unit: "1"}
"""
    (tmp_path / "map.yaml").write_text(plan)
    words = [str(tmp_path / "run.csv"), "--map", str(tmp_path / "map.yaml"), "--out", str(tmp_path / "bag")]
    assert main(["import", *words]) == 0
    found = read_recording(tmp_path / "bag").signals
    assert found["reference"][-1] == pytest.approx(1.98)
    assert {*found["loop_gain"].tolist()} == {0.0, 2.0}
