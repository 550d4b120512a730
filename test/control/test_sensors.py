"""Simulated sensors: the stated noise, no velocity, and repeatable by their seed."""

import numpy as np
import pytest

from pneumo_ros.control.sensors import NoisySensors

STATE = np.array([0.1, 0.2, 3e5, 4e5, 0.0])


def test_noise_is_as_stated_and_velocity_is_not_measured() -> None:
    sensors = NoisySensors(1e-5, 300.0)
    seen = [sensors(1e-3 * k, STATE) for k in range(10_000)]
    assert all(one.velocity is None for one in seen)
    values = np.array([(one.position, one.pressure_a, one.pressure_b) for one in seen])
    assert values.mean(axis=0) == pytest.approx(STATE[[0, 2, 3]], rel=1e-4)
    assert values.std(axis=0) == pytest.approx([1e-5, 300.0, 300.0], rel=0.03)
    assert np.abs(np.corrcoef(values.T) - np.eye(3)).max() < 0.05


def test_a_seed_repeats_and_another_does_not() -> None:
    one, same, other = (NoisySensors(seed=seed)(0.0, STATE) for seed in (1, 1, 2))
    assert one == same
    assert one != other
