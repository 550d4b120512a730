"""All references give one motion without jumps."""

import math

import numpy as np
import pytest

from pneumo_ros.control import Setpoint
from pneumo_ros.control.motion import Kind, Limits, Motion, Trajectory, Vent, Waypoint
from pneumo_ros.errors import UsageError

STEP = 1e-3


def followed(motion: Motion, begin: float, seconds: float) -> list[Setpoint]:
    """Setpoints of a piston that follows exactly."""
    found, measured = [], motion.at(begin, 0.0)
    for time in np.arange(begin, begin + seconds, STEP):
        measured = motion.at(float(time), measured.position if measured else 0.0)
        assert measured is not None
        found.append(measured)
    return found


def moving() -> Motion:
    """0.5 s on the way from 0 to 0.3 m."""
    motion = Motion(Limits())
    motion.aim(0.3, None, 0.0, 0.0)
    return motion


def test_nothing_asked_for_is_nothing_wanted() -> None:
    assert Motion(Limits()).at(1.0, 0.2) is None


def test_a_target_is_reached_and_a_new_one_makes_no_jump() -> None:
    motion = moving()
    before = motion.at(0.5, 0.03)
    motion.aim(-0.1, None, 0.5, 0.03)
    assert before is not None
    assert motion.at(0.5, 0.03)[:3] == pytest.approx(before[:3])
    assert followed(motion, 0.5, 5.0)[-1] == Setpoint(-0.1)


@pytest.mark.parametrize("bad", [1.01, -7.0, math.nan, math.inf])
def test_what_is_outside_is_refused_and_the_motion_goes_on(bad: float) -> None:
    motion = moving()
    with pytest.raises(UsageError, match="position"):
        motion.aim(bad, None, 0.5, 0.03)
    assert motion.target == 0.3
    assert followed(motion, 0.5, 5.0)[-1] == Setpoint(0.3)


def test_a_smooth_stream_with_velocities_is_taken_as_it_is() -> None:
    motion, rate = Motion(Limits()), 2.0 * math.pi * 0.2
    worst = 0.0
    for tick in range(5000):
        time = tick * STEP
        wanted, speed = 0.1 * (1.0 - math.cos(rate * time)), 0.1 * rate * math.sin(rate * time)
        if tick % 10 == 0:
            motion.aim(wanted, speed, time, wanted)
        got = motion.at(time, wanted)
        assert got is not None
        worst = max(worst, abs(got.position - wanted))
    assert worst < 1e-4


def test_a_smooth_stream_of_positions_alone_is_followed_closely() -> None:
    """Without its velocity a profile would stop at every position: 7 mm behind at this speed."""
    motion, errors = Motion(Limits()), []
    for tick in range(4000):
        time = tick * STEP
        wanted = 0.09 * time
        if tick % 10 == 0:
            motion.aim(wanted, None, time, wanted)
        got = motion.at(time, wanted)
        assert got is not None
        errors.append(abs(got.position - wanted))
    assert max(errors[1000:]) < 1e-3


def test_a_stream_that_ends_comes_to_rest_at_its_last_position() -> None:
    motion = Motion(Limits())
    for tick in range(100):
        motion.aim(0.001 * tick, 0.1, 0.01 * tick, 0.001 * tick)
    found = followed_from(motion, 0.99, 2.0, 0.099)
    assert found[-1] == Setpoint(0.099)
    assert max(one.position for one in found) < 0.099 + 0.1 * 0.2 + 0.1**2 / 2 + 0.01


def followed_from(motion: Motion, begin: float, seconds: float, measured: float) -> list[Setpoint]:
    """As `followed`, from where the piston is."""
    found = []
    for time in np.arange(begin, begin + seconds, STEP):
        wanted = motion.at(float(time), measured)
        assert wanted is not None
        measured = wanted.position
        found.append(wanted)
    return found


