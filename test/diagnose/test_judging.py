"""Candidates judged by their scores, and sizes large enough to matter."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from pneumo_ros.diagnose.candidate import MATERIAL, Candidate
from pneumo_ros.diagnose.coordinates import coordinates, forms
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.judging import best_forms, by_score, lag, magnitude, size_in, swing, undetermined
from pneumo_ros.diagnose.score import AS_MUCH, MARGIN, Score
from pneumo_ros.diagnose.steps import Step, without
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.plant.effect import Effect, Parameter

MODEL = load_model("axis")
LOAD = coordinates(MODEL.library.find("constant_load"))


@pytest.mark.parametrize(
    ("effect", "values", "material"),
    [
        ("pressure_sensor_offset", {"offset_a": 85.0, "offset_b": 19.0}, False),  # of a usual 5 kPa
        ("pressure_sensor_offset", {"offset_a": 85.0, "offset_b": -900.0}, True),
        ("valve_spool_dynamics", {"angular_frequency": 900.0}, False),  # hardly slower than the command
        ("valve_spool_dynamics", {"angular_frequency": 300.0}, True),
    ],
)
def test_sizes_are_given_in_usual_sizes(effect: str, values: dict[str, float], material: bool) -> None:
    given = {f"{effect}.{key}": value for key, value in values.items()}
    model = MODEL.with_effects([*MODEL.effects, effect], given)
    assert (size_in(model, effect) > MATERIAL) is material


def test_a_spool_damped_like_a_first_order_is_as_large_as_its_lag() -> None:
    own = coordinates(MODEL.library.find("valve_spool_dynamics"))
    ringing, lagging = (magnitude(own, np.array([own[0].u(400.0), own[1].u(zeta)])) for zeta in (0.5, 2.8))
    assert ringing == pytest.approx(magnitude(own, np.array([own[0].u(400.0), own[1].u(0.7)])))
    assert lagging == pytest.approx(4.0 * ringing)


@pytest.mark.parametrize(
    ("effect", "values", "std", "expected"),
    [
        ("asymmetric_friction", {"ratio": -0.027}, {"ratio": 0.029, "static_ratio": 0.1}, True),
        ("asymmetric_friction", {"ratio": -0.07}, {"ratio": 0.029, "static_ratio": 0.1}, False),
        ("asymmetric_friction", {"ratio": -0.027}, {"ratio": 0.029, "static_ratio": np.inf}, True),
        ("asymmetric_friction", {"ratio": -0.07}, {"ratio": 0.029, "static_ratio": np.inf}, False),
        # the data determine nothing
        ("asymmetric_friction", {"ratio": -0.027}, {"ratio": np.inf, "static_ratio": np.inf}, False),
        (
            "leakage_to_atmosphere",  # of the other chamber
            {"conductance_a": 5e-10, "conductance_b": 1e-13},
            {"conductance_a": 1e-11, "conductance_b": 1e-11},
            False,
        ),
        (
            "valve_spool_dynamics",  # its damping is a shape
            {"angular_frequency": 960.0, "damping_ratio": 0.7},
            {"angular_frequency": 30.0, "damping_ratio": 0.01},
            True,
        ),
    ],
)
def test_a_size_within_its_deviations_of_zero_may_be_zero(
    effect: str, values: dict[str, float], std: dict[str, float], expected: bool
) -> None:
    model = MODEL.with_effects([*MODEL.effects, effect], {f"{effect}.{key}": x for key, x in values.items()})
    assert undetermined(model, effect, {f"{effect}.{key}": x for key, x in std.items()}) is expected


def candidate(**changed: Any) -> Candidate:
    """A candidate that may be added, but for what is changed."""
    h = Hypothesis("constant_load", LOAD, np.array([1.0]), np.empty(0), np.empty(0), t=50.0)
    given: dict[str, Any] = {"gain": {"momentum": 0.9}, "size": 1.0, "share": 1.0, "first": True}
    return Candidate(h, np.empty(0), **given | {"score": Score(90.0, 10.0)} | changed)


def test_a_round_whose_effect_vanished_says_so() -> None:
    one = candidate()
    step = Step(MODEL, (one,), one, (), {}, {})
    assert without(step, ["spring_load"], "it is gone").added is one
    changed = without(step, ["constant_load"], "it is gone")
    assert changed.added is None
    assert changed.candidates[0].objections == ("it is gone",)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({}, ""),
        ({"score": Score(MARGIN - 2.1, 2.0)}, "gain 7 nats with it, and 8 are asked"),
        ({"score": Score(MARGIN - 1.9, 2.0)}, ""),
        ({"score": Score(200.0, -0.2)}, "held-out recordings lose 0.2 nats with it"),
        ({"score": Score(200.0, -0.2), "known": 1.1 * MARGIN}, ""),
        ({"score": Score(200.0, -1.1 * MARGIN), "known": 1.1 * MARGIN}, "held-out recordings lose 8.8 nats with it"),
        ({"size": 0.9 * MATERIAL}, "its size is only 0.045 times the usual one"),
        ({"share": 0.3}, ""),
        ({"share": 0.3, "first": False}, "removes only 30 % of the misfit beyond noise"),
        ({"share": 0.2}, "removes only 20 % of the misfit beyond noise"),
        (
            {"share": 0.01, "pays": 0.2},
            "removes only 1 % of the misfit beyond noise, and removes only 20 % of the error of predictions",
        ),
        ({"share": -1504.0}, "removes nothing of the misfit beyond noise"),
        ({"lag": 0.5}, "shorter than a sample"),
        ({"swing": 0.6}, "oscillates within two samples"),
        ({"refused": "it is known"}, "it is known"),
    ],
)
def test_a_candidate_is_refused_for_one_reason_each(changed: dict[str, Any], why: str) -> None:
    objections = candidate(**changed).objections
    assert len(objections) == bool(why)
    assert all(why in one for one in objections)


@pytest.mark.parametrize(
    ("changed", "undecided"),
    [
        ({"score": Score(5.0, 2.0)}, True),
        ({"score": Score(7.7, -0.1), "known": 1.1 * MARGIN}, True),
        ({"score": Score(5.0, 4.0)}, False),  # it is enough
        ({"score": Score(-5.0, 4.0)}, False),  # they speak against it
        ({"score": Score(5.0, -2.0)}, True),
        ({"score": Score(5.0, -2.6)}, False),  # held-out recordings lose more than all together gain
        ({"score": Score(5.0, 2.0), "share": 0.2}, True),  # what is left may be something else
        ({"score": Score(160.0, 60.0), "share": 0.2}, True),  # as that of a rough machine
        ({"score": Score(160.0, -60.0)}, True),
        ({"score": Score(160.0, 60.0), "lag": 0.5, "share": 0.2}, False),
        ({"score": Score(5.0, 2.0), "refused": "it is known"}, False),
    ],
)
def test_what_gains_too_little_and_has_no_other_fault_is_undecided(changed: dict[str, Any], undecided: bool) -> None:
    one = candidate(**changed)
    assert one.undecided is undecided
    step = Step(MODEL, (one,), None, (), {}, {})
    assert step.undecided == ({"constant_load": one} if undecided else {})


def test_the_best_score_comes_first() -> None:
    some = [candidate(score=Score(nats, 1.0)) for nats in (5.0, 50.0, -3.0)]
    assert [one.score.train for one in by_score(some)] == [50.0, 5.0, -3.0]


def test_an_effect_counts_in_its_best_form() -> None:
    """A play before the load is far better than one before the sensor, and a load lies between them."""
    some = [candidate(score=Score(nats, 1.0)) for nats in (5.0, 50.0, -3.0)]
    play = Hypothesis("backlash", (), np.empty(0), np.empty(0), np.empty(0))
    forms = [replace(one, hypothesis=play) for one in (some[2], some[1])]
    found = best_forms([forms[0], some[0], forms[1]])
    assert [(one.name, one.score.train) for one in found] == [("backlash", 50.0), ("constant_load", 5.0)]


@pytest.mark.parametrize(("less", "taken"), [(0.5 * AS_MUCH, 3), (2.0 * AS_MUCH, 25)])
def test_of_forms_that_explain_as_much_the_simpler_one_counts(less: float, taken: int) -> None:
    """A spot of the stroke, and a profile of 25 points that has the same spot."""
    both = forms(coordinates(load_model("axis").library.find("position_dependent_friction")))
    each = [Hypothesis("", own, np.zeros(len(own)), np.empty(0), np.empty(0)) for own in both]
    scores = [Score(50.0, 1.0), Score(50.0 - less, 1.0)]
    some = [replace(candidate(score=score), hypothesis=h) for score, h in zip(scores, each, strict=True)]
    assert [len(one.hypothesis.u) for one in best_forms(some)] == [taken]


class OwnLag(Effect):
    """The spool of a user, whose names are not the catalogue's."""

    corner = Parameter(200.0, "rad/s", "corner frequency", low=5.0, high=1000.0, neutral=1000.0)
    zeta = Parameter(0.7, "1", "damping ratio", low=0.2, high=5.0, role="damping")
    dead_time = Parameter(5e-3, "s", "delay", low=0.0, high=0.2, neutral=0.0, role="delay")
    filter_time = Parameter(0.0, "s", "time constant", low=0.0, high=0.2, neutral=0.0, usual=5e-3, role="low-pass")


