"""The wanted motion, without ROS: modes, refusals, and a loop that survives bad input."""

import math

import pytest
from axis.guided import TICK, Run

from pneumo_ros.axis.controller.guide import Mode
from pneumo_ros.axis.controller.health import Growth, health_of
from pneumo_ros.axis.controller.loop import Loop
from pneumo_ros.control import Cascade, Machine, Setpoint
from pneumo_ros.control.motion import Waypoint
from pneumo_ros.errors import UsageError


def moving() -> Run:
    """On its way to 0.3 m."""
    run = Run()
    run.guide.aim(0.3, None, run.loop.time)
    run.go(500, follow=True)
    return run


def test_close_closes_the_valve_until_resume_and_the_piston_stays_there() -> None:
    run = moving()
    run.guide.close()
    assert run.go() == 0.0
    with pytest.raises(UsageError, match="the controller is stopped; call ~/resume first"):
        run.guide.aim(0.1, None, run.loop.time)
    run.position += 0.02  # it drifts on
    assert run.go(100) == 0.0
    run.guide.resume(run.loop.time)
    run.go()
    assert run.loop.wanted == Setpoint(run.position)
    run.guide.aim(0.1, None, run.loop.time)
    run.go(5000, follow=True)
    assert run.position == 0.1


def test_after_it_was_closed_it_holds_where_the_piston_has_drifted_to() -> None:
    run = moving()
    run.guide.close()
    run.go()
    run.position += 0.02
    run.go()
    run.guide.hold(run.loop.time)
    run.go()
    assert run.loop.wanted == Setpoint(run.position)


def test_whatever_ends_the_motion_ends_a_trajectory() -> None:
    for end in (
        lambda run: run.guide.stop(run.loop.time),
        lambda run: run.guide.close(),
        lambda run: run.guide.hold(run.loop.time),
        lambda run: run.guide.halt(0.0),
    ):
        run = Run()
        trajectory, _ = run.guide.follow([Waypoint(2.0, 0.1, 0.0)], 0.0, run.loop.time)
        run.go(100, follow=True)
        assert run.guide.motion.follows(trajectory)
        end(run)
        assert not run.guide.motion.follows(trajectory)
        assert run.guide.motion.reason


def test_hold_brakes_and_takes_no_reference() -> None:
    run = moving()
    begin = run.position
    run.guide.hold(run.loop.time)
    run.go(2000, follow=True)
    assert begin < run.position < begin + 0.03
    assert run.loop.wanted == Setpoint(run.position)
    with pytest.raises(UsageError, match="holding"):
        run.guide.follow([Waypoint(1.0, 0.1, 0.0)], 0.0, run.loop.time)


def test_vent_needs_a_supply_that_is_shut_off() -> None:
    run = moving()
    with pytest.raises(UsageError, match="no supply/pressure shows"):
        run.guide.vent(run.loop.time)
    run.guide.supplied(7e5, run.loop.time)
    with pytest.raises(UsageError, match=r"7e\+05 Pa; shut it off first, to 1.3e\+05 Pa or less"):
        run.guide.vent(run.loop.time)
    assert run.guide.mode is Mode.FOLLOWING
    run.guide.supplied(1.05e5, run.loop.time)
    run.guide.vent(run.loop.time)
    assert run.go() == 5.0
    assert run.go(600) == -5.0
    for chamber in "ab":
        run.loop.press(chamber, 1.01e5)
    assert run.go() == 0.0
    run.guide.vent(run.loop.time)
    run.loop.press("a", 2e5)
    assert run.go() == 5.0
    run.guide.supplied(7e5, run.loop.time)
    assert run.go() == 0.0
    assert run.guide.mode is Mode.STOPPED


def test_a_lost_supply_closes_the_valve_and_nothing_moves_when_it_is_back() -> None:
    run = moving()
    run.guide.supply.least = 2e5
    run.guide.supplied(7e5, run.loop.time)
    run.position -= 0.01
    assert run.go() != 0.0
    run.guide.supplied(1.9e5, run.loop.time)
    assert run.go(300) == 0.0
    run.guide.supplied(7e5, run.loop.time)
    run.go(3000, follow=True)
    assert run.loop.wanted == Setpoint(run.position)
    assert run.position < 0.1
    with pytest.raises(UsageError, match="no finite"):
        run.guide.supplied(math.nan, run.loop.time)


