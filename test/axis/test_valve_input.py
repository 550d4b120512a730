"""Commands within a sample: when they act, what is refused, when the valve closes."""

import math

import numpy as np
import pytest

from pneumo_ros.axis.simulator.valve_input import ValveInput

PARTS, PART, STEP = 10, 100_000.0, 1e-4  # 1 ms in steps of 0.1 ms
SAMPLE = round(PARTS * PART)


def held(valve: ValveInput, sample: int) -> list[float]:
    """Voltages of sample number `sample`."""
    voltage = np.zeros(PARTS)
    valve.hold(voltage, sample * SAMPLE, PART, sample * PARTS * STEP, STEP)
    return voltage.tolist()


def test_a_command_acts_from_the_first_part_after_its_arrival() -> None:
    valve = ValveInput(10.0, 0.0)
    valve.accept(2.0, 310_000)
    valve.accept(3.0, 700_000)
    assert held(valve, 0) == [0.0] * 4 + [2.0] * 3 + [3.0] * 3
    assert held(valve, 1) == [3.0] * PARTS


def test_commands_that_came_late_act_at_once_and_early_ones_wait() -> None:
    valve = ValveInput(10.0, 0.0)
    valve.accept(1.0, SAMPLE // 2)
    valve.accept(2.0, 3 * SAMPLE + 1)
    assert held(valve, 1) == [1.0] * PARTS
    assert held(valve, 2) == [1.0] * PARTS
    assert held(valve, 3) == [1.0] + [2.0] * 9


def test_the_valve_closes_timeout_after_the_last_command() -> None:
    valve = ValveInput(10.0, 0.0023)
    valve.accept(2.0, 0)
    assert held(valve, 0) == held(valve, 1) == [2.0] * PARTS
    assert held(valve, 2) == [2.0] * 3 + [0.0] * 7
    assert held(valve, 3) == [0.0] * PARTS
    assert valve.expired == 1
    valve.accept(2.0, 4 * SAMPLE)
    assert held(valve, 4) == [2.0] * PARTS


def test_without_timeout_it_never_closes() -> None:
    valve = ValveInput(10.0, 0.0)
    valve.accept(2.0, 0)
    assert held(valve, 0) == held(valve, 100_000) == [2.0] * PARTS
    assert valve.age(10.0) == 10.0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused_and_counted(bad: float) -> None:
    valve = ValveInput(10.0, 0.0)
    valve.accept(2.0, 0)
    assert not valve.accept(bad, 0)
    assert held(valve, 0) == [2.0] * PARTS
    assert (valve.accepted, valve.refused) == (1, 1)


def test_what_is_out_of_range_is_clipped_and_counted() -> None:
    valve = ValveInput(5.0, 0.0)
    assert valve.accept(-7.0, 0)
    assert held(valve, 0) == [-5.0] * PARTS
    assert valve.clipped == 1
    assert valve.accept(5.0, 0)
    assert valve.clipped == 1


def test_reset_closes_and_forgets() -> None:
    valve = ValveInput(10.0, 0.0)
    valve.accept(2.0, 0)
    held(valve, 0)
    valve.accept(3.0, SAMPLE)
    valve.reset()
    assert held(valve, 1) == [0.0] * PARTS
    assert math.isinf(valve.age(1.0))


def test_it_closes_at_the_signal_of_its_machine() -> None:
    """A valve of 0 to 10 V is closed at 5 V: before the first command, after the last one, and for a new machine."""
    valve = ValveInput(10.0, 0.0023, closed=5.0)
    assert held(valve, 0) == [5.0] * PARTS
    valve.accept(7.0, SAMPLE)
    assert held(valve, 1) == [7.0] * PARTS
    held(valve, 2)
    assert held(valve, 4) == [5.0] * PARTS
    valve.close_at(4.8)
    assert held(valve, 5) == [4.8] * PARTS
    valve.accept(7.0, 6 * SAMPLE)
    held(valve, 6)
    valve.close_at(5.0)
    assert held(valve, 7)[0] == 7.0
