"""The lockstep loop of plant and law without ROS."""

import numpy as np
import pytest

from pneumo_ros.control import Measurement, Pid, closed_loop
from pneumo_ros.control.closed_loop import perfect_sensor
from pneumo_ros.control.reference import sine
from pneumo_ros.plant import Stepper, load_model

AXIS = load_model("axis")


def plant() -> Stepper:
    return Stepper(AXIS, AXIS.state(p_a=3e5, p_b=4e5), sample_time=2e-3)


def test_the_record_is_what_the_plant_did() -> None:
    record = closed_loop(plant(), Pid(), sine(0.1, 0.2), 500)
    again = AXIS.simulate(record.voltage, record.states[0], sample_time=2e-3)
    assert np.array_equal(again[:-1], record.states[1:])
    assert record.time[-1] == pytest.approx(0.998)
    assert record.reference == pytest.approx(0.1 * np.sin(2 * np.pi * 0.2 * record.time))


def test_runs_repeat_to_the_bit() -> None:
    first, second = (closed_loop(plant(), Pid(), sine(0.1, 0.2), 500) for _ in range(2))
    assert np.array_equal(first.states, second.states)


def test_the_law_sees_what_the_sensor_says() -> None:
    seen: list[float] = []

    def sensor(time: float, state: np.ndarray) -> Measurement:
        seen.append(time)
        return perfect_sensor(time, state)

    closed_loop(plant(), Pid(), sine(0.1, 0.2), 10, sensor)
    assert seen == pytest.approx(list(2e-3 * np.arange(10)))
