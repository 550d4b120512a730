"""Effects of which the recordings would not show a usual size."""

from dataclasses import replace

import numpy as np
import pytest

from pneumo_ros.diagnose.coordinates import coordinates, forms
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.score import MARGIN
from pneumo_ros.diagnose.unseen import unseen
from pneumo_ros.plant import load_model


def fitted(name: str, *deviations: float) -> Hypothesis:
    """A candidate whose sizes have these deviations, in usual sizes."""
    none = np.empty(0)
    return Hypothesis(name, (), none, none, none, covariance=np.diag(np.square(deviations)))


def test_what_moves_no_residual_cannot_be_seen() -> None:
    found = unseen([fitted("cushioning", 30.0), fitted("viscous_friction", 0.01)])
    assert list(found) == ["cushioning"]
    assert found["cushioning"] < 0.01


@pytest.mark.parametrize(("deviation", "nats"), [(0.22, None), (0.25, 0.5 * (16.0 - np.log(17.0)))])
def test_a_usual_size_must_gain_what_is_asked(deviation: float, nats: float | None) -> None:
    found = unseen([fitted("spring_load", deviation)])
    assert found == ({} if nats is None else {"spring_load": pytest.approx(nats)})
    assert nats is None or nats < MARGIN


def test_one_size_in_one_shape_is_enough() -> None:
    assert unseen([fitted("leakage_to_atmosphere", 30.0, 0.1)]) == {}
    assert unseen([fitted("heat_exchange", 30.0), fitted("heat_exchange", 0.1), fitted("heat_exchange", 9.0)]) == {}


def test_points_of_a_profile_that_are_uncertain_together_are_seen() -> None:
    """Each of 17 points is uncertain by 0.3 usual sizes, as all of them together resemble more friction."""
    none = np.empty(0)
    together = 0.3**2 * np.ones((17, 17)) + 0.02**2 * np.eye(17)
    profile = Hypothesis("position_dependent_friction", (), none, none, none, covariance=together)
    assert unseen([profile]) == {}
    assert list(unseen([fitted("position_dependent_friction", *[2.0] * 17)])) == ["position_dependent_friction"]


def test_a_form_that_does_not_show_is_not_shown_by_another_one() -> None:
    """A play before the sensor acts where the piston turns, one before the load wherever it is accelerated."""
    none = np.empty(0)
    play = coordinates(load_model("axis").library.find("backlash"))
    before_sensor, before_load = (
        Hypothesis("backlash", form, none, none, none, covariance=np.diag([deviation**2]))
        for form, deviation in zip(forms(play), (30.0, 0.01), strict=True)
    )
    assert list(unseen([before_sensor, before_load])) == ["backlash"]
    assert unseen([before_load]) == {}


def test_a_line_of_the_machine_file_that_stands_in_for_it_costs_one_effect() -> None:
    """After equal rests, a static friction that grows at rest is one that its line states too low."""
    seen = fitted("dwell_time_breakaway", 0.1)
    assert unseen([seen]) == {}
    assert list(unseen([replace(seen, beside_lines=np.eye(1) * 30.0**2, wrong_lines=7.9)])) == ["dwell_time_breakaway"]
    assert unseen([replace(seen, beside_lines=np.eye(1) * 30.0**2, wrong_lines=16.0)]) == {}
