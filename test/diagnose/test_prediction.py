"""Prediction errors as one number, and which of two counts as better."""

import numpy as np
import pytest

from pneumo_ros.diagnose.prediction import pays, recordings, removed, typical_error
from pneumo_ros.diagnose.search import Search
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.windows import fitting_horizon

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


def test_what_is_removed_is_a_share_of_the_squares_beyond_noise() -> None:
    half = {"position_m": float(np.sqrt(0.5 * (10.0**2 + 1.0))), "pressure_a_pa": 1.0}
    assert removed(BEFORE, half) == pytest.approx(0.5)
    assert removed(BEFORE, {"position_m": 1.0, "pressure_a_pa": 1.0}) == 1.0
    assert removed(half, BEFORE) < 0.0


def test_of_noise_alone_hardly_anything_can_be_removed() -> None:
    assert removed({"position_m": 1.01}, {"position_m": 1.0}) == pytest.approx(0.2, abs=0.01)


def lasting(seconds: float) -> Run:
    """A run without motion."""
    n = round(1000.0 * seconds) + 1
    return Run(f"{seconds}", 1e-3, np.zeros(n), None, None, np.zeros((n - 1) * PARTS), np.ones(n, dtype=bool), True)


def test_every_window_belongs_to_a_recording() -> None:
    assert recordings([lasting(5.0), lasting(2.5)]).tolist() == [0, 0, 0, 0, 0, 1, 1]


@pytest.mark.parametrize(("shortest", "horizon"), [(5.0, 1.0), (1.1, 1.0), (1.0, 0.5), (0.8, 0.5), (0.15, 0.1)])
def test_short_strokes_are_predicted_over_less_than_a_second(shortest: float, horizon: float) -> None:
    assert fitting_horizon([lasting(5.0), lasting(shortest)]) == horizon
    assert fitting_horizon([lasting(5.0), lasting(shortest)], 0.1) == 0.1


def test_gaps_shorten_the_horizon() -> None:
    run = lasting(5.0)
    run.measured[::450] = False
    assert fitting_horizon([lasting(5.0), run]) == 0.2


@pytest.mark.parametrize(
    ("wanted", "why"), [(2.0, "lasts 0.8 s"), (0.0, "not a length"), (float("nan"), "not a length")]
)
def test_a_horizon_that_no_run_has_is_refused_before_anything_is_fitted(wanted: float, why: str) -> None:
    with pytest.raises(UsageError, match=why):
        Search(load_model("emps"), [lasting(5.0)], [lasting(0.8)], horizon=wanted)
