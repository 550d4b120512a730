"""Refit of the whole model to recordings of the independent rig."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from identify.making import own, ratio, rig

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.refit import Refit, default_free, refit
from pneumo_ros.shooting.windows import predict

COULOMB, MASS = "lugre_friction.coulomb_friction", "piston.mass"
SEED = 1


def piece(run: Run, start: float, stop: float) -> Run:
    """Some seconds of a run."""
    a, b = (round(t / run.sample_time) for t in (start, stop))
    assert run.pressure_a is not None
    assert run.pressure_b is not None
    return replace(
        run, position=run.position[a:b], pressure_a=run.pressure_a[a:b], pressure_b=run.pressure_b[a:b],
        measured=run.measured[a:b], input=run.input[a * PARTS : (b - 1) * PARTS],
    )  # fmt: skip


def perturbed(model: Model, names: Sequence[str], share: float = 0.05) -> Model:
    """The model with the named parameters off by up to `share`."""
    rng = np.random.default_rng(SEED)
    return model.with_parameters({name: model[name] * (1.0 + rng.uniform(-share, share)) for name in names})


@lru_cache(maxsize=1)
def whole() -> tuple[Model, Model, Refit]:
    """The rig's own model, the one started from, and the refit to 6 s of steps and 6 s of slow reversals."""
    true, _, steps = rig("train_steps", SEED)
    slow = rig("train_slow", SEED)[2]
    start = perturbed(true, default_free(true))
    return true, start, refit(start, [piece(steps, 0.0, 6.0), piece(slow, 0.0, 6.0)])


def scores(model: Model, name: str) -> Mapping[str, float]:
    """Errors over noise in one-second windows of the first 8 s of a run that was not fitted."""
    run = piece(rig(name, SEED)[2], 0.0, 8.0)
    noise = run.noise
    return {signal: ratio(errors, noise[signal]) for signal, errors in predict(model, run, 1.0).errors.items()}


@pytest.mark.parametrize("name", ["holdout_steps", "holdout_sweep", "holdout_slow"])
def test_held_out_windows_are_predicted_to_the_noise(name: str) -> None:
    _, start, found = whole()
    assert scores(start, name)["position_m"] > 20.0
    after = scores(found.model, name)
    assert after["pressure_a_pa"] < 1.3
    assert after["pressure_b_pa"] < 1.3
    assert after["position_m"] < 3.0


def test_parameters_come_back_and_intervals_hold_them() -> None:
    true, start, found = whole()
    told = [name for name, estimate in found.estimates.items() if estimate.determined]
    assert {COULOMB, "quadratic_drag.coefficient", "arctan_flow.filling_coefficient"} <= set(told)
    for name in told:
        estimate = found.estimates[name]
        assert abs(estimate.value - true[name]) < 0.02 * true[name], name
        assert estimate.low < estimate.value < estimate.high
        assert estimate.before == start[name]
    inside = [found.estimates[name].low <= true[name] <= found.estimates[name].high for name in told]
    assert np.mean(inside) >= 0.7


def test_products_are_not_taken_for_factors() -> None:
    """The valve sees slope times gain: they cannot be distinguished, and both intervals are as wide as the priors."""
    _, _, found = whole()
    for name in ("dead_zone.right_slope", "dead_zone.left_slope", "arctan_flow.voltage_gain"):
        assert not found.estimates[name].determined
        assert found.estimates[name].std <= found.estimates[name].prior


def test_what_is_fixed_stays() -> None:
    _, start, found = whole()
    kept = [name for name in start.parameters if name not in found.estimates]
    assert MASS in kept
    assert "chambers.volume_a" in kept
    assert "lugre_friction.bristle_damping" in kept
    assert all(found.model[name] == start[name] for name in kept)


def test_the_course_goes_down() -> None:
    _, _, found = whole()
    assert found.costs[-1] < 0.02 * found.costs[0]
    assert found.segments == 22
    np.testing.assert_allclose(np.diag(found.correlation), 1.0)


