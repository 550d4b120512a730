"""Shapes of references."""

import math

import pytest

from pneumo_ros.control import Setpoint
from pneumo_ros.control.reference import constant, moves, sine, steps
from pneumo_ros.errors import UsageError


def test_shapes() -> None:
    assert constant(0.2)(17.0) == Setpoint(0.2)
    held = steps([0.0, 0.06, -0.1], 2.0)
    assert [held(t).position for t in (0.0, 1.999, 2.0, 4.5, 6.0)] == [0.0, 0.0, 0.06, -0.1, 0.0]
    wave = sine(0.3, 0.05, 0.1)
    assert wave(0.0).position == 0.1
    assert wave(5.0).position == pytest.approx(0.4)
    assert wave(15.0).position == pytest.approx(-0.2)


def test_a_sine_gives_its_derivatives() -> None:
    wave, h = sine(0.3, 0.5, 0.1, 0.4), 1e-5
    before, now, after = (wave(1.3 + k * h) for k in (-1, 0, 1))
    for order in range(3):
        assert now[order + 1] == pytest.approx((after[order] - before[order]) / (2.0 * h), rel=1e-7)


def test_every_boundary_of_steps_belongs_to_the_next_level() -> None:
    """At k hold, rounding of the quotient notwithstanding."""
    held = steps([0.0, 1.0], 0.1)
    assert [held(0.1 * k).position for k in range(100)] == [float(k % 2) for k in range(100)]


def test_moves_go_from_level_to_level_at_rest_on_both_ends_with_their_derivatives() -> None:
    way, h = moves([0.1, 0.16, 0.0], 2.0, 0.5), 1e-5
    assert way(0.0) == way(1.9) == Setpoint(0.1)
    assert way(2.0).position == pytest.approx(0.1)
    assert way(2.25).position == pytest.approx(0.13)
    assert way(2.25).velocity == pytest.approx(1.875 * 0.06 / 0.5)
    assert way(3.9) == Setpoint(0.16)
    assert way(6.25).position == pytest.approx(0.05)  # around, and back to the first level
    before, now, after = (way(2.1 + k * h) for k in (-1, 0, 1))
    for order in range(3):
        assert now[order + 1] == pytest.approx((after[order] - before[order]) / (2.0 * h), rel=1e-5)


@pytest.mark.parametrize(
    "make",
    [
        lambda: constant(math.nan),
        lambda: steps([], 1.0),
        lambda: steps([0.0, math.inf], 1.0),
        lambda: steps([0.0], 0.0),
        lambda: sine(math.nan, 1.0),
        lambda: moves([0.0], 1.0, 0.0),
    ],
)
def test_what_is_no_reference_is_refused(make: object) -> None:
    with pytest.raises(UsageError, match="it takes"):
        make()  # type: ignore[operator]  # one of the functions above


def test_a_move_longer_than_its_hold_is_refused() -> None:
    with pytest.raises(UsageError, match="longer than the hold"):
        moves([0.0, 1.0], 1.0, 2.0)


def test_a_setpoint_goes_on_with_the_jerk_it_has() -> None:
    later = Setpoint(0.1, 0.2, -0.3, 0.6).ahead(0.5)
    assert later == pytest.approx((0.1 + 0.1 - 0.0375 + 0.0125, 0.2 - 0.15 + 0.075, 0.0, 0.6))
    wave = sine(0.3, 0.05)
    assert wave(4.0).ahead(0.1).position == pytest.approx(wave(4.1).position, abs=1e-7)
