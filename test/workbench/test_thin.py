"""Long series reduced to the resolution of a screen."""

import base64

import numpy as np
import pytest

from pneumo_ros.workbench.thin import in_view, packed, stretches_in

TIME = np.arange(600_000) * 1e-3
NOISE = np.random.default_rng(3).normal(size=len(TIME))


def test_the_extremes_survive() -> None:
    x, y = in_view(TIME, NOISE, None, 800)
    assert len(x) <= 2 * 800 + 4
    assert (y.min(), y.max()) == (NOISE.min(), NOISE.max())
    assert np.all(np.diff(x) > 0.0)


def test_in_a_narrow_view_is_every_sample_and_a_neighbour_on_both_sides() -> None:
    x, y = in_view(TIME, NOISE, (300.0005, 300.2005), 800)
    assert x == pytest.approx(np.arange(300_000, 300_202) * 1e-3)
    assert np.array_equal(y, NOISE[300_000:300_202])


def test_a_gap_stays_a_gap() -> None:
    broken = NOISE.copy()
    broken[200_000:400_000] = np.nan
    x, y = in_view(TIME, broken, None, 600)
    assert np.isnan(y[(x > 200.5) & (x < 399.5)]).all()
    assert np.isfinite(y[x < 199.0]).all()


def test_nothing_in_view_is_no_error() -> None:
    assert len(in_view(np.empty(0), np.empty(0), (1.0, 2.0))[0]) == 0
    assert len(in_view(TIME, NOISE, (700.0, 800.0))[0]) == 1


def test_numbers_are_packed_as_they_are() -> None:
    found = packed(NOISE[:5])
    assert np.array_equal(np.frombuffer(base64.b64decode(found["bdata"]), found["dtype"]), NOISE[:5])


def test_stretches_in_view_are_joined_where_a_pixel_does_not_part_them() -> None:
    inside = np.zeros(len(TIME), dtype=bool)
    inside[1000:2000] = inside[2001:3000] = inside[500_000:] = True
    assert stretches_in(TIME, inside, None) == [(1.0, 2.999), (500.0, 599.999)]
    assert stretches_in(TIME, inside, (1.9, 2.1)) == [(1.0, 1.999), (2.001, 2.999)]
