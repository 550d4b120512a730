"""Wanted velocities near the goal: their size, when to land, and the second approach after a miss."""

import math

import pytest

from pneumo_ros.control import Setpoint
from pneumo_ros.control.approach import Approach, remaining
from pneumo_ros.control.reference import moves, sine

SHAPE = {"rate": 30.0, "braking": 0.15, "slowest": 0.02, "stop": 2.5e-4}


def test_small_errors_are_approached_in_proportion_and_large_ones_with_the_braking_given() -> None:
    moving = Setpoint(0.0, 0.05)  # not a landing, so that nothing else has an influence
    assert Approach().wanted(moving, 1e-6, 0.05, **SHAPE).velocity == pytest.approx(0.05 + 30e-6, rel=1e-6)
    far = Approach().wanted(moving, 0.5, 0.05, **SHAPE).velocity - 0.05
    assert far == pytest.approx(math.sqrt(2.0 * 0.15 * 0.5), rel=1e-2)


def test_the_acceleration_is_the_derivative_of_the_velocity() -> None:
    for error in (-0.2, 1e-3, 0.01, 0.3):
        one = Approach().wanted(Setpoint(0.0, 0.05), error, 0.02, **SHAPE)
        h = 1e-6
        later = Approach().wanted(Setpoint(0.0, 0.05), error + 0.03 * h, 0.02, **SHAPE)
        assert one.acceleration == pytest.approx((later.velocity - one.velocity) / h, rel=1e-3)


def test_the_end_of_a_move_is_foreseen_and_a_reversal_does_not_count_as_one() -> None:
    way = moves([0.0, 0.06], 8.0, 1.0)
    for time in (8.94, 8.97, 8.99):
        left = remaining(way(time))
        assert left is not None
        assert left == pytest.approx(0.06 - way(time).position, rel=0.35)
    assert remaining(way(8.3)) is None  # still speeding up
    wave = sine(0.3, 0.05)
    assert all(remaining(wave(4.0 + 0.02 * k)) is None for k in range(50))  # to the turning point and beyond
    assert remaining(Setpoint(0.1)) == 0.0


def test_the_goal_is_approached_no_slower_than_slides_steadily_until_it_is_time_to_stop() -> None:
    for error, wanted in ((3e-4, 0.02), (-3e-4, -0.02)):
        assert Approach().wanted(Setpoint(0.0), error, 0.0, **SHAPE).velocity == wanted
    assert abs(Approach().wanted(Setpoint(0.0), 2e-4, 0.0, **SHAPE).velocity) < 0.02


def test_a_place_missed_by_little_is_passed_and_come_back_to() -> None:
    approach, goal = Approach(), Setpoint(0.0)
    approach.watch(goal, 8e-4, False, 2e-4, 0.01)
    assert approach.detour == 0.0  # it may still arrive
    approach.watch(goal, 8e-4, True, 2e-4, 0.01)
    assert approach.detour == 0.01  # beyond
    approach.watch(goal, -3e-3, False, 2e-4, 0.01)
    assert approach.detour == 0.01
    approach.watch(goal, -7e-3, False, 2e-4, 0.01)
    assert approach.detour == 0.0  # and back
    approach.watch(goal, 8e-4, True, 1e-3, 0.01)
    assert approach.detour == 0.0  # within the tolerance there is nothing to do
    approach.watch(goal, 9e-3, True, 2e-4, 0.01)
    assert approach.detour == 0.0  # far enough to slide there
    approach.watch(goal, 8e-4, True, 2e-4, 0.01)
    approach.watch(Setpoint(0.0, 0.1), 8e-4, True, 2e-4, 0.01)
    assert approach.detour == 0.0  # a moving setpoint is followed
