"""Starting states: near the true ones for every start of a window."""

from dataclasses import replace

import numpy as np
import pytest
from identify.making import own, rig

from pneumo_ros.equations.guess import first_guess, guess_states
from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.segments import cut_at
from pneumo_ros.shooting.start import start_states

KINDS = ["steps", "sweep", "slow"]
AT = np.arange(0, 20_000, 500)


@pytest.mark.parametrize("kind", KINDS)
def test_starts_are_near_the_true_states(kind: str) -> None:
    """The median start; `test_windows` tests the errors from the worst ones."""
    model, truth, run = own(kind)
    error = np.median(np.abs(start_states(model, run, AT) - truth[AT]), axis=0)
    stiffness = model["lugre_friction.bristle_stiffness"]
    assert np.all(error * [1.0, 1.0, 1.0, 1.0, stiffness] < [1.5e-6, 3e-4, 60.0, 60.0, 0.5])


def test_the_fit_beats_the_first_guess() -> None:
    """Against the truth, in the state no sensor shows: the force on the bristle after a stop."""
    model, truth, run = own("steps")
    spread = [
        np.std(found[:, 4] - truth[AT, 4]) for found in (first_guess(model, run, AT), start_states(model, run, AT))
    ]
    assert spread[0] > 3.0 * spread[1]


def test_the_first_guess_is_no_surer_than_the_friction_of_a_weak_machine_allows() -> None:
    """The force on the bristle is known within 10 N, or half the static friction where that is less, as of a vane."""
    model, _, run = own("steps")
    weak = model.with_parameters({f"lugre_friction.{one}_friction": 2.0 for one in ("static", "coulomb")})
    for one, known in ((model, 10.0), (weak, 1.0)):
        force = guess_states(one, run, AT).scale[one.states.index("z")] * one["lugre_friction.bristle_stiffness"]
        assert force == pytest.approx(known)


@pytest.mark.parametrize("name", ["train_steps", "train_creep"])
def test_starts_on_the_independent_rig(name: str) -> None:
    model, recorded, run = rig(name)
    error = np.median(np.abs(start_states(model, run, AT) - recorded.truth[AT]), axis=0)
    stiffness = model["lugre_friction.bristle_stiffness"]
    assert np.all(error * [1.0, 1.0, 1.0, 1.0, stiffness] < [1.5e-6, 3e-4, 60.0, 60.0, 1.5])


def test_the_first_and_the_last_sample() -> None:
    model, truth, run = own("sweep")
    at = np.array([0, 1, len(run) - 2, len(run) - 1])
    found = start_states(model, run, at)
    np.testing.assert_allclose(found[:, 0], truth[at, 0], atol=1e-5)
    np.testing.assert_allclose(found[:, 2:4], truth[at, 2:4], atol=200.0)


def test_a_run_shorter_than_what_is_fitted() -> None:
    model, truth, run = own("steps")
    found = start_states(model, first(run, 120), np.array([0, 60, 119]))
    np.testing.assert_allclose(found[:, 0], truth[[0, 60, 119], 0], atol=1e-5)


def test_a_gap_just_before_a_start_is_not_believed() -> None:
    """The values bridged over the gap differ greatly from the true motion."""
    model, truth, run = own("sweep")
    measured = run.measured.copy()
    position = run.position.copy()
    measured[7900:8000] = False
    position[7900:8000] += 0.01
    found = start_states(model, replace(run, position=position, measured=measured), np.array([8020]))
    np.testing.assert_allclose(found[0, 0], truth[8020, 0], atol=1e-5)


def test_a_machine_without_bristles() -> None:
    with_bristles, _, run = own("sweep", seconds=4.0)
    model = with_bristles.with_effects([e for e in with_bristles.effects if e != "lugre_friction"])
    truth = model.simulate(run.input, model.state(p_a=3e5, p_b=3.9e5), parts=10)
    smooth = replace(run, position=np.append(0.0, truth[:, 0]), pressure_a=np.append(3e5, truth[:, 2]))
    smooth = replace(smooth, pressure_b=np.append(3.9e5, truth[:, 3]))
    found = start_states(model, smooth, np.array([1000, 3000]))
    assert found.shape == (2, 4)
    np.testing.assert_allclose(found, truth[[999, 2999]], rtol=1e-4, atol=1e-4)


WRONG = {
    "heavy": {"piston.mass": 500.0},
    "stuck": {"lugre_friction.static_friction": 5000.0, "lugre_friction.coulomb_friction": 4000.0},
    "no supply": {"air.supply_pressure": 1.1e5},
    "soft": {"lugre_friction.bristle_stiffness": 1e3},
}


@pytest.mark.parametrize("name", WRONG)
@pytest.mark.filterwarnings("error")
def test_a_model_that_is_far_off_still_gets_finite_starts(name: str) -> None:
    _, _, run = own("steps", seconds=5.0)
    model = load_model().with_parameters(WRONG[name])
    assert np.isfinite(start_states(model, run, np.arange(0, 5000, 250))).all()


@pytest.mark.filterwarnings("error")
def test_a_dead_sensor_still_gives_finite_starts() -> None:
    model, _, run = own("steps", seconds=5.0)
    dead = replace(run, pressure_a=np.full(len(run), 3e5))
    assert np.isfinite(start_states(model, dead, np.arange(0, 5000, 250))).all()


@pytest.mark.filterwarnings("error")
def test_predictions_that_leave_all_bounds_can_still_be_squared() -> None:
    model, _, run = own("steps", seconds=5.0)
    segments = cut_at(model, [run], [np.array([0, 1000])], 100)
    states = segments.guess.copy()
    states[0, 2], states[1, 0] = 1e200, np.nan
    residuals = segments.residuals(model, states)
    assert np.isfinite(np.sum(residuals**2, axis=2)).all()
    assert np.sqrt(np.mean(residuals**2, axis=2)).min() > 1e8


def first(run: Run, samples: int) -> Run:
    """The first samples of a run."""
    parts = len(run.input) // (len(run) - 1)
    cut = {
        "position": run.position[:samples],
        "pressure_a": run.pressure_a[:samples],
        "pressure_b": run.pressure_b[:samples],
    }
    return replace(run, **cut, input=run.input[: (samples - 1) * parts], measured=run.measured[:samples])


def test_starts_repeat() -> None:
    model, _, run = own("slow")
    np.testing.assert_array_equal(*(_starts(model, run) for _ in range(2)))


def _starts(model: Model, run: Run) -> np.ndarray:
    return start_states(model, run, np.array([2000, 5000]))