def test_a_lower_supply_pressure_does_less() -> None:
    run = Run()
    points = [Waypoint(2.0, 0.1, 0.0)]
    assert run.guide.follow(points, 0.0, run.loop.time)[1] == 1.0
    run = Run()
    run.guide.supplied(3e5, run.loop.time)
    with pytest.raises(UsageError, match=r"supply pressure of 3e\+05 Pa"):
        run.guide.follow(points, 0.0, run.loop.time)
    run.guide.slow_down = True
    assert run.guide.follow(points, 0.0, run.loop.time)[1] > 1.5


def test_time_rises_whatever_the_clock_does() -> None:
    run = moving()
    before = run.loop.time
    run.stamp -= 100 * 10**9
    assert run.go() is not None
    assert run.loop.time == before
    assert run.loop.restarts == 2
    assert run.loop.wanted is not None
    assert run.loop.wanted.position == run.position
    run.stamp += 1000 * 10**9
    run.go()
    assert run.loop.wanted.position == pytest.approx(run.position)
    assert run.loop.restarts == 3
    late = run.stamp - 5 * TICK
    assert run.loop.measure(late, 0.5, None) is None  # overtaken


def test_a_law_that_leaves_the_numbers_sends_0_v() -> None:
    run = moving()
    run.loop.law.step = lambda setpoint, measurement: math.nan  # type: ignore[method-assign]  # a law gone wrong
    assert run.go() == 0.0
    assert run.loop.refused == 1
    run.loop.law.step = lambda setpoint, measurement: 1e9  # type: ignore[method-assign]  # another one
    assert run.go() == 10.0


def test_old_pressures_do_not_count() -> None:
    run = moving()
    run.loop.press("a", 3e5)
    run.loop.press("b", math.nan)
    run.go(50)
    assert run.loop.pressures == {"a": 3e5, "b": None}
    run.go(60)
    assert run.loop.pressures == {"a": None, "b": None}


def test_health_names_pressures_that_a_law_needs_and_nobody_sends() -> None:
    run = Run()
    assert health_of(run.loop, "", 0.0, False).warnings == ["no reference yet: holding 0 V"]
    loop = Loop(Cascade(), 0.1)
    loop.guide.aim(0.1, None, 0.0)
    loop.press("b", 3e5)
    assert loop.measure(10**18, 0.0, None) == 0.0
    (warning,) = health_of(loop, "", 0.0, False).warnings
    assert warning == "the law needs chamber_a/pressure, which nobody sends: sending 0 V"
    loop.press("a", 3e5)
    assert health_of(loop, "", 0.0, False).message == "running"


def test_a_far_sine_is_approached_and_then_followed_as_it_is() -> None:
    run = Run()

    def sine(time: float) -> Setpoint:
        return Setpoint(0.2 + 0.05 * math.sin(time), 0.05 * math.cos(time), -0.05 * math.sin(time))

    run.guide.built_in = (sine, False)
    run.go()
    assert run.loop.wanted is not None
    assert run.loop.wanted.position < 0.01
    run.go(4000, follow=True)
    assert run.loop.wanted == sine(run.loop.time)


# --- stopping ---------------------------------------------------------------------------------------------------------


def test_stop_brakes_over_the_distance_it_states_then_closes_the_valve() -> None:
    run = moving()
    begin, speed = run.position, run.loop.wanted.velocity if run.loop.wanted else 0.0
    stated = run.guide.stop(run.loop.time)
    assert run.guide.mode is Mode.STOPPING
    assert 0.5 * speed**2 / run.guide.motion.limits.acceleration <= stated < 0.03
    again = run.guide.stop(run.loop.time)
    assert again == pytest.approx(stated, abs=1e-3)
    run.go(100, follow=True)
    with pytest.raises(UsageError, match="the controller is stopping"):
        run.guide.aim(0.1, None, run.loop.time)
    run.go(1000, follow=True)
    assert run.guide.mode is Mode.STOPPED
    assert run.position - begin == pytest.approx(stated, abs=1e-3)
    assert run.go() == 0.0


def test_stop_closes_at_once_what_does_not_move_under_control() -> None:
    run = Run()
    assert run.guide.stop(run.loop.time) == 0.0
    assert run.guide.mode is Mode.STOPPED
    run = moving()
    run.guide.close()
    assert run.guide.stop(run.loop.time) == 0.0
    assert run.guide.mode is Mode.STOPPED


