"""The cascade on the plant: its purpose, and the effect of each of its parts."""

import numpy as np
import pytest
from control.following import AXIS, LOADED, STICKY, follow, law_for

from pneumo_ros.control.control_file import load_control
from pneumo_ros.control.figures import arrivals, tracking
from pneumo_ros.control.reference import moves, sine

SINE = sine(0.3, 0.05)
MOVES = moves([0.0, 0.06, 0.0, -0.06], 5.0, 1.0)


def rms(name: str, plant=AXIS, known=AXIS, seconds: float = 25.0, **gains: float) -> float:
    """Along the sine [m], after 5 s."""
    return tracking(follow(law_for(name, known, **gains), SINE, seconds, plant), 5.0).rms


def test_the_sine_is_followed_far_better_than_by_pid_each_with_the_gains_that_ship() -> None:
    pid, cascade = (rms(law, **load_control(law).gains) for law in ("pid", "cascade"))
    assert cascade < 0.4e-3
    assert cascade < pid / 3.0


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.check)])
@pytest.mark.parametrize("plant", [AXIS, STICKY, LOADED], ids=["axis", "sticky", "loaded"])
def test_moves_end_within_the_tolerance_and_the_piston_stays(plant, seed: int) -> None:
    ends = arrivals(follow(law_for("cascade"), MOVES, 20.0, plant, seed), 5.0)
    assert max(end.error for end in ends) < 3e-4
    assert max(end.motion for end in ends) < 5e-5


def test_raw_steps_arrive_too_and_far_ones_brake_in_time() -> None:
    record = follow(law_for("cascade"), moves([0.0, 0.06, -0.5], 8.0, 1e-3), 24.0)
    ends = arrivals(record, 8.0)
    assert max(end.error for end in ends) < 3e-4
    assert record.states[:, 0].min() > -0.5 - 0.015  # a detour at most


def test_the_friction_observer_is_worth_it() -> None:
    """With friction set to zero, the rest of the cascade cannot follow."""
    bare = AXIS.with_parameters({"lugre_friction.static_friction": 0.0, "lugre_friction.coulomb_friction": 1e-3})
    assert rms("cascade", known=bare, learning=0.0) > 3.0 * rms("cascade")


def test_it_learns_friction_and_load_that_the_machine_file_does_not_know() -> None:
    assert rms("cascade", LOADED, learning=0.0) > 2.0 * rms("cascade", LOADED)
    assert rms("cascade", STICKY) < 1.0e-3


def test_a_better_machine_file_tracks_better() -> None:
    assert rms("cascade", LOADED, known=LOADED) < 0.8 * rms("cascade", LOADED)


def test_no_hunting_even_where_it_cannot_get_there() -> None:
    """The tolerance is too small for sensors and stiction: after some attempts it rests, within a minute."""
    record = follow(law_for("cascade", tolerance=1e-6), moves([0.0, 0.06], 60.0, 1.0), 120.0)
    assert np.ptp(record.states[-10_000:, 0]) < 5e-5
    assert np.abs(record.states[-1, 0] - 0.06) < 1e-3


def test_after_an_end_stop_it_comes_back() -> None:
    """The state of the friction observer after the impact must not hold it there."""
    record = follow(law_for("cascade"), moves([0.9, 1.3, 0.9], 6.0, 0.5), 18.0)
    assert np.abs(record.states[9000:12000, 0]).max() > 0.99
    assert record.states[-1, 0] == pytest.approx(0.9, abs=1e-3)


def test_waiting_for_a_setpoint_that_comes_back_is_worth_it() -> None:
    gains = load_control("cascade").gains
    assert rms("cascade", **gains) < 0.8 * rms("cascade", **{**gains, "lead": 0.0})


def test_a_slow_spool_that_the_machine_file_knows_is_not_outrun() -> None:
    slow = AXIS.with_effects([*AXIS.effects, "valve_spool_dynamics"], {"valve_spool_dynamics.angular_frequency": 80.0})
    gains = load_control("cascade").gains
    ends = arrivals(follow(law_for("cascade", slow, **gains), MOVES, 20.0, slow), 5.0)
    assert max(end.error for end in ends) < 4e-4


def test_the_flow_of_a_choked_valve_is_inverted_with_its_own_coefficients() -> None:
    """With little feedback of the force, errors are half of those with the linear law of the default valve."""
    sizes = {"blend": 1.0, "conductance_filling": 2e-9, "conductance_exhaust": 3e-9, "critical_ratio": 0.3}
    choked = AXIS.with_effects([*AXIS.effects, "choked_flow"], {f"choked_flow.{key}": x for key, x in sizes.items()})
    assert rms("cascade", choked, choked, force_rate=10.0) < 0.7 * rms("cascade", choked, AXIS, force_rate=10.0)
