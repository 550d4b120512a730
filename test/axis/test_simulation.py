"""The running plant without ROS: equal to the model, changed without jumps, measured as configured."""

import numpy as np
import pytest

from pneumo_ros.axis.simulator.machine import changed, machine_from_parameters
from pneumo_ros.axis.simulator.sensors import Reading, Sensors
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
RATE, STEP = 500.0, 1e-4
TRUE = Reading(0.1, 0.2, 3e5, 2e5)


def simulation(sensors: Sensors | None = None) -> Simulation:
    return Simulation(AXIS, ValveInput(10.0, 0.0), sensors or Sensors(), rate=RATE, step=STEP)


def drive(plant: Simulation, samples: int, voltage: float = 2.0) -> np.ndarray:
    """States after each sample at a constant voltage."""
    rows = []
    for _ in range(samples):
        plant.valve.accept(voltage, 0)
        plant.advance(0, 1.0)
        rows.append(plant.plant.state.copy())
    return np.array(rows)


def test_it_is_the_model() -> None:
    states = drive(simulation(), 300)
    assert np.array_equal(states, AXIS.simulate(np.full(300, 2.0), AXIS.state(), sample_time=1.0 / RATE, step=STEP))


def driven_by_two(plant: Simulation) -> list[np.ndarray]:
    """States after each of 200 samples with 2 V at the valve of chamber a and 4 V at that of chamber b."""
    rows = []
    for _ in range(200):
        plant.valve.accept(2.0, 0)
        plant.valve_b.accept(4.0, 0)
        plant.advance(0, 1.0)
        rows.append(plant.plant.state.copy())
    return rows


def test_a_valve_for_each_chamber_takes_a_command_of_its_own() -> None:
    two = AXIS.with_effects([*AXIS.effects, "second_valve"], {"second_valve.offset": -5.0})
    plant = Simulation(two, ValveInput(10.0, 0.0), Sensors(), rate=RATE, step=STEP)
    rows = driven_by_two(plant)
    held = np.tile([2.0, 4.0], (200, 1))
    assert np.array_equal(rows, two.simulate(held, two.state(), sample_time=1.0 / RATE, step=STEP))
    plant.reset()
    assert (plant.valve.voltage, plant.valve_b.voltage) == (0.0, 5.0), "each closed"


def test_an_external_force_and_two_commands_act_together() -> None:
    two = AXIS.with_effects(["second_valve", *AXIS.effects], {"second_valve.offset": -5.0})
    plant = Simulation(two, ValveInput(10.0, 0.0), Sensors(), rate=RATE, step=STEP)
    plant.force.accept(150.0)
    rows = driven_by_two(plant)
    model, given = plant.described, {"U": 2.0, "U_b": 4.0, "load_force": 150.0}
    held = np.tile([given[name] for name in model.inputs], (200, 1))
    assert set(model.inputs) == set(given)
    assert np.array_equal(rows, model.simulate(held, model.state(), sample_time=1.0 / RATE, step=STEP))
    assert plant.load_cell == 150.0


def test_readings_and_effort_are_those_of_the_state() -> None:
    plant = simulation()
    drive(plant, 200)
    y, v, p_a, p_b, _ = plant.plant.state
    assert plant.reading == (y, v, p_a, p_b)
    assert plant.effort == pytest.approx(float(AXIS.effort(plant.plant.state)))
    assert plant.time == pytest.approx(0.4)


def test_other_parameters_and_effects_leave_the_state_as_it_is() -> None:
    plant = simulation()
    drive(plant, 200)
    before = dict(zip(AXIS.states, plant.plant.state.copy(), strict=True))
    for model in (
        AXIS.with_parameters({"piston.mass": 20.0}),
        AXIS.with_effects([name for name in AXIS.effects if name != "lugre_friction"]),
        AXIS,
    ):
        plant.replace(model)
        now = dict(zip(model.states, plant.plant.state, strict=True))
        assert {name: now[name] for name in ("y", "v", "p_a", "p_b")} == {
            n: before[n] for n in ("y", "v", "p_a", "p_b")
        }
    assert plant.plant.state[AXIS.states.index("z")] == 0.0  # it left and came back at rest


def test_reset_repeats_the_run_and_time_goes_on_in_the_stamps() -> None:
    plant = simulation(Sensors(noise_position=1e-5, seed=3))
    first, clock = drive(plant, 50), plant.clock
    reading = plant.reading
    plant.reset()
    assert np.array_equal(drive(plant, 50), first)
    assert plant.reading == reading
    assert plant.clock == clock + 50 * 2_000_000


def test_noise_has_its_level_and_its_seed() -> None:
    sensors = Sensors(noise_position=1e-5, noise_pressure=300.0, seed=7)
    readings = np.array([sensors.read(TRUE) for _ in range(20_000)])
    assert readings[:, 0].std() == pytest.approx(1e-5, rel=0.03)
    assert readings[:, 2:].std(axis=0) == pytest.approx([300.0, 300.0], rel=0.03)
    assert (readings[:, 1] == 0.2).all()
    again = Sensors(noise_position=1e-5, noise_pressure=300.0, seed=7)
    assert again.read(TRUE) == tuple(readings[0])
    assert Sensors(noise_position=1e-5, seed=8).read(TRUE).position != readings[0, 0]
    assert sensors.pressure_variance == 300.0**2


def test_one_level_does_not_change_the_noise_of_another() -> None:
    both, one = Sensors(1e-5, 300.0, seed=1), Sensors(0.0, 300.0, seed=1)
    assert [both.read(TRUE).pressure_b for _ in range(9)] == [one.read(TRUE).pressure_b for _ in range(9)]


def test_quantisation_rounds_and_widens_the_variance() -> None:
    sensors = Sensors(quantisation_position=1e-3, quantisation_pressure=12.0, publish_velocity=False)
    reading = sensors.read(Reading(0.12345, 0.2, 1e5 + 7.0, 1e5 + 5.0))
    assert reading == pytest.approx((0.123, None, 100_008.0, 100_008.0), abs=1e-9)
    assert sensors.pressure_variance == pytest.approx(12.0)


def test_a_whole_machine_file_stands_alone() -> None:
    whole = {"effects": list(AXIS.effects), **AXIS.parameters}
    assert dict(machine_from_parameters("paper", whole).parameters) == dict(AXIS.parameters)
    del whole["piston.stroke"]
    with pytest.raises(UsageError, match=r"piston.stroke is missing"):
        machine_from_parameters("axis", whole)


def test_single_parameters_change_the_base() -> None:
    model = machine_from_parameters("paper", {"piston.mass": 7.0})
    assert model["piston.mass"] == 7.0
    assert "rod_atmospheric_force" not in model.effects
    shorter = machine_from_parameters("axis", {"effects": ["dead_zone", "arctan_flow", "lugre_friction"]})
    assert shorter.effects == ("dead_zone", "arctan_flow", "lugre_friction")


def test_nothing_changed_is_the_same_model() -> None:
    assert changed(AXIS, {**AXIS.parameters, "effects": list(AXIS.effects), "noise_position": 1.0}) is AXIS
    assert changed(AXIS, {"piston.mass": 6.0})["piston.mass"] == 6.0
    with pytest.raises(UsageError, match="end_stop"):
        changed(AXIS, {"effects": ["end_stp"]})