def test_references_are_taken_again_while_it_brakes_once_resumed() -> None:
    run = moving()
    run.guide.stop(run.loop.time)
    run.go(5, follow=True)
    run.guide.resume(run.loop.time)
    run.guide.aim(0.3, None, run.loop.time)
    run.go(6000, follow=True)
    assert run.position == pytest.approx(0.3)


# --- positions that cannot be -----------------------------------------------------------------------------------------


def test_a_position_outside_the_stroke_sends_nothing_and_is_named() -> None:
    run = moving()
    inside = run.position
    run.position = 250.0
    assert run.go(5) == 0.0
    assert "position 250 m lies outside of the stroke, +-1 m; is it in mm?" in run.loop.fault
    health = health_of(run.loop, "", 0.0, False)
    assert health.errors[0].endswith("is it in mm?: sending 0 V")
    run.position = 1.2
    run.go()
    assert "is the zero of the sensor elsewhere?" in run.loop.fault
    run.position = inside - 0.01
    run.go(500)
    assert run.loop.fault == ""
    assert run.go() != 0.0  # towards its target again


def test_a_leap_of_the_position_closes_the_valve_until_resume() -> None:
    run = moving()
    run.position += 0.7
    assert run.go() == 0.0
    assert run.guide.mode is Mode.STOPPED
    assert "leapt by +0.7 m in 1 ms" in run.loop.fault
    assert run.go(50) == 0.0
    assert run.loop.fault
    run.guide.resume(run.loop.time)
    run.go(5)
    assert run.loop.fault == ""
    assert run.loop.wanted == Setpoint(run.position)


def test_a_fast_piston_does_not_leap() -> None:
    run = moving()
    for _ in range(50):
        run.position += 0.005  # 5 m/s
        run.go()
    assert run.loop.fault == ""


# --- what it warns of -------------------------------------------------------------------------------------------------


def test_a_blocked_piston_is_a_stall_and_one_that_arrived_is_none() -> None:
    run = moving()
    run.go(2500)
    assert "stalled: it has not moved for" in run.loop.stall.warning
    assert any("stalled" in one for one in health_of(run.loop, "", 0.0, False).warnings)
    run.guide.close()
    run.go(10)
    assert run.loop.stall.warning == ""
    run = moving()
    run.go(8000, follow=True)
    assert run.position == pytest.approx(0.3)
    assert run.loop.stall.warning == ""


def test_a_load_beyond_the_force_is_named() -> None:
    run = Run()
    assert not [one for one in health_of(run.loop, "", 0.0, False).warnings if "cannot" in one]
    run.loop.law.machine = Machine(load=157.0)
    said = [one for one in health_of(run.loop, "", 0.0, False).warnings if "cannot" in one]
    assert said == ["the machine cannot extend: friction and load are 257 N, its force is 246 N"]


def test_a_silent_supply_is_not_known_any_more() -> None:
    run = moving()
    run.guide.supplied(6e5, run.loop.time)
    run.go(4900)
    assert run.guide.supply.pressure == 6e5
    run.go(200)
    assert run.guide.supply.pressure is None
    assert any("supply/pressure is silent" in one for one in health_of(run.loop, "", 0.0, False).warnings)
    run.guide.supplied(6e5, run.loop.time)
    assert not run.guide.supply.silent


def test_what_grows_is_warned_of_once_a_second() -> None:
    run, growth = moving(), Growth()
    assert growth.warnings(run.loop) == []
    run.go(1000)  # it stands still
    assert any("commands at the limit of the voltage" in one for one in growth.warnings(run.loop))
    run.guide.close()
    run.stamp += 2 * 10**9
    run.go(100)
    assert growth.warnings(run.loop) == ["1 restarts after pauses of the measurements"]
    run.go(100)
    assert growth.warnings(run.loop) == []


def test_voltages_are_counted_from_the_closed_signal_of_the_machine_file() -> None:
    from pneumo_ros.axis.controller.settings import SETTINGS, machine_of, valve_of

    values = {one.name: one.default for one in SETTINGS} | {"valve_null_offset.offset": -5.0}
    assert machine_of(values).closed_signal == 5.0
    assert valve_of(values).max_voltage == 5.0  # 0 to 10 V
    with pytest.raises(UsageError, match="no room to open it"):
        valve_of(values | {"max_voltage": 4.0})
