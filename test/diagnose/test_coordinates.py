"""Coordinates of candidates: neutral at zero, usual at one, within bounds, back and forth."""

from dataclasses import replace

import numpy as np
import pytest

from pneumo_ros.diagnose.coordinates import coordinates, forms, starts
from pneumo_ros.diagnose.hypothesis import everything, missing, vectors
from pneumo_ros.plant import load_model

MODEL = load_model("axis")
MISSING = missing(MODEL, MODEL.inputs)


def test_every_catalogue_effect_that_can_fade_in_is_a_candidate() -> None:
    assert len(MISSING) >= 28
    assert not set(MISSING) & set(MODEL.effects)


@pytest.mark.parametrize("name", sorted(MISSING))
def test_neutral_usual_and_back(name: str) -> None:
    for c in MISSING[name]:
        for u in (-0.4, 0.2, 1.0):
            value = c.value(u)
            assert c.low <= value <= c.high
            assert c.value(c.u(value)) == pytest.approx(value, rel=1e-12)
        if c.is_size and not c.logarithmic:
            assert c.value(0.0) == c.neutral
            assert c.value(1.0) == pytest.approx(c.typical)
        if c.logarithmic:
            assert c.value(0.0) == pytest.approx(c.typical)
            assert c.value(1e3) == c.high


def test_what_does_nothing_by_default_has_a_usual_size_of_its_own_unit() -> None:
    loss = next(c for c in MISSING["line_delay"] if c.name.endswith("loss_pressure"))
    assert 1e3 < loss.typical < 5e4  # Pa, not the six milliseconds of the delay beside it
    knots = {c.typical for c in MISSING["position_dependent_friction"][:25]}
    assert knots == {0.1}
    assert MISSING["position_dependent_friction"][25].typical == 0.3  # of the spot, a form of its own


def test_shapes_are_tried_larger_and_smaller() -> None:
    times = [MISSING["friction_warmup"][1].value(u[1]) for u in starts(MISSING["friction_warmup"])]
    assert sorted(times) == pytest.approx([15.0, 60.0, 240.0])
    assert coordinates(MODEL.library.find("rod_atmospheric_force")) == ()


def test_frequencies_are_tried_finely_with_much_damping() -> None:
    share, frequency, damping = MISSING["load_compliance"]
    tried = [u for u in starts(MISSING["load_compliance"]) if damping.value(u[2]) == pytest.approx(0.2)]
    hertz = np.sort([frequency.value(u[1]) for u in tried if frequency.value(u[1]) != 20.0])
    assert hertz[0] < 5.0
    assert hertz[-1] > 60.0
    assert np.all(hertz[1:] / hertz[:-1] < 1.6)
    assert not share.tuned
    assert not damping.tuned


def test_a_profile_stays_near_neutral_where_no_recording_goes() -> None:
    widths = {name: {c.prior for c in own if c.is_size and not c.logarithmic} for name, own in MISSING.items()}
    assert widths["position_dependent_friction"] == {1.0, 30.0}  # of a tenth each, as in the score; and of a spot
    assert {30.0} == set().union(*(w for name, w in widths.items() if name != "position_dependent_friction"))


def test_a_place_is_tried_all_along_its_range() -> None:
    """A spot on the stroke: a place is no logarithm, is as likely anywhere, and belongs to one form of its effect."""
    profile, spot = forms(MISSING["position_dependent_friction"])
    assert (len(profile), len(starts(profile))) == (25, 1)
    height, centre, width = spot
    assert [c.is_place for c in spot] == [False, True, False]
    assert (centre.logarithmic, width.logarithmic) == (False, True)
    assert centre.value(centre.expected) == pytest.approx(1.0 / np.sqrt(12.0))  # deviation along a stroke of length 1
    assert (height.expected, width.expected) == (1.0, 1.0)
    tried = sorted({round(centre.value(u[1]), 9) for u in starts(spot)})
    assert tried == pytest.approx(sorted([*np.arange(-0.475, 0.48, 0.05), 0.0]))
    endless = replace(centre, low=-1e9, high=1e9)
    assert len(starts((height, endless, width))) < 100


def test_one_model_holds_all_candidates_each_neutral() -> None:
    whole = everything(MODEL, MISSING)
    assert set(whole.effects) == {*MODEL.effects, *MISSING}
    assert all(whole[c.name] == c.neutral for each in MISSING.values() for c in each if c.is_size)
    moved = vectors(whole, [{}, {"viscous_friction.coefficient": 7.0}])
    assert np.flatnonzero(moved[1] - moved[0]).tolist() == [
        list(whole.parameters).index("viscous_friction.coefficient")
    ]
