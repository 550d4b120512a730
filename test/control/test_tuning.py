"""Tuning: one cost for all laws; the search improves, stays within the ranges and is repeatable."""

from functools import partial

import pytest
from control.following import AXIS, law_for

from pneumo_ros.control import Law, Pid
from pneumo_ros.control.reference import moves, sine
from pneumo_ros.control.tuning import WORST, Gains, RatedMotion, Search, Weights, cost, costs_here
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Stepper


def plant() -> Stepper:
    return Stepper(AXIS, AXIS.state(p_a=3e5, p_b=3.7e5), sample_time=2e-3)


MOTIONS = [
    RatedMotion(plant, sine(0.1, 0.1), 4.0, 1.0),
    RatedMotion(plant, moves([0.0, 0.06], 2.0, 1.0), 4.0, hold=2.0, unit=3e-4),
]


def test_a_worse_law_costs_more_and_the_valve_costs_too() -> None:
    good, bad = law_for("cascade"), law_for("cascade", damping=5.0, force_rate=2.0)
    assert cost(good, MOTIONS) < 0.5 * cost(bad, MOTIONS)
    assert cost(good, MOTIONS, Weights(activity=1.0)) > cost(good, MOTIONS, Weights(activity=0.0))


def test_it_finds_better_gains_and_repeats() -> None:
    make = partial(law_for, "pid")

    def law(gains: Gains) -> Law:
        return make(**gains)

    told: list[tuple[int, float]] = []
    searches = [
        Search(law({}), costs_here(law, MOTIONS), 14, lambda count, least: told.append((count, least)))
        for _ in range(2)
    ]
    found = [search.run() for search in searches]
    assert found[0] == found[1]
    assert searches[0].least < searches[0].first
    assert searches[0].count <= 14
    assert [count for count, _ in told[:3]] == [2, 3, 4]
    assert cost(make(**found[0]), MOTIONS) == searches[0].least


def test_only_tuned_gains_move_within_their_ranges() -> None:
    def law(gains: Gains) -> Law:
        return law_for("pid", **gains)

    gains = Search(law({}), costs_here(law, MOTIONS[1:]), 8).run()
    assert set(gains) == set(Pid.tuned)
    assert all(Pid.gains[name].low <= value <= Pid.gains[name].high for name, value in gains.items())


def test_a_run_that_fails_costs_most_and_stops_nothing() -> None:
    class Broken(Stepper):
        def advance(self, voltage: float):
            raise NumericalError("broken")

    broken = RatedMotion(lambda: Broken(AXIS, AXIS.state(), sample_time=1e-3), sine(0.1, 0.1), 1.0)
    assert cost(law_for("pid"), [broken]) == pytest.approx(WORST)
