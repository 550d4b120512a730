"""Which experiments distinguish confusable effects, and which cannot for physical reasons."""

from dataclasses import replace

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.experiment.constant_voltage import constant_voltage
from pneumo_ros.experiment.offers import Offer, Part, menu
from pneumo_ros.experiment.separate import CLEAR, NOTHING, PRIOR, Separation, rivals, separate
from pneumo_ros.experiment.suggestion import best, suggestion
from pneumo_ros.experiment.whitened import Noise
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
MENU = {offer.name: offer for offer in menu(AXIS)}


def found(effect_a: str, effect_b: str, *offers: str | Offer, noise: Noise | None = None) -> dict[str, Separation]:
    """The separations by experiment name."""
    chosen = [MENU[offer] if isinstance(offer, str) else offer for offer in offers]
    return {one.offer.name: one for one in separate(AXIS, effect_a, effect_b, offers=chosen, noise=noise)}


def one_way(direction: int) -> Offer:
    """Two constant voltages, one direction only."""
    both = constant_voltage(AXIS, [0.85, 2.0], 4.0)
    trials = tuple(trial for trial in both.trials if trial.direction == direction)
    return Offer("one-way", "", "constant-voltage", "", (Part(replace(both, trials=trials), {}),))


@pytest.mark.check
@pytest.mark.parametrize("direction", [1, -1])
def test_sliding_one_way_does_not_separate_a_load_from_asymmetric_friction(direction: int) -> None:
    assert found("asymmetric_friction", "constant_load", one_way(direction))["one-way"].separation < 1.5


@pytest.mark.check
def test_a_load_is_not_friction_with_one_ratio_but_friction_with_a_ratio_for_each_level_is_nearly_a_load() -> None:
    ranked = separate(AXIS, "asymmetric_friction", "constant_load", offers=[MENU["constant-voltage"]])
    assert ranked[0].if_a > CLEAR  # 10 % are 3.5 N of load while the piston slides and 5 N where it breaks away
    assert NOTHING < ranked[0].if_b < CLEAR  # 70 + 10 N one way and 70 - 10 N the other, and so at breakaway
    assert ranked[0].where == PRIOR
    sentence = suggestion(ranked, "asymmetric_friction", "constant_load")
    assert "which is little, and repeating it adds little" in sentence


def test_friction_known_before_tells_a_large_load_from_friction_and_hardly_a_small_one() -> None:
    equal = {"asymmetric_friction.ratio": 0.1, "asymmetric_friction.static_ratio": 107.0 / 110.0 - 1.0}  # 7 N each
    both = AXIS.with_effects(
        [*AXIS.effects, "asymmetric_friction", "constant_load"], {**equal, "constant_load.load": 20.0}
    )
    told = separate(both, "asymmetric_friction", "constant_load", offers=[MENU["steps"]])[0]
    assert told.if_a < NOTHING  # a load of -3.5 N, Coulomb and static friction 3.5 N higher: within the 5 % known
    assert told.where == PRIOR
    assert told.if_b > CLEAR  # Coulomb friction of 90 N instead of 70 N is beyond what was known


@pytest.mark.check
def test_a_slow_triangle_shows_the_play_of_a_blocked_pistons_valve_and_jumps_do_not() -> None:
    told = found("valve_hysteresis", "valve_null_offset", "blocked-triangle", "steps", "vent")
    assert list(told) == ["blocked-triangle", "steps", "vent"]
    assert told["blocked-triangle"].separation > 100.0
    assert told["steps"].separation < CLEAR  # limits of the dead zone that wander by a few per cent look alike
    assert told["vent"].separation < 0.1  # no step of it ends near the dead zone


@pytest.mark.check
def test_two_supply_pressures_show_seals_that_pressure_presses_on() -> None:
    told = found("pressure_dependent_friction", "viscous_friction", "full-strokes", "two-supplies", "blocked-triangle")
    assert told["two-supplies"].separation > 1.5 * told["full-strokes"].separation
    assert told["blocked-triangle"].separation < 0.1


def test_leaks_show_at_closed_valve_and_not_without_pressure() -> None:
    told = found("cross_piston_leakage", "valve_internal_leakage", "hold", "vent")
    assert told["hold"].separation > 20.0
    assert told["vent"].separation < 0.1


