"""Lanes: many simulations at once, each equal to the bit to a run alone."""

import numpy as np
import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model, load_model


@pytest.fixture(scope="module")
def axis() -> Model:
    return load_model("axis")


def varied(model: Model, lanes: int) -> tuple[np.ndarray, np.ndarray, list[Model]]:
    """States and parameters of some lanes, and a model for each lane."""
    random = np.random.default_rng(lanes)
    states = np.array([model.state(y=y, p_a=3e5, p_b=4e5) for y in random.uniform(-0.9, 0.9, lanes)])
    models = [
        model.with_parameters(
            {
                "piston.mass": random.uniform(1.0, 20.0),
                "lugre_friction.coulomb_friction": random.uniform(20.0, 90.0),
                "dead_zone.right_limit": random.uniform(0.1, 1.5),
            }
        )
        for _ in range(lanes)
    ]
    return states, np.array([m.values for m in models]), models


@pytest.mark.parametrize("lanes", [1, 5, 16, 17, 40])
def test_lanes_equal_single_runs_to_the_bit(axis: Model, lanes: int) -> None:
    """For any number of lanes: sliding, sticking and reversing in parallel."""
    states, parameters, models = varied(axis, lanes)
    voltage = np.repeat([4.0, -3.0, 0.0, 6.0, -8.0], 40)
    out = axis.simulate_lanes(voltage, states, parameters)
    assert out.shape == (lanes, 200, 5)
    for lane, model in enumerate(models):
        assert out[lane].tobytes() == model.simulate(voltage, states[lane]).tobytes()


@pytest.mark.parametrize("threads", [2, 3, 64])
def test_threads_change_nothing(axis: Model, threads: int) -> None:
    states, parameters, _ = varied(axis, 40)
    voltage = np.full(50, 5.0)
    one = axis.simulate_lanes(voltage, states, parameters)
    assert axis.simulate_lanes(voltage, states, parameters, threads=threads).tobytes() == one.tobytes()


def test_without_parameters_lanes_use_the_models_own(axis: Model) -> None:
    states, _, _ = varied(axis, 3)
    out = axis.simulate_lanes(np.full(20, 3.0), states)
    assert out[2].tobytes() == axis.simulate(np.full(20, 3.0), states[2]).tobytes()


def test_windows_begin_where_they_are_asked_to(axis: Model) -> None:
    """Multiple shooting: each lane takes its own part of one voltage record, at its own time."""
    voltage, first = np.random.default_rng(1).uniform(-6.0, 6.0, 120), [0, 30, 70]
    states, parameters, models = varied(axis, 3)
    out = axis.simulate_lanes(voltage, states, parameters, first=first, samples=50)
    for lane, begin in enumerate(first):
        alone = models[lane].simulate(voltage[begin : begin + 50], states[lane], start=begin * 1e-3)
        assert out[lane].tobytes() == alone.tobytes()
    assert axis.simulate_lanes(voltage, states, first=first).shape == (3, 50, 5), "as much as there is for the last"


def test_samples_may_hold_several_voltages(axis: Model) -> None:
    states, parameters, models = varied(axis, 4)
    voltage = np.random.default_rng(2).uniform(-6.0, 6.0, 60)
    out = axis.simulate_lanes(voltage, states, parameters, sample_time=2e-3, parts=2, first=[0, 2, 4, 20], samples=20)
    for lane, begin in enumerate([0, 2, 4, 20]):
        held = voltage[begin : begin + 40]
        alone = models[lane].simulate(held, states[lane], sample_time=2e-3, parts=2, start=begin * 1e-3)
        assert out[lane].tobytes() == alone.tobytes()


def test_a_lane_that_leaves_the_numbers_leaves_the_others_alone(axis: Model) -> None:
    states, parameters, models = varied(axis, 5)
    broken = parameters.copy()
    broken[2, list(axis.parameters).index("air.temperature")] = np.nan
    out = axis.simulate_lanes(np.full(200, 6.0), states, broken)
    assert not np.isfinite(out[2]).all()
    assert out[3].tobytes() == models[3].simulate(np.full(200, 6.0), states[3]).tobytes()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"states": np.zeros((2, 4))}, r"lanes do not fit: states \(2, 4\)"),
        ({"parameters": np.zeros((2, 3))}, r"parameters \(2, 3\)"),
        ({"parameters": np.zeros((3, 27))}, r"parameters \(3, 27\)"),
        ({"first": [0]}, r"first \(1,\)"),
        ({"first": [0, 5], "samples": 8}, r"reach beyond the 10 voltages"),
        ({"first": [-1, 0], "samples": 2}, r"reach beyond"),
        ({"voltage": [np.nan] * 10}, r"finite numbers"),
    ],
)
def test_lanes_that_do_not_fit_are_reported(axis: Model, change: dict, sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        axis.simulate_lanes(**{"voltage": np.zeros(10), "states": np.tile(axis.state(), (2, 1)), **change})
