"""Finite-difference steps of a refit: small beside the value, however little a data sheet says of it."""

import numpy as np
import pytest
from identify.jogging import sheet

from pneumo_ros.plant import load_model
from pneumo_ros.shooting.problem import Unknowns, largest_step
from pneumo_ros.shooting.refit import default_free, unknowns_of

GAIN = "arctan_flow.voltage_gain"


def vague() -> Unknowns:
    """The default machine, the gain of whose valve is known to ten times its value only."""
    model = load_model("axis")
    model = model.with_uncertainty({GAIN: 10.0 * model[GAIN]})
    return unknowns_of(model, default_free(model), {})


@pytest.mark.parametrize("most", [0.01, 0.1])
def test_a_step_is_a_small_share_of_its_value(most: float) -> None:
    unknowns = vague()
    k = unknowns.names.index(GAIN)
    assert 1e-2 * unknowns.prior[k] == pytest.approx(0.1 * unknowns.begin[k])
    for share in (1.0, 0.2):
        steps = unknowns.steps(share * unknowns.begin, most)
        assert np.all(steps != 0.0)
        assert steps[k] == pytest.approx(most * share * unknowns.begin[k])
        assert np.all(np.abs(steps) <= 1.0001 * most * share * np.abs(unknowns.begin))


def test_what_is_known_well_keeps_its_step() -> None:
    unknowns = vague()
    k = unknowns.names.index("lugre_friction.coulomb_friction")
    assert unknowns.steps(unknowns.begin, 0.01)[k] == pytest.approx(1e-2 * unknowns.prior[k])


def test_a_value_that_has_gone_to_nothing_is_stepped_from_still() -> None:
    unknowns = vague()
    steps = unknowns.steps(1e-9 * unknowns.begin, 0.01)
    assert np.all(np.abs(steps) >= 0.99e-4 * np.abs(unknowns.centre))


def test_steps_turn_back_at_a_bound_and_have_a_size_about_zero() -> None:
    model = load_model("axis")
    model = model.with_effects([*model.effects, "valve_null_offset"], {"valve_null_offset.offset": 0.0})
    unknowns = unknowns_of(model, default_free(model), {})
    k = unknowns.names.index("valve_null_offset.offset")
    assert unknowns.steps(unknowns.begin, 0.01)[k] == pytest.approx(1e-2 * unknowns.prior[k])
    finite = np.where(np.isfinite(unknowns.high), unknowns.high, unknowns.begin)
    steps = unknowns.steps(finite, 0.01)
    assert np.all(finite + steps <= unknowns.high)


def test_a_prior_stays_where_it_is_when_a_fit_begins_elsewhere() -> None:
    """A prior about the start would count the recordings again with every fit."""
    sheet = load_model("axis")
    begun = sheet.with_parameters({GAIN: 2.0 * sheet[GAIN]})
    unknowns = unknowns_of(begun, default_free(begun), {}, centres={GAIN: sheet[GAIN]})
    k = unknowns.names.index(GAIN)
    assert (unknowns.begin[k], unknowns.centre[k]) == (2.0 * sheet[GAIN], sheet[GAIN])
    others = np.arange(len(unknowns.names)) != k
    np.testing.assert_array_equal(unknowns.centre[others], unknowns.begin[others])


def test_steps_are_coarser_where_valves_open_and_close() -> None:
    assert largest_step(sheet("pulses")) == pytest.approx(0.1)
    assert largest_step(sheet("regulators")) == largest_step(load_model("axis")) == pytest.approx(0.01)