def test_an_effect_of_a_user_is_judged_by_roles_not_by_names() -> None:
    own = coordinates(OwnLag)
    ringing, lagging = (np.array([own[0].u(400.0), own[1].u(zeta), 0.0, 0.0]) for zeta in (0.7, 2.8))
    assert magnitude(own, lagging) == pytest.approx(4.0 * magnitude(own, ringing))
    h = Hypothesis("own_lag", own, np.array([0.0, 0.0, 0.06, 0.1]), np.empty(0), np.empty(0))
    assert lag(h, sample_time=1e-3) == pytest.approx(0.8)
    assert lag(replace(h, coordinates=own[:2], u=h.u[:2]), sample_time=1e-3) == np.inf


@pytest.mark.parametrize(("rate", "samples"), [(100.0, 0.637), (1000.0, 6.37)])
def test_half_a_period_of_a_resonance_in_samples(rate: float, samples: float) -> None:
    """At 100 Hz a load of 78.5 Hz gained 35 nats on the default machine, which has none: half the rate is 50 Hz."""
    own = coordinates(MODEL.library.find("load_compliance"))
    u = np.array([c.u(78.5) if c.unit == "Hz" else 1.0 for c in own])
    h = Hypothesis("load_compliance", own, u, np.empty(0), np.empty(0))
    assert swing(h, 1.0 / rate) == pytest.approx(samples, rel=1e-3)
    assert swing(replace(h, coordinates=own[:1], u=u[:1]), 1.0 / rate) == np.inf


def test_an_unknown_role_is_refused() -> None:
    with pytest.raises(
        UsageError, match="role 'dampin' of a parameter is unknown; known are delay, low-pass, play, damping"
    ):
        Parameter(0.7, "1", "damping ratio", role="dampin")
