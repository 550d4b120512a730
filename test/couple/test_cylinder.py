"""A cylinder beside a mechanism: the same as the plant where the mechanism is a mass, and passive whatever it is."""

import math

import numpy as np
import pytest

from pneumo_ros.couple import Cylinder
from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant import Model, load_model

MASS = 5.0  # kg, of the default machine


@pytest.fixture(scope="module")
def axis() -> Model:
    return load_model("axis")


def test_on_a_free_mass_it_moves_as_the_plant_does(axis: Model) -> None:
    """The mechanism: v += dt F/m. The plant's own trajectory is the reference."""
    volts = 3.0 * np.sin(3.0 * np.arange(1500) * 1e-3)
    expected = axis.simulate(volts, axis.state())
    one, velocity, position = Cylinder(axis), 0.0, 0.0
    for k, voltage in enumerate(volts):
        velocity += 1e-3 * one.step(position, velocity, MASS, 0.0, 1e-3, float(voltage)) / MASS
        position = float(one.state[0])
        assert position == pytest.approx(expected[k, 0], abs=1e-12)
        assert velocity == pytest.approx(expected[k, 1], abs=1e-10)


def test_the_mechanism_has_the_load(axis: Model) -> None:
    """A free acceleration of -g is the weight: the same as a constant load of m g in the plant."""
    heavy = axis.with_effects([*axis.effects, "constant_load"], {"constant_load.load": MASS * 9.81})
    expected = heavy.simulate(np.full(300, 2.0), heavy.state())
    one, velocity, position = Cylinder(heavy), 0.0, 0.0
    for _ in range(300):
        velocity += 1e-3 * (one.step(position, velocity, MASS, -9.81, 1e-3, 2.0) / MASS - 9.81)
        position = float(one.state[0])
    assert velocity == pytest.approx(expected[-1, 1], abs=1e-10)
    assert one.pressures == pytest.approx(tuple(expected[-1, 2:4]))


def test_it_gives_no_energy_from_nothing(axis: Model) -> None:
    """Valve closed, any mass, step, start and pressures: gas and motion gain at most a hundred-thousandth."""
    random, one, worst = np.random.default_rng(7), Cylinder(axis), 0.0
    for _ in range(150):
        mass, dt = 10.0 ** random.uniform(-0.5, 2.0), 10.0 ** random.uniform(-3.3, -2.0)
        position, velocity = random.uniform(-0.5, 0.5), random.uniform(-1.0, 1.0)
        one.reset(position)
        one.pressurise(*random.uniform(1e5, 7e5, 2))
        begin = one.energy() + 0.5 * mass * velocity**2
        for _ in range(100):
            velocity += dt * one.step(position, velocity, mass, 0.0, dt, 0.0) / mass
            position += dt * velocity
            if abs(position) > 0.9:
                break
            one.follow(position)
            worst = max(worst, one.energy() + 0.5 * mass * velocity**2 - begin)
    assert worst < 1e-5 * 1000.0  # J, of about 1000 J in the gas; 0.12 J where the gas does not follow the mechanism


def test_a_stiff_bristle_holds_at_large_steps(axis: Model) -> None:
    """At rest under half the static friction, steps of 10 ms move nothing; a force of the step's begin chatters."""
    one, velocity, position = Cylinder(axis), 0.0, 0.0
    for _ in range(200):
        velocity += 1e-2 * (one.step(position, velocity, 2.0, 10.0, 1e-2, 0.0) / 2.0 + 10.0)
        position += 1e-2 * velocity
    assert abs(velocity) < 1e-4
    assert abs(position) < 1e-3


def test_bad_input_is_refused_and_nothing_lost(axis: Model) -> None:
    one = Cylinder(axis)
    before = one.state.copy()
    for given, words in (
        ((math.nan, 0.0, 1.0, 0.0, 1e-3, 0.0), "it takes finite numbers"),
        ((0.0, 0.0, 0.0, 0.0, 1e-3, 0.0), "take finite numbers above 0"),
        ((0.0, 0.0, 1.0, 0.0, -1e-3, 0.0), "take finite numbers above 0"),
    ):
        with pytest.raises(UsageError, match=words):
            one.step(*given)
    with pytest.raises(NumericalError, match="where a chamber has no volume left"):
        one.step(5.0, 0.0, 1.0, 0.0, 1e-3, 0.0)
    with pytest.raises(UsageError, match="absolute pascals above 0"):
        one.pressurise(-1.0, 1e5)
    assert one.state == pytest.approx(before)
    with pytest.raises(UsageError, match="a section 'chambers'"):
        Cylinder(load_model("emps"))