def quick(start: Model, free: Sequence[str], priors: Mapping[str, float] | None = None) -> Refit:
    """A refit of few parameters to 3 s of the model's own steps."""
    return refit(start, [own("steps", seconds=3.0)[2]], free=free, priors=priors)


def test_mass_is_refitted_when_asked_for() -> None:
    true = own("steps", seconds=3.0)[0]
    found = quick(true.with_parameters({MASS: 6.0}), [MASS, COULOMB], priors={MASS: 2.0})
    assert list(found.estimates) == [MASS, COULOMB]
    assert found.model[MASS] == pytest.approx(5.0, rel=0.05)
    assert found.model["lugre_friction.static_friction"] == true["lugre_friction.static_friction"]


def test_a_tight_prior_holds_what_a_wide_one_lets_go() -> None:
    start = own("steps", seconds=3.0)[0].with_parameters({COULOMB: 77.0})
    tight, wide = (quick(start, [COULOMB], priors={COULOMB: std}) for std in (1e-3, 10.0))
    assert tight.model[COULOMB] == pytest.approx(77.0, abs=0.2)
    assert not tight.estimates[COULOMB].determined
    assert wide.model[COULOMB] == pytest.approx(70.0, abs=0.2)
    assert wide.estimates[COULOMB].determined
    assert (tight.estimates[COULOMB].prior, wide.estimates[COULOMB].prior) == (1e-3, 10.0)


def test_what_the_data_do_not_touch_is_not_determined() -> None:
    """The end stops were never reached."""
    found = quick(own("steps", seconds=3.0)[0], [COULOMB, "end_stop.stiffness"])
    assert found.estimates[COULOMB].determined
    assert np.isinf(found.estimates["end_stop.stiffness"].std)
    assert not found.estimates["end_stop.stiffness"].determined


def test_a_spoilt_segment_is_left_out() -> None:
    """Somebody leans on the axis for a quarter of a second: no parameter explains the position."""
    model, _, run = own("steps", seconds=6.0)
    position = run.position.copy()
    position[2600:2850] += 5e-3 * np.sin(np.pi * np.arange(250) / 250)
    found = refit(model.with_parameters({COULOMB: 75.0}), [replace(run, position=position)], free=[COULOMB])
    assert found.left_out == 1
    assert found.model[COULOMB] == pytest.approx(70.0, abs=0.3)


def test_gaps_cost_their_segments_only() -> None:
    model, _, run = own("steps", seconds=3.0)
    measured = run.measured.copy()
    measured[1200:1210] = False
    found = refit(model.with_parameters({COULOMB: 72.0}), [replace(run, measured=measured)], free=[COULOMB])
    assert found.segments == 4
    assert found.model[COULOMB] == pytest.approx(70.0, abs=0.3)


def test_progress_rises_to_one() -> None:
    told: list[float] = []
    model, _, run = own("steps", seconds=3.0)
    refit(model, [run], free=[COULOMB], progress=lambda share, text: told.append(share))
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_what_cannot_be_refitted_is_said() -> None:
    model, _, run = own("steps", seconds=3.0)
    with pytest.raises(UsageError, match=r"lugre_friction\.coulomb_friction"):
        refit(model, [run], free=["lugre_friction.coulomb"])
    with pytest.raises(UsageError, match="at least one free parameter"):
        refit(model, [run], free=[])
    with pytest.raises(UsageError, match=r"the prior of lugre_friction.coulomb_friction is 0 N; .* above 0"):
        refit(model, [run], free=[COULOMB], priors={COULOMB: 0.0})
    with pytest.raises(DataError, match="no segment without a gap"):
        refit(model, [run], free=[COULOMB], segment=10.0)


def test_runs_of_two_rates_are_refitted_together() -> None:
    model, _, run = own("steps", seconds=3.0)
    other = own("steps", sample_time=2e-3, seconds=3.0)[2]
    found = refit(model.with_parameters({COULOMB: 0.95 * model[COULOMB]}), [run, other], free=[COULOMB])
    assert found.model[COULOMB] == pytest.approx(model[COULOMB], rel=0.01)
