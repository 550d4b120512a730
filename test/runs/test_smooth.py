"""Local polynomials: exact on polynomials, with noise as stated."""

import numpy as np
import pytest

from pneumo_ros.runs.smooth import noise_gain, smooth

CASES = [(1e-3, 0.012, 3, 0), (1e-3, 0.012, 3, 1), (1e-3, 0.018, 3, 2), (4e-3, 0.012, 3, 1), (5e-4, 0.012, 2, 0)]


@pytest.mark.parametrize(("dt", "half_width", "order", "derivative"), CASES)
def test_stated_noise_is_measured_noise(dt: float, half_width: float, order: int, derivative: int) -> None:
    white = np.random.default_rng(0).normal(0.0, 1.0, 200_000)
    inner = smooth(white, dt, half_width, order, derivative)[1000:-1000]
    assert np.std(inner) == pytest.approx(noise_gain(dt, half_width, order, derivative), rel=0.02)


@pytest.mark.parametrize(("dt", "half_width", "order", "derivative"), CASES)
def test_polynomials_are_exact_to_both_ends(dt: float, half_width: float, order: int, derivative: int) -> None:
    polynomial = np.polynomial.Polynomial([0.3, -2.0, 5.0, 7.0][: order + 1])
    time = np.arange(200) * dt
    expected = polynomial.deriv(derivative)(time) if derivative else polynomial(time)
    found = smooth(polynomial(time), dt, half_width, order, derivative)
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("samples", [5, 6, 7, 20, 24, 25, 26])
def test_signals_shorter_than_the_window(samples: int) -> None:
    time = np.arange(samples) * 1e-3
    found = smooth(0.2 + 3.0 * time, 1e-3, 0.012, 3, 1)
    assert found.shape == (samples,)
    np.testing.assert_allclose(found, 3.0, rtol=1e-6)


def test_a_wider_window_is_quieter() -> None:
    gains = [noise_gain(1e-3, half_width, 3, 1) for half_width in (0.006, 0.012, 0.024)]
    assert gains[0] > 2.0 * gains[1] > 4.0 * gains[2]


def test_the_signal_is_not_delayed() -> None:
    time = np.arange(2000) * 1e-3
    found = smooth(np.sin(2.0 * np.pi * time), 1e-3, 0.012, 3, 1)
    error = found - 2.0 * np.pi * np.cos(2.0 * np.pi * time)
    assert np.abs(error[20:-20]).max() < 1e-4 * 2.0 * np.pi
