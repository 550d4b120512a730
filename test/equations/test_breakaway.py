"""Breakaways: found where a piston starts from rest, with the friction force at that moment."""

from dataclasses import replace

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.equations.breakaway import Breakaway, find_breakaways, holding_force, last_slope

STATIC = 100.0  # N, of the paper's machine


@pytest.mark.parametrize("volts", [0.80, -0.80, 0.83, -1.0])
def test_the_force_is_the_static_friction(volts: float) -> None:
    (found,) = find_breakaways(truth(), constant_run(volts))
    assert found.direction == np.sign(volts)
    assert abs(found.force - STATIC) < 2.0 * found.spread
    assert found.spread < 5.0
    assert found.ramp > 0.0


def test_slow_rises_give_the_force_best() -> None:
    slow, fast = (find_breakaways(truth(), constant_run(volts))[0] for volts in (0.80, 7.0))
    assert slow.spread < 1.0 < 5.0 < fast.spread
    assert abs(slow.force - STATIC) < 1.0 < abs(fast.force - STATIC)


@pytest.mark.parametrize("volts", [3.0, -5.0, 7.0])
def test_the_ramp_is_that_of_the_last_20_ms(volts: float) -> None:
    """After a step of the command the force is flat, rises, and rises less as the chamber fills."""
    (found,) = find_breakaways(truth(), constant_run(volts))
    force = found.direction * holding_force(truth(), constant_run(volts, noisy=False))
    last = (force[found.index] - force[found.index - 20]) / 0.02
    assert found.ramp == pytest.approx(last, rel=0.05)


def test_a_slope_is_local_where_it_bends_and_a_mean_where_it_does_not() -> None:
    """1200 N/s over the last 30 ms of 150; and 20 N/s throughout, which 20 ms alone know to 23 N/s only."""
    time, noise = np.arange(151) * 1e-3, np.random.default_rng(0).normal(0.0, 0.6, (200, 151))
    bent = [last_slope(np.maximum(time - 0.12, 0.0) * 1200.0 + one, 1e-3, 0.6) for one in noise]
    assert np.mean(bent) == pytest.approx(1200.0, rel=0.02)
    straight = [last_slope(20.0 * time + one, 1e-3, 0.6) for one in noise]
    assert np.mean(straight) == pytest.approx(20.0, abs=2.0)
    alone = [np.polyfit(time[-21:], one[-21:], 1)[0] for one in noise]
    assert np.std(straight) < 0.5 * np.std(alone)


def test_a_falling_force_is_as_uncertain_as_a_rising_one() -> None:
    """0.2 N, and the change of the force in the 20 ms until sliding is visible."""
    found = [Breakaway("run", 0, 0.0, 1, 100.0, ramp, 0.2, 1e-4) for ramp in (0.0, 50.0, -50.0)]
    assert [one.spread for one in found] == pytest.approx([0.2, 1.2, 1.2])


def test_time_is_where_sliding_is_certain() -> None:
    run = constant_run(0.83)
    (found,) = find_breakaways(truth(), run)
    before, after = run.position[: found.index - 100], run.position[found.index :]
    assert np.ptp(before) < 3e-4
    assert np.all(np.abs(after - run.position[0]) > 3e-4)
    assert found.time == pytest.approx(found.index * 1e-3)
    assert 0.1 < found.rest < found.time + 1e-9


def test_a_piston_that_never_moves_does_not_break_away() -> None:
    assert find_breakaways(truth(), constant_run(0.5)) == []


def test_a_piston_that_never_rests_does_not_break_away() -> None:
    run = constant_run(1.0)
    moving = 1e-2 * run.time - 0.5
    assert find_breakaways(truth(), replace(run, position=moving)) == []


def test_leaving_an_end_is_no_breakaway() -> None:
    run = constant_run(0.83)
    assert find_breakaways(truth(), replace(run, position=run.position - 0.0995)) == []


def test_a_gap_before_it_hides_a_breakaway() -> None:
    run = constant_run(0.83)
    (found,) = find_breakaways(truth(), run)
    measured = run.measured.copy()
    measured[found.index - 5 : found.index - 2] = False
    assert find_breakaways(truth(), replace(run, measured=measured)) == []


def test_stops_on_the_way_are_found() -> None:
    """Rest, slide, rest, slide back."""
    run = constant_run(1.0)
    path = np.interp(run.time, [0.0, 1.0, 2.0, 3.0, 4.0, 8.0], [0.0, 0.0, 0.05, 0.05, 0.0, 0.0])
    found = find_breakaways(truth(), replace(run, position=path))
    assert [b.direction for b in found] == [1, -1]
    assert [b.time for b in found] == pytest.approx([1.0, 3.0], abs=0.05)


def test_holding_force_is_that_of_the_pressures() -> None:
    run = constant_run(0.5, noisy=False)
    assert run.pressure_a is not None
    assert run.pressure_b is not None
    expected = truth()["piston.area_a"] * run.pressure_a - truth()["piston.area_b"] * run.pressure_b
    np.testing.assert_allclose(holding_force(truth(), run)[50:], expected[50:], atol=0.5)
