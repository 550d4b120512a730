"""Several axes on one plant, sample by sample: as their kernel, reset and changed one by one."""

import numpy as np
import pytest
from multiaxis.machines import LINE, two

from pneumo_ros.axis.simulator.force_input import pushed
from pneumo_ros.axis.simulator.sensors import Sensors
from pneumo_ros.axis.simulator.shared_plant import SharedPlant
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.together import Together
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.errors import NumericalError
from pneumo_ros.multiaxis import Machine

RATE, STEP = 500.0, 1e-4
VOLTS = {"shoulder": 3.0, "elbow": -4.0}


def together(machine: Machine) -> Together:
    """Simulations of all axes with exact sensors and valves that stay open."""
    whole = machine.with_axes({axis: pushed(one) for axis, one in machine.axes.items()})
    result = Together(SharedPlant(whole, sample_time=1.0 / RATE, step=STEP))
    for axis, model in machine.axes.items():
        valve, own = ValveInput(10.0, 0.0), result.plant.axes[axis]
        result.add(axis, Simulation(model, valve, Sensors(), rate=RATE, step=STEP, plant=own))
        valve.accept(VOLTS[axis], 0)
    return result


def moved(plant: Together, samples: int) -> dict[str, np.ndarray]:
    """States (samples, states) of each axis."""
    rows: dict[str, list[np.ndarray]] = {axis: [] for axis in plant.simulations}
    for _ in range(samples):
        plant.advance(0, 1.0)
        for axis, one in plant.simulations.items():
            rows[axis].append(one.plant.state.copy())
    return {axis: np.array(states) for axis, states in rows.items()}


def test_it_is_the_machine() -> None:
    machine = two(LINE)
    plant = together(machine)
    found = moved(plant, 300)
    expected = machine.simulate(np.tile([3.0, -4.0], (300, 1)), machine.state(), sample_time=1.0 / RATE, step=STEP)
    for axis, states in machine.split(expected).items():
        np.testing.assert_allclose(found[axis], states, rtol=1e-9, atol=1e-12)
    assert plant.plant.supply_pressure == pytest.approx(machine.supply_pressure("elbow", expected)[-1])
    assert plant.plant.supply_pressure < 7e5 - 2e4


def test_an_axis_that_is_reset_begins_again_while_the_other_goes_on() -> None:
    warm = two().axes["elbow"]
    warm = warm.with_effects([*warm.effects, "friction_warmup"], {"friction_warmup.time_constant": 0.1})
    plant = together(two().with_axes({"elbow": warm}))  # a stiff supply: the axes do not meet
    first = moved(plant, 200)
    elbow, shoulder = plant.simulations["elbow"], plant.simulations["shoulder"]
    elbow.reset()
    elbow.valve.accept(VOLTS["elbow"], 0)
    assert (elbow.time, shoulder.time) == (0.0, pytest.approx(0.4))
    again = moved(plant, 200)
    cold = again["elbow"]  # friction that warms up has begun cold, too
    np.testing.assert_allclose(cold, first["elbow"], rtol=1e-9, atol=1e-12)
    assert np.abs(np.diff(again["shoulder"][:, 0])).max() < 5e-3
    assert abs(again["shoulder"][0, 0] - first["shoulder"][-1, 0]) < 5e-3
    assert shoulder.clock == elbow.clock  # of the stamps, which go on


def test_the_whole_is_reset_with_its_supply() -> None:
    plant = together(two(LINE))
    first = moved(plant, 100)
    plant.reset()
    assert plant.plant.supply_pressure == 7e5
    for axis, one in plant.simulations.items():
        one.valve.accept(VOLTS[axis], 0)
    np.testing.assert_array_equal(moved(plant, 100)["shoulder"], first["shoulder"])


def test_one_axis_takes_other_effects_without_a_jump_of_any() -> None:
    plant = together(two(LINE))
    before = moved(plant, 100)
    elbow = plant.simulations["elbow"]
    elbow.replace(elbow.model.with_effects([*elbow.model.effects, "spring_load", "valve_spool_dynamics"]))
    after = moved(plant, 100)
    for axis in VOLTS:
        assert abs(after[axis][0, 0] - before[axis][-1, 0]) < 5e-3
    assert plant.plant.machine.axes["elbow"].effects[-2:] == ("valve_spool_dynamics", "measured_load")


def test_a_state_that_is_not_finite_is_named_and_the_last_finite_one_kept() -> None:
    plant = together(two())
    moved(plant, 10)
    kept = {axis: one.plant.state.copy() for axis, one in plant.simulations.items()}
    elbow = plant.simulations["elbow"].plant.state
    elbow[1] = 1e200  # m/s: finite, but not for long
    with pytest.raises(NumericalError, match=r"the state of elbow left the finite numbers at t = 0\.020 s"):
        plant.advance(0, 1.0)
    elbow[:] = kept["elbow"]
    np.testing.assert_array_equal(plant.simulations["shoulder"].plant.state, kept["shoulder"])
    plant.advance(0, 1.0)
