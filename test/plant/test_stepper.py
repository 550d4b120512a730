"""The stepper of nodes: the same numbers as a simulation, and a plant that can be changed while it runs."""

import numpy as np
import pytest

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant import Model, Stepper, load_model


@pytest.fixture(scope="module")
def axis() -> Model:
    return load_model("axis")


@pytest.fixture
def stepper(axis: Model) -> Stepper:
    return Stepper(axis, axis.state(y=0.1, p_a=3e5, p_b=4e5))


def advanced(stepper: Stepper, voltages: np.ndarray) -> np.ndarray:
    """States after each of the given voltages."""
    return np.array([stepper.advance(float(voltage)).copy() for voltage in voltages])


def test_advancing_equals_simulating(axis: Model, stepper: Stepper) -> None:
    voltage = np.random.default_rng(5).uniform(-8.0, 8.0, 300)
    rows = advanced(stepper, voltage)
    assert rows.tobytes() == axis.simulate(voltage, axis.state(y=0.1, p_a=3e5, p_b=4e5)).tobytes()
    assert stepper.time == pytest.approx(0.3)


def test_other_samples_and_steps(axis: Model) -> None:
    stepper = Stepper(axis, axis.state(), sample_time=2e-3, step=5e-5)
    voltage = np.full(50, 4.0)
    expected = axis.simulate(voltage, axis.state(), sample_time=2e-3, step=5e-5)
    assert advanced(stepper, voltage).tobytes() == expected.tobytes()


def test_replacing_the_model_keeps_states_and_time(axis: Model, stepper: Stepper) -> None:
    advanced(stepper, np.full(200, 5.0))
    before = stepper.state.copy()
    heavy = axis.with_parameters({"piston.mass": 10.0})
    stepper.replace(heavy)
    assert stepper.state.tobytes() == before.tobytes()
    assert stepper.time == pytest.approx(0.2)
    assert stepper.advance(5.0).tobytes() == heavy.simulate([5.0], before)[0].tobytes()


def test_effects_come_and_go_with_their_states(axis: Model, stepper: Stepper) -> None:
    advanced(stepper, np.full(300, 5.0))
    kept = stepper.state[:4].copy()
    assert stepper.state[4] != 0.0
    stepper.replace(axis.with_effects(["dead_zone", "arctan_flow"]))
    assert stepper.state.tobytes() == kept.tobytes()
    stepper.replace(axis)
    assert stepper.state.tolist() == [*kept, 0.0], "the bristle restarts at rest"


def test_a_model_that_cannot_be_leaves_the_old_one(axis: Model, stepper: Stepper) -> None:
    before = stepper.state.copy()
    with pytest.raises(UsageError, match="no volume left"):
        stepper.replace(axis.with_parameters({"chambers.volume_a": 1e-6}))
    assert stepper.model is axis
    assert stepper.state.tobytes() == before.tobytes()


def test_after_a_numerical_error_the_last_good_state_stands(axis: Model, stepper: Stepper) -> None:
    advanced(stepper, np.full(100, 5.0))
    good, time = stepper.state.copy(), stepper.time
    stepper.state[1] = 1e200
    with pytest.raises(NumericalError, match=r"left the finite numbers at t = 0.100 s"):
        stepper.advance(5.0)
    assert stepper.state[1] == 1e200
    stepper.state[1] = good[1]
    assert stepper.state.tobytes() == good.tobytes()
    assert stepper.time == time
    assert stepper.advance(5.0).tobytes() == axis.simulate([5.0], good)[0].tobytes()


@pytest.mark.parametrize("voltage", [float("nan"), float("inf")])
def test_a_voltage_that_is_not_a_number_is_refused(stepper: Stepper, voltage: float) -> None:
    before = stepper.state.copy()
    with pytest.raises(UsageError, match=f"voltage is {voltage}"):
        stepper.advance(voltage)
    assert stepper.state.tobytes() == before.tobytes()


def test_resetting_starts_again(axis: Model, stepper: Stepper) -> None:
    first = advanced(stepper, np.full(50, 5.0))
    stepper.reset(axis.state(y=0.1, p_a=3e5, p_b=4e5))
    assert stepper.time == 0.0
    assert advanced(stepper, np.full(50, 5.0)).tobytes() == first.tobytes()
    with pytest.raises(UsageError, match="finite numbers"):
        stepper.reset(np.zeros(3))


def test_a_state_given_is_not_written_to(axis: Model) -> None:
    given = axis.state()
    Stepper(axis, given).advance(7.0)
    assert given.tobytes() == axis.state().tobytes()


def test_states_that_do_not_fit_are_reported(axis: Model) -> None:
    with pytest.raises(UsageError, match="must hold 5 finite numbers"):
        Stepper(axis, np.zeros(4))
    with pytest.raises(UsageError, match="must be positive"):
        Stepper(axis, axis.state(), sample_time=0.0)
