"""Refits that continue others, of effects that were switched off, and at bounds."""

from functools import lru_cache

import numpy as np
import pytest
from identify.making import own, rig

from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.refit import Refit, default_free, default_prior, refit, unknowns_of
from pneumo_ros.shooting.segments import cut

VISCOUS, SPOOL = "viscous_friction", "valve_spool_dynamics"
COULOMB = "lugre_friction.coulomb_friction"


def with_effect(model: Model, effect: str, **values: float) -> Model:
    """The model with an effect of the given values."""
    return model.with_effects([*model.effects, effect], {f"{effect}.{key}": value for key, value in values.items()})


@lru_cache(maxsize=1)
def base() -> tuple[Model, Run, Refit]:
    """The rig's own model, a run of the rig with viscous friction, and the refit of a model without to it."""
    true, _, run = rig("train_steps", 4, VISCOUS, 100.0)
    return true, run, refit(load_model(), [run])


@lru_cache(maxsize=1)
def added() -> Refit:
    """The refit that continues from there with viscous friction, from zero."""
    _, run, before = base()
    return refit(with_effect(before.model, VISCOUS, coefficient=0.0), [run], start=before)


@pytest.mark.check
def test_an_effect_added_to_a_refit_is_found_though_that_had_bent_the_rest() -> None:
    true, _, before = base()
    found = added()
    viscous = found.estimates[f"{VISCOUS}.coefficient"]
    assert viscous.value == pytest.approx(100.0, rel=0.05)
    assert viscous.determined
    assert found.costs[-1] < 0.5 * before.costs[-1]
    assert found.model[COULOMB] == pytest.approx(true[COULOMB], rel=0.01)


@pytest.mark.check
def test_a_refit_that_goes_on_ends_as_low_as_one_from_the_default() -> None:
    _, run, _ = base()
    cold = refit(with_effect(load_model(), VISCOUS, coefficient=0.0), [run])
    assert added().costs[-1] < 1.001 * cold.costs[-1]


@pytest.mark.check
def test_priors_stay_where_they_were_when_a_refit_goes_on() -> None:
    """Priors are the knowledge before any data, not the earlier refit, which would count the same data twice."""
    _, _, before = base()
    for name, estimate in added().estimates.items():
        if name in before.estimates:
            assert (estimate.before, estimate.prior) == (load_model()[name], before.estimates[name].prior)


@pytest.mark.check
def test_a_refit_that_goes_on_from_itself_stays() -> None:
    _, run, _ = base()
    again = refit(added().model, [run], start=added())
    assert again.costs[-1] <= added().costs[-1] + 2.0
    for name, estimate in added().estimates.items():
        assert again.model[name] == pytest.approx(estimate.value, abs=0.5 * estimate.std), name


def test_a_share_of_the_segments_determines_nearly_as_much() -> None:
    model, _, run = own("steps", seconds=6.0)
    start = model.with_parameters({COULOMB: 75.0})
    part, every = (refit(start, [run], free=[COULOMB], share=share) for share in (0.3, 1.0))
    assert (part.segments, every.segments) == (3, 11)
    assert part.chosen.tolist() == [0, 5, 10]
    assert part.model[COULOMB] == pytest.approx(70.0, abs=0.5)
    assert part.estimates[COULOMB].std > every.estimates[COULOMB].std
    whole = refit(part.model, [run], free=[COULOMB], start=part)
    assert whole.segments == 11
    assert whole.model[COULOMB] == pytest.approx(every.model[COULOMB], abs=3.0 * every.estimates[COULOMB].std)


def test_what_is_switched_off_may_come_to_its_usual_size() -> None:
    model = with_effect(with_effect(load_model(), VISCOUS, coefficient=0.0), SPOOL, angular_frequency=1000.0)
    assert default_prior(model, f"{VISCOUS}.coefficient") == 30.0
    assert default_prior(model, f"{SPOOL}.angular_frequency") == 920.0
    assert default_prior(model, "dead_zone.right_slope") == 0.05  # neutral, and known: its default is the same
    assert default_prior(model.with_parameters({f"{VISCOUS}.coefficient": 200.0}), f"{VISCOUS}.coefficient") == 10.0


def test_what_is_zero_by_default_has_a_prior() -> None:
    """A rest position of a spring in a range of 20 m; knots, a share and a pressure that are neutral by default."""
    model = load_model()
    for name in ("spring_load", "position_dependent_friction", "heat_exchange", "line_delay", "stribeck_shape"):
        model = with_effect(model, name)
    assert all(default_prior(model, name) > 0.0 for name in model.parameters)
    assert default_prior(model, "spring_load.rest_position") == pytest.approx(0.1)
    assert default_prior(model, "position_dependent_friction.knot_00") == model["position_dependent_friction.knot_12"]
    assert default_prior(model, "line_delay.loss_pressure") == 1e4
    refitted = unknowns_of(model, default_free(model), {})
    assert len(refitted.prior) == len(default_free(model))


def slow_spool(omega: float) -> Run:
    """A run of the default machine with such a spool, without noise."""
    model, _, run = own("steps", noisy=True, seconds=4.0)
    model = with_effect(model, SPOOL, angular_frequency=omega)
    start = model.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([start, model.simulate(run.input, start, parts=PARTS)])
    rng = np.random.default_rng(3)
    noise = [rng.normal(0.0, deviation, len(run)) for deviation in (5e-6, 300.0, 300.0)]
    y, p_a, p_b = (states[:, column] + n for column, n in zip((0, 2, 3), noise, strict=True))
    return Run("spool", run.sample_time, y, p_a, p_b, run.input, run.measured, False)


@pytest.mark.parametrize("omega", [60.0, 300.0])
def test_a_spool_is_found_from_the_upper_bound(omega: float) -> None:
    """Where it adds nothing, its frequency is at its upper bound: steps go down from there."""
    start = with_effect(own("steps", seconds=4.0)[0], SPOOL, angular_frequency=1000.0)
    found = refit(start, [slow_spool(omega)], free=[f"{SPOOL}.angular_frequency"])
    assert found.model[f"{SPOOL}.angular_frequency"] == pytest.approx(omega, rel=0.05)


def test_what_would_cross_a_bound_stays_on_it() -> None:
    """Viscous friction cannot be negative: the other parameters are fitted as without it."""
    model, _, run = own("steps", seconds=4.0)
    start = with_effect(model, VISCOUS, coefficient=0.0).with_parameters({COULOMB: 60.0})
    found = refit(start, [run], free=[f"{VISCOUS}.coefficient", COULOMB], priors={COULOMB: 20.0})
    assert 0.0 <= found.model[f"{VISCOUS}.coefficient"] < 1.0
    assert found.model[COULOMB] == pytest.approx(70.0, abs=0.3)


def test_coarser_segments_start_and_are_driven_alike() -> None:
    model, _, run = own("sweep", seconds=3.0)
    fine = cut(model, [run, run], 0.5)
    coarse = fine.coarser()
    assert (coarse.parts, coarse.step, len(coarse.inputs)) == (PARTS // 2, 2e-4, len(fine.inputs) // 2)
    one, other = (s.simulate(model, s.guess) for s in (fine, coarse))
    np.testing.assert_allclose(other[:, :, 0], one[:, :, 0], atol=2e-5)
    np.testing.assert_allclose(other[:, :, 2:4], one[:, :, 2:4], atol=20.0)
    assert np.abs(one - other).max() > 0.0


def test_default_free_holds_what_is_measured_by_other_means() -> None:
    assert not [name for name in default_free(load_model()) if name.startswith(("piston.", "chambers.", "air."))]
