"""Weighted means of rates in windows: the integral of what a model claims, with input steps included."""

import numpy as np
import pytest

from pneumo_ros.equations.bump import Bump
from pneumo_ros.equations.equations import centred


@pytest.mark.parametrize(("duration", "samples"), [(0.04, 41), (0.1, 1000), (0.2, 1003)])
def test_means_are_those_of_both_intervals_around_each_sample(duration: float, samples: int) -> None:
    bump, draw = Bump.of(duration, 1e-3), np.random.default_rng(1)
    rates, factor = draw.normal(size=(2, samples))
    expected = bump.apply(bump.phi, centred(rates * factor))
    np.testing.assert_allclose(bump.means(rates, factor), expected, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(bump.means(rates), bump.apply(bump.phi, centred(rates)), rtol=0.0, atol=1e-12)


def test_means_of_every_second_column_need_no_copy() -> None:
    """The claimed rates of a chamber are a column among others."""
    bump, rates = Bump.of(0.04, 1e-3), np.random.default_rng(2).normal(size=(300, 2))
    np.testing.assert_array_equal(bump.means(rates[:, 1]), bump.means(rates[:, 1].copy()))


def test_a_recording_that_is_shorter_than_a_window_has_none() -> None:
    assert len(Bump.of(0.04, 1e-3).means(np.ones(40))) == 0
