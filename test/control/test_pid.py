"""PID: each term of its output, and its behaviour on the plant."""

import numpy as np
import pytest

from pneumo_ros.control import Measurement, Pid, Record, Reference, Setpoint, ValveInverse, closed_loop
from pneumo_ros.control.reference import sine, steps
from pneumo_ros.plant import Model, Stepper, load_model

OPEN = ValveInverse(right_limit=0.0, left_limit=0.0, smoothing=0.0)  # voltage is opening
AXIS = load_model("axis")
BARE = {"proportional": 0.0, "integral": 0.0, "derivative": 0.0}
RATE = 500.0


def test_proportional_integral_and_derivative_add() -> None:
    p = Pid({**BARE, "proportional": 10.0}, OPEN)
    assert p.step(Setpoint(0.1), Measurement(0.0, 0.0)) == pytest.approx(1.0)
    i = Pid({**BARE, "integral": 2.0, "integral_limit": 5.0}, OPEN)
    answers = [i.step(Setpoint(0.1), Measurement(0.1 * k, 0.0)) for k in range(12)]
    assert answers[11] == pytest.approx(2.0 * 0.1 * 1.0)  # the integral of 1 s has reached the answer
    d = Pid({**BARE, "derivative": 3.0}, OPEN)
    assert d.step(Setpoint(0.1), Measurement(0.0, 0.0, velocity=0.2)) == pytest.approx(-0.6)


def test_the_integral_does_not_wind_up() -> None:
    law = Pid({**BARE, "proportional": 100.0, "integral": 50.0, "integral_limit": 10.0}, OPEN)
    for k in range(1000):  # 10 s of an error that saturates
        law.step(Setpoint(1.0), Measurement(0.01 * k, 0.0, 0.0))
    below = law.step(Setpoint(1.0), Measurement(10.0, 1.01, 0.0))
    assert below < 0.0  # past the reference it turns at once


def test_the_derivative_follows_the_velocity_of_the_setpoint_and_a_jump_gives_no_kick() -> None:
    law = Pid({**BARE, "derivative": 10.0}, OPEN)
    for k in range(100):
        assert law.step(Setpoint(0.0), Measurement(1e-3 * k, 0.0, 0.02)) == pytest.approx(-0.2)
    assert law.step(Setpoint(0.3), Measurement(0.1, 0.0, 0.02)) == pytest.approx(-0.2)
    assert law.step(Setpoint(0.3, 0.1), Measurement(0.101, 0.0, 0.02)) == pytest.approx(10.0 * (0.1 - 0.02))


def test_near_the_reference_and_at_rest_the_valve_is_closed_until_the_error_has_grown() -> None:
    law = Pid({"tolerance": 1e-3})
    errors = [0.9e-3, 1.9e-3, 2.1e-3, 1.5e-3, 0.9e-3]
    answers = [law.step(Setpoint(e), Measurement(1e-3 * k, 0.0, 0.0)) for k, e in enumerate(errors)]
    closed = [answer == 0.0 for answer in answers]
    assert closed == [True, True, False, False, True]
    law.reset()
    assert law.step(Setpoint(0.9e-3), Measurement(0.0, 0.0, 0.1)) != 0.0  # still moving


def test_it_takes_a_measured_velocity_and_estimates_a_missing_one() -> None:
    measured, estimating = Pid(valve=OPEN), Pid(valve=OPEN)
    for k in range(400):
        time = 1e-3 * k
        a = measured.step(Setpoint(0.5), Measurement(time, 0.05 * time, 0.05))
        b = estimating.step(Setpoint(0.5), Measurement(time, 0.05 * time))
    assert a == pytest.approx(b, rel=1e-3)


def follow(model: Model, reference: Reference, seconds: float) -> Record:
    """The default law on a model that sends noisy positions only."""
    plant = Stepper(model, model.state(p_a=3e5, p_b=4e5), sample_time=1.0 / RATE)
    noise = iter(5e-6 * np.random.default_rng(0).standard_normal(round(seconds * RATE)))
    return closed_loop(
        plant, Pid(), reference, round(seconds * RATE), lambda t, x: Measurement(t, float(x[0]) + next(noise))
    )


OTHERS = {
    "default": {},
    "payload": {"piston.mass": 15.0},
    "friction": {"lugre_friction.coulomb_friction": 84.0, "lugre_friction.static_friction": 120.0},
    "dead zone": {"dead_zone.right_limit": 0.75, "dead_zone.left_limit": 0.81},
}


@pytest.mark.parametrize("name", OTHERS)
def test_steps_settle_within_the_tolerance_and_stay_there(name: str) -> None:
    model = AXIS.with_parameters(OTHERS[name])
    record = follow(model, steps([0.0, 0.06, 0.02, -0.1], 8.0), 32.0)
    error = (record.reference - record.states[:, 0]).reshape(4, -1)[1:]
    last = error[:, -round(2.0 * RATE) :]  # the last 2 s of each step
    assert np.abs(last).max() < 2e-3  # twice the tolerance, where it would move again
    moved = np.ptp(record.states[:, 0].reshape(4, -1)[1:, -round(2.0 * RATE) :], axis=1)
    assert moved.max() < 1e-4  # at rest: no hunting


def test_a_slow_sine_is_followed_without_instability() -> None:
    record = follow(AXIS, sine(0.3, 0.05), 30.0)
    error = (record.reference - record.states[:, 0])[round(5.0 * RATE) :]
    assert np.sqrt(np.mean(error**2)) < 4e-3
    assert np.abs(error).max() < 20e-3
