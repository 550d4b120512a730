"""Sensor readings along lanes: as `outputs` gives, with each lane's own parameters and the time of each sample."""

from pathlib import Path

import numpy as np
import pytest
from plant.user_files import AXIS, composed

from pneumo_ros.plant import Model
from pneumo_ros.plant.sensing import sense

OFFSET, DELAY = "pressure_sensor_offset", "position_sensor_delay"
VOLTAGE = np.repeat([2.0, -2.0, 0.5], 40)


def with_sensors(*effects: str) -> Model:
    """The default machine with effects on its sensors, of their usual size."""
    return AXIS.with_effects([*AXIS.effects, *effects])


def lanes(model: Model, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Initial states and parameters that differ from lane to lane."""
    rng = np.random.default_rng(seed)
    states = np.tile(model.state(p_a=3e5, p_b=4e5), (count, 1)) * rng.uniform(0.9, 1.1, (count, 1))
    parameters = np.tile(model.values, (count, 1)) * rng.uniform(0.97, 1.03, (count, len(model.parameters)))
    return states, parameters


def test_true_sensors_read_the_states() -> None:
    states = AXIS.simulate(VOLTAGE, AXIS.state(p_a=3e5, p_b=4e5))[None]
    assert AXIS.composition.true_sensors
    read = sense(AXIS, states, None, VOLTAGE, np.zeros(1, dtype=np.int64))
    np.testing.assert_array_equal(read, states[:, :, [0, 2, 3]])


def test_every_lane_is_read_with_its_own_parameters() -> None:
    model = with_sensors(OFFSET, "pressure_sensor_gain", DELAY, "backlash")
    states, parameters = lanes(model, 5)
    runs = model.simulate_lanes(VOLTAGE, states, parameters)
    read = sense(model, runs, parameters, VOLTAGE, np.zeros(5, dtype=np.int64))
    for lane in range(5):
        alone = model.with_parameters(dict(zip(model.parameters, parameters[lane], strict=True)))
        seen = alone.outputs(runs[lane], VOLTAGE)
        for i, name in enumerate(("y_measured", "p_a_measured", "p_b_measured")):
            assert read[lane, :, i].tobytes() == seen[name].tobytes()
    assert np.abs(read[:, :, 1] - runs[:, :, 2]).min() > 1e3


DRIFTING = '''
class Drifting(Effect):
    """A sensor that drifts with time and follows the voltage: made up, to see both arrive."""
    rate = Parameter(1.0, "m/s", "drift")

    def equations(y_measured, U, t, rate):
        y_measured = y_measured + rate * t + 100.0 * U
        return y_measured
'''


def test_own_and_common_parameters_need_one_compilation() -> None:
    model = with_sensors(OFFSET)
    states = np.tile(model.state(p_a=3e5, p_b=4e5), (1, 120, 1))
    for q in (None, model.values[None]):
        sense(model, states, q, VOLTAGE, np.zeros(1, dtype=np.int64))
    assert len(model.kernel.sense.signatures) == 1


def test_time_and_voltage_are_those_of_the_sample(tmp_path: Path) -> None:
    model = composed(tmp_path, DRIFTING, "drifting")
    read = sense(
        model, np.zeros((2, 3, len(model.states))), None, np.arange(20.0), np.array([0, 10]),
        sample_time=0.5, start=np.array([7.0, 0.0]), parts=2,
    )  # fmt: skip
    assert read[0, :, 0] == pytest.approx([7.5 + 100.0, 8.0 + 300.0, 8.5 + 500.0])
    assert read[1, :, 0] == pytest.approx([3.0 + 1100.0, 3.5 + 1300.0, 4.0 + 1500.0])