def test_a_stream_is_not_drawn_out_of_the_stroke() -> None:
    motion = Motion(Limits(high=0.1))
    motion.aim(0.09, 0.1, 0.0, 0.09)
    motion.aim(0.0999, 0.1, 0.1, 0.0999)
    assert max(one.position for one in followed_from(motion, 0.1, 1.0, 0.0999)) <= 0.1


def test_the_setpoint_waits_for_a_piston_that_does_not_move() -> None:
    motion = moving()
    found = [motion.at(float(time), 0.0) for time in np.arange(0.0, 5.0, STEP)]
    assert max(abs(one.position) for one in found if one) <= 0.05
    assert "the piston is -0.05 m off" in motion.reason
    assert motion.target == 0.3


def test_a_trajectory_is_given_up_when_the_piston_does_not_follow() -> None:
    motion = Motion(Limits())
    trajectory = Trajectory(motion.start_of(0.0, 0.0), 0.0, [Waypoint(2.0, 0.2, 0.0)])
    motion.follow(trajectory, 0.0)
    assert motion.follows(trajectory)
    for time in np.arange(0.0, 2.0, STEP):
        motion.at(float(time), 0.0)
    assert not motion.follows(trajectory)
    assert motion.at(2.0, 0.0) == Setpoint(0.0)


def test_until_a_trajectory_begins_the_motion_goes_on() -> None:
    motion = moving()
    trajectory = Trajectory(motion.start_of(1.0, 0.0), 1.0, [Waypoint(2.0, 0.2, 0.0)])
    expected = motion.reference(0.7)
    motion.follow(trajectory, 0.03)
    assert motion.at(0.7, 0.06) == expected
    assert motion.at(1.0, 0.1)[:2] == pytest.approx(moving().reference(1.0)[:2])
    assert motion.at(3.0, 0.2) == Setpoint(0.2)


def test_braking_resting_and_restarting() -> None:
    motion = moving()
    motion.brake(0.5, 0.04, "asked to")
    assert motion.reason == "asked to"
    assert 0.05 < followed_from(motion, 0.5, 2.0, 0.05)[-1].position < 0.08
    motion = moving()
    motion.restart(0.5, 0.01, "after a pause")
    assert motion.at(0.5, 0.01) == Setpoint(0.01, jerk=20.0)
    motion.rest(0.6, 0.02)
    assert motion.at(9.0, 0.02) == Setpoint(0.02)


def test_other_limits_hold_at_once() -> None:
    motion = moving()
    before = motion.at(0.5, 0.03)
    motion.change_limits(Limits(low=0.0, high=0.2, speed=0.01), 0.5)
    found = followed_from(motion, 0.5, 30.0, 0.03)
    assert before is not None
    assert found[0][:3] == pytest.approx(before[:3])
    assert abs(found[1000].velocity) <= 0.01 + 1e-9
    assert found[-1] == Setpoint(0.2)


def test_a_free_reference_is_as_it_is() -> None:
    motion = Motion(Limits())
    motion.follow_freely(lambda time: Setpoint(time, 1.0))
    assert motion.at(7.0, 0.0) == Setpoint(7.0, 1.0)
    assert motion.kind is Kind.FREE


def test_venting_opens_both_ways_until_both_chambers_are_empty() -> None:
    vent = Vent(10.0, 1e5, 10.0)
    pressures: dict[str, float | None] = {"a": 3e5, "b": 3e5}
    assert [vent.voltage(10.0 + t, pressures) for t in (0.0, 0.6, 1.2)] == [5.0, -5.0, 5.0]
    pressures = {"a": 1.04e5, "b": 1.01e5}
    assert vent.voltage(11.3, pressures) == 0.0
    assert vent.done
    blind = Vent(0.0, 1e5, 10.0)
    assert blind.voltage(19.0, {"a": None, "b": None}) != 0.0
    assert blind.voltage(20.1, {"a": None, "b": None}) == 0.0
