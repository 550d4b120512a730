"""Prediction windows: only the true machine scores near the noise."""

from dataclasses import replace

import numpy as np
import pytest
from identify.making import own, ratio, rig

from pneumo_ros.equations.guess import first_guess
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.windows import free_run, predict

KINDS = ["steps", "sweep", "slow"]


def scores(model: Model, run: Run, horizon: float = 1.0) -> dict[str, float]:
    """Windowed errors in noise floors, by signal."""
    noise = run.noise
    return {name: ratio(errors, noise[name]) for name, errors in predict(model, run, horizon).errors.items()}


@pytest.mark.parametrize("kind", KINDS)
def test_the_true_machine_scores_one(kind: str) -> None:
    model, _, run = own(kind)
    found = scores(model, run)
    assert 0.9 < found["position_m"] < 1.3
    assert 0.95 < found["pressure_a_pa"] < 1.05
    assert 0.95 < found["pressure_b_pa"] < 1.05


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.check)])
@pytest.mark.parametrize("name", ["train_steps", "train_sweep", "train_slow", "train_creep"])
def test_the_true_machine_scores_one_on_the_independent_rig(name: str, seed: int) -> None:
    """The rig shares no code with the plant: with the rig's own parameters its recordings are predicted to the noise.

    In creep the windows are full of breakaways, which magnify the remaining error of a start.
    """
    model, _, run = rig(name, seed)
    found = scores(model, run)
    assert found["position_m"] < (1.3 if name == "train_creep" else 1.25)
    assert found["pressure_a_pa"] < 1.05
    assert found["pressure_b_pa"] < 1.05


@pytest.mark.parametrize("name", ["train_sweep", "train_creep"])
def test_smoothed_signals_alone_give_no_start(name: str) -> None:
    """Why starts are estimated: with the true parameters, windows from first guesses miss by many times the noise."""
    model, _, run = rig(name)
    starts = np.arange(0, len(run) - 1000, 1000)
    ends = model.simulate_lanes(
        run.input, first_guess(model, run, starts), samples=1000, first=starts * PARTS, parts=PARTS
    )  # fmt: skip
    errors = ends[:, :, 0] - run.position[starts[:, None] + np.arange(1, 1001)]
    assert ratio(errors, run.noise["position_m"]) > 5.0 * scores(model, run)["position_m"]


def test_a_machine_off_by_five_per_cent_of_friction_does_not() -> None:
    model, _, run = rig("train_steps")
    wrong = model.with_parameters({"lugre_friction.coulomb_friction": 1.05 * model["lugre_friction.coulomb_friction"]})
    assert scores(wrong, run)["position_m"] > 20.0


@pytest.mark.parametrize("sample_time", [5e-4, 4e-3, 1e-2])
def test_other_rates(sample_time: float) -> None:
    model, _, run = own("steps", sample_time, seconds=10.0)
    assert max(scores(model, run).values()) < 1.3


@pytest.mark.parametrize("horizon", [0.1, 0.5, 3.0])
def test_other_horizons(horizon: float) -> None:
    model, _, run = own("steps")
    assert max(scores(model, run, horizon).values()) < 1.3


def test_errors_are_model_minus_measurement_at_the_same_sample() -> None:
    model, _, run = own("sweep", noisy=False, seconds=5.0)
    found = predict(model, run, 0.5)
    assert found.start.tolist() == list(range(0, 4500, 500))
    assert found.errors["position_m"].shape == (9, 500)
    assert np.abs(found.errors["position_m"]).max() < 1e-6  # a sample of shift would be 1e-4
    rows = found.start[:, None] + np.arange(1, 501)
    np.testing.assert_array_equal(found.errors["pressure_b_pa"], found.states[:, :, 3] - run.pressure_b[rows])


def test_a_gap_takes_the_window_it_cuts() -> None:
    model, _, run = own("steps", seconds=5.0)
    measured = run.measured.copy()
    measured[1500:1520] = False
    assert predict(model, replace(run, measured=measured), 1.0).start.tolist() == [0, 2000, 3000]


def test_a_free_run_starts_once_and_hides_gaps() -> None:
    model, _, run = own("steps", seconds=5.0)
    measured = run.measured.copy()
    measured[1500:1520] = False
    found = free_run(model, replace(run, measured=measured))
    assert found.start.tolist() == [0]
    errors = found.errors["position_m"]
    assert errors.shape == (1, 4999)
    assert np.flatnonzero(np.isnan(errors[0])).tolist() == list(range(1499, 1519))
    assert ratio(errors, run.noise["position_m"]) < 2.0


def test_a_free_run_of_the_true_machine_stays_near_the_rig() -> None:
    """20 s of strokes: the influence of the start decays to a few micrometres."""
    model, _, run = rig("train_steps")
    found = free_run(model, run)
    assert ratio(found.errors["position_m"], run.noise["position_m"]) < 3.0


@pytest.mark.parametrize(
    ("horizon", "words"),
    [
        (30.0, "no window of 30 s without a gap in its 5 s; give a shorter --horizon"),
        (float("inf"), "no window of inf s"),
        (float("nan"), "no window of nan s"),
        (1e-3, "holds fewer than two samples of steps, 0.001 s apart; give a longer --horizon"),
        (-1.0, "longer --horizon"),
    ],
)
def test_horizons_that_do_not_fit(horizon: float, words: str) -> None:
    model, _, run = own("steps", seconds=5.0)
    with pytest.raises(UsageError, match=words):
        predict(model, run, horizon)


def test_positions_in_millimetres_are_refused() -> None:
    model, _, run = own("steps", seconds=5.0)
    with pytest.raises(DataError, match="outside the stroke"):
        predict(model, replace(run, position=1e3 * run.position), 1.0)
