"""Prediction errors as one number, and which of two counts as better."""

from pneumo_ros.diagnose.prediction import pays, typical_error

BEFORE = {"position_m": 10.0, "pressure_a_pa": 1.0}


def test_one_signal_that_gets_better_pays() -> None:
    assert pays(BEFORE, {"position_m": 9.4, "pressure_a_pa": 1.05})


def test_a_twentieth_is_the_least_that_pays() -> None:
    assert not pays(BEFORE, {"position_m": 9.6, "pressure_a_pa": 1.0})


def test_what_makes_another_signal_worse_does_not_pay() -> None:
    assert not pays(BEFORE, {"position_m": 1.0, "pressure_a_pa": 1.2})


def test_noise_alone_is_a_typical_error_of_one() -> None:
    assert typical_error({"position_m": 1.0, "pressure_a_pa": 1.0}) == 1.0
    assert typical_error(BEFORE) > 7.0
