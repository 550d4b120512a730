"""The friction observer against the plant's own friction; it is stable, elastic and able to learn."""

import numpy as np
import pytest

from pneumo_ros.control import Machine
from pneumo_ros.control.friction import FrictionObserver
from pneumo_ros.plant import load_model

DT = 1e-3
AXIS = load_model("axis")


def follow(observer: FrictionObserver, velocity: np.ndarray, dt: float = DT) -> np.ndarray:
    return np.array([observer.step(float(v), dt) for v in velocity])


def plant_friction(velocity: np.ndarray) -> np.ndarray:
    """The friction force of the plant, driven along the same motion."""
    fine = 20
    position = np.concatenate([[0.0], np.cumsum(velocity) * DT])
    measured = np.column_stack([position, np.append(velocity, velocity[-1]), *[np.full(len(position), 3e5)] * 2])
    states, _ = AXIS.follow(measured, np.zeros(len(velocity)), [0.0], sample_time=DT, step=DT / fine)
    return AXIS.outputs(states, np.zeros(len(states)))["friction"][1:]


def test_along_a_motion_with_reversals_it_is_the_plants_friction() -> None:
    """Except for sigma_1 and the ramp of alpha: 5 N of 100 while the bristles reverse, 1 N while they slide."""
    time = DT * np.arange(4000)
    velocity = 0.05 * np.sin(2 * np.pi * 0.5 * time) + 0.02 * np.sin(2 * np.pi * 1.7 * time)
    ours, theirs = follow(FrictionObserver(Machine()), velocity), plant_friction(velocity)
    assert np.abs(ours - theirs).max() < 12.0
    sliding = np.abs(velocity) > 0.03
    assert np.abs(ours - theirs)[sliding].max() < 2.0


@pytest.mark.parametrize("velocity", [-0.3, -0.01, 0.01, 0.2])
def test_the_running_slope_is_the_derivative_of_what_grows_with_speed(velocity: float) -> None:
    observer, step = FrictionObserver(Machine(viscous_friction=30.0, drag=4000.0)), 1e-6
    slope = (observer.running(velocity + step) - observer.running(velocity - step)) / (2.0 * step)
    assert observer.running_slope(velocity) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("velocity", [0.001, 0.02, 0.18, 3.0])
@pytest.mark.parametrize("dt", [1e-4, 1e-3, 1e-2])
def test_steady_sliding_is_exact_at_any_speed_and_sample_time(velocity: float, dt: float) -> None:
    """An explicit step is unstable beyond v dt = 2 g / sigma_0, 0.1 mm."""
    observer = FrictionObserver(Machine())
    force = follow(observer, np.full(int(3e-3 / (velocity * dt)) + 50, velocity), dt)[-1]
    assert force == pytest.approx(observer.level(velocity) + observer.running(velocity), rel=1e-9)


def test_the_step_does_not_depend_on_how_a_motion_is_cut() -> None:
    whole, cut = FrictionObserver(Machine()), FrictionObserver(Machine())
    for v in (0.004, 0.05, -0.03, -0.001, 0.02):
        whole.step(v, 8e-3)
        for _ in range(8):
            cut.step(v, 1e-3)
        assert whole.z == pytest.approx(cut.z, rel=1e-9)


def test_presliding_is_elastic_and_lugre_is_not() -> None:
    """A load that swings below breakaway leaves no deflection behind; with ratio 0, plain LuGre, it does."""
    swing = 0.9e-3 * np.sin(2 * np.pi * 20.0 * DT * np.arange(2000)) + 0.2e-3
    swing[1000:] = -swing[:1000]
    elastic, plastic = FrictionObserver(Machine()), FrictionObserver(Machine(breakaway_ratio=0.0))
    follow(elastic, 0.05 * swing)
    follow(plastic, 0.05 * swing)
    assert abs(elastic.z) < 1e-12
    assert abs(plastic.z) > 1e-8


def test_a_correction_brings_sticking_bristles_to_breakaway_and_no_further_than_it_may() -> None:
    observer = FrictionObserver(Machine())
    for _ in range(200):
        observer.step(0.0, DT, 1e-3)
    assert observer.force(0.0) > Machine().static_friction
    assert observer.force(0.0) <= 1.5 * Machine().static_friction + 1e-9


def test_sliding_both_ways_separates_friction_from_load() -> None:
    machine = Machine()
    observer, friction, load = FrictionObserver(machine), 1.2, 25.0
    for k in range(40_000):
        v = 0.06 if (k // 1000) % 2 else -0.06
        observer.step(v, DT)
        sliding = friction * np.copysign(observer.level(v), v) + observer.running(v) + load
        observer.learn(float(sliding), v, 0.01)
    assert observer.scale == pytest.approx(friction, abs=0.02)
    assert observer.bias == pytest.approx(load, abs=1.5)


def test_what_was_learnt_fades_while_it_sticks_and_stays_within_reason() -> None:
    observer = FrictionObserver(Machine())
    observer.step(0.1, 0.01)
    for _ in range(100):
        observer.learn(1e6, 0.1, 1.0)
    assert observer.scale <= 3.0
    assert observer.bias <= 0.5 * Machine().area_a * 6e5
    for _ in range(10_000):
        observer.step(0.0, DT)
    assert abs(observer.bias) < 2.0


def bent(observer: FrictionObserver) -> float:
    """Force of the bristles [N]."""
    return observer.z * observer.machine.bristle_stiffness


def test_bristles_that_are_held_go_the_way_of_the_correction_or_stay() -> None:
    observer = FrictionObserver(Machine())
    observer.step(0.0, DT, 0.02)
    before = observer.z
    observer.step(-0.01, DT, 1e-6, held=True)
    assert observer.z == before
    observer.step(0.005, DT, 1e-6, held=True)
    assert observer.z == pytest.approx(before + 5e-6 + 1e-9)
    observer.step(-0.01, DT, 1e-6)
    assert observer.z < before


def test_one_that_waits_is_loaded_for_where_it_is_to_go_and_no_farther() -> None:
    observer = FrictionObserver(Machine())
    observer.step(0.0, DT, -0.03)
    for _ in range(20):
        observer.wait(0.05, DT, 0.01)
    assert bent(observer) == pytest.approx(0.9 * observer.machine.coulomb_friction)
    observer.step(0.0, DT, 0.02)
    beyond = observer.z
    observer.wait(0.0, DT, 0.01)
    assert observer.z == beyond
    assert not observer.sliding
