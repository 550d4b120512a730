"""Profiles keep their limits, end at the goal, and join without a jump, from any motion."""

import math

import numpy as np
import pytest

from pneumo_ros.control import Setpoint
from pneumo_ros.control.motion import Limits, Profile, braking

LIMITS = Limits(speed=0.12, acceleration=1.0, jerk=20.0)
RANDOM = np.random.default_rng(7)
STARTS = [Setpoint(*row) for row in RANDOM.uniform((-0.5, -0.1, -1.0), (0.5, 0.1, 1.0), (60, 3))]


def sampled(profile: Profile, step: float = 1e-4) -> np.ndarray:
    """Position, velocity, acceleration and jerk (samples, 4)."""
    return np.array([profile(time) for time in np.arange(profile.begin, profile.end + 2 * step, step)])


@pytest.mark.parametrize("start", STARTS)
def test_from_any_motion_to_any_target_within_the_limits(start: Setpoint) -> None:
    target = start.position + float(RANDOM.normal(0.0, 0.1))
    profile = Profile(start, 3.0, target, LIMITS)
    assert profile(3.0)[:3] == pytest.approx(start[:3])
    assert profile(profile.end + 1.0) == Setpoint(target)
    rows = sampled(profile)
    unavoidable = abs(start.velocity + start.acceleration * abs(start.acceleration) / (2.0 * LIMITS.jerk))
    assert abs(rows[:, 1]).max() <= max(LIMITS.speed, unavoidable) + 1e-9
    assert abs(rows[:, 2]).max() <= LIMITS.acceleration + 1e-9
    assert abs(rows[:, 3]).max() <= LIMITS.jerk
    # each is the integral of the next: no jump of position, velocity or acceleration anywhere, the end included
    for order in range(3):
        rates = np.diff(rows[:, order]) / 1e-4
        slack = 1e-4 * (LIMITS.jerk if order == 1 else LIMITS.acceleration) + (2.0 * LIMITS.jerk if order == 2 else 0.0)
        assert abs(rates - rows[:-1, order + 1]).max() <= slack + 1e-6


def test_from_rest_it_takes_the_time_of_the_textbook() -> None:
    """distance / speed + speed / acceleration + acceleration / jerk, if all limits are reached (Lambrechts 2005)."""
    profile = Profile(Setpoint(0.0), 0.0, 0.3, LIMITS)
    assert profile.end == pytest.approx(0.3 / 0.12 + 0.12 / 1.0 + 1.0 / 20.0)
    short = Profile(Setpoint(0.0), 0.0, 1e-4, LIMITS)  # neither speed nor acceleration: four equal phases
    assert short.end == pytest.approx(4.0 * (1e-4 / (2.0 * 20.0)) ** (1.0 / 3.0))


def test_there_is_no_way_back_unless_it_must() -> None:
    rows = sampled(Profile(Setpoint(0.0), 0.0, 0.05, LIMITS))
    assert rows[:, 1].min() >= -1e-12
    late = sampled(Profile(Setpoint(0.0, 0.1), 0.0, 0.001, LIMITS))  # too fast to stop within 1 mm
    assert late[:, 0].max() > 0.005
    assert late[-1, 0] == pytest.approx(0.001)


@pytest.mark.parametrize("start", STARTS[:20])
def test_it_catches_a_target_that_moves(start: Setpoint) -> None:
    profile = Profile(start, 0.0, 0.1, LIMITS, drift=0.06)
    before, after = profile(profile.end - 1e-9), profile(profile.end)
    assert before[:3] == pytest.approx(after[:3], abs=1e-6)
    assert after == Setpoint(0.1 + 0.06 * profile.end, 0.06)


def test_an_acceleration_beyond_new_limits_is_brought_back() -> None:
    narrow = Limits(speed=0.05, acceleration=0.2, jerk=2.0)
    rows = sampled(Profile(Setpoint(0.0, 0.1, 0.9), 0.0, 0.3, narrow))
    assert rows[0, 2] == pytest.approx(0.9)
    assert abs(rows[6000:, 2]).max() <= 0.2 + 1e-9
    assert abs(rows[-1, 0] - 0.3) < 1e-9


@pytest.mark.parametrize("start", STARTS[:20])
def test_braking_ends_at_rest_as_soon_as_possible(start: Setpoint) -> None:
    profile = braking(start, 0.0, LIMITS)
    assert profile(profile.end - 1e-9)[1:3] == pytest.approx((0.0, 0.0), abs=1e-6)
    longest = (abs(start.velocity) + 0.05) / LIMITS.acceleration + 2.0 * LIMITS.acceleration / LIMITS.jerk
    assert profile.end <= 2.0 * longest
    assert math.isfinite(profile.target)