@pytest.mark.check
def test_pauses_separate_growth_at_rest_from_the_stribeck_curve() -> None:
    told = found("dwell_time_breakaway", "stribeck_shape", "pauses", "fast-reversals", "triangle")
    assert list(told) == ["pauses", "fast-reversals", "triangle"]
    assert told["pauses"].separation > 2.0 * told["fast-reversals"].separation
    assert told["triangle"].separation < 0.1  # it never breaks away


@pytest.mark.check
def test_vented_chambers_show_an_offset_of_their_sensors_which_no_leak_explains() -> None:
    vent = found("pressure_sensor_offset", "leakage_to_atmosphere", "vent")["vent"]
    assert vent.if_a > 10.0
    assert vent.if_b < 0.1  # a leak to the atmosphere has nothing to leak


def test_a_load_of_any_size_is_not_distinguished_from_the_force_on_the_rod() -> None:
    ranked = separate(AXIS, "rod_atmospheric_force", "constant_load", offers=[MENU["steps"], MENU["slow-reversals"]])
    assert max(one.separation for one in ranked) < 0.5
    assert best(ranked) is None
    assert suggestion(ranked, "rod_atmospheric_force", "constant_load").startswith(
        "No experiment on the menu distinguishes"
    )


def test_more_noise_separates_less() -> None:
    quiet = found("payload_mass", "position_sensor_delay", "fast-reversals")["fast-reversals"]
    loud = found("payload_mass", "position_sensor_delay", "fast-reversals", noise=Noise(1e-4, 3000.0))["fast-reversals"]
    assert quiet.separation > CLEAR
    assert loud.separation < 0.3 * quiet.separation
    assert quiet.log_likelihood_ratio == pytest.approx(0.5 * quiet.separation**2)


@pytest.mark.check
def test_an_experiment_that_ends_at_a_stop_is_not_offered() -> None:
    rush = constant_voltage(AXIS, [7.0], 20.0)
    trials = tuple(replace(trial, travel=2.0) for trial in rush.trials)
    wide = replace(rush, low=-0.989, high=0.989, trials=trials)
    reckless = Offer("reckless", "", "reckless", "", (Part(wide, {}),))
    ranked = separate(AXIS, "viscous_friction", "quadratic_drag", offers=[reckless, MENU["slow-reversals"]])
    assert [one.offer.name for one in ranked] == ["slow-reversals", "reckless"]
    assert "end stop" in ranked[1].refused
    chosen = best(ranked)
    assert chosen is not None
    assert chosen.offer.name == "slow-reversals"


@pytest.mark.check
def test_the_sentence_says_which_why_and_how() -> None:
    ranked = separate(AXIS, "valve_hysteresis", "valve_null_offset", offers=[MENU["blocked-triangle"], MENU["steps"]])
    sentence = suggestion(ranked, "valve_hysteresis", "valve_null_offset", "my_axis.yaml")
    assert "block the piston near mid stroke" in sentence
    assert "pneumo experiment blocked-triangle --model my_axis.yaml" in sentence
    assert f"{ranked[0].separation:.1f} noise deviations" in sentence
    assert "pressure in chamber" in sentence
    assert ranked[1].separation > NOTHING
    chosen = best(ranked, by_hand=False)
    assert chosen is not None
    assert chosen.offer.name == "steps"


def test_an_effect_of_the_model_keeps_its_value_and_leaves_for_the_other() -> None:
    model = AXIS.with_effects([*AXIS.effects, "constant_load"], {"constant_load.load": 33.0})
    first, second = rivals(model, "constant_load", "asymmetric_friction")
    assert first["constant_load.load"] == 33.0
    assert first.effects == model.effects
    assert "constant_load" not in second.effects
    assert second["asymmetric_friction.ratio"] == second.specification("asymmetric_friction.ratio").default


def test_what_it_refuses() -> None:
    with pytest.raises(UsageError, match="did you mean constant_load"):
        separate(AXIS, "constant_laod", "spring_load")
    with pytest.raises(UsageError, match="given twice"):
        separate(AXIS, "spring_load", "spring_load")
    with pytest.raises(UsageError, match="no chambers"):
        separate(load_model("emps"), "viscous_friction", "constant_load")
