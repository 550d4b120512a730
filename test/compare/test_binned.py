"""Binned means: coverage of their intervals, and only dependent variables are reported as explaining."""

import numpy as np
import pytest

from pneumo_ros.compare.binned import bin_means, clusters, edges, explained


def correlated(rng: np.random.Generator, blocks: int, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Values that share half of their scatter within blocks, and their block numbers."""
    cluster = np.repeat(np.arange(blocks), size)
    return rng.normal(size=blocks)[cluster] + rng.normal(size=blocks * size), cluster


@pytest.mark.parametrize("blocks", [4, 40])
def test_intervals_cover_although_neighbours_belong_together(blocks: int) -> None:
    rng, covered = np.random.default_rng(0), []
    for _ in range(300):
        value, cluster = correlated(rng, blocks, 10)
        bins = bin_means(np.zeros(len(value)), value, cluster, np.array([-1.0, 1.0]), 8)
        covered.append(bins.below[0] < 0.0 < bins.above[0])
    assert 0.90 <= np.mean(covered) <= 0.98  # intervals for independent values would cover two thirds


def test_a_bin_of_few_clusters_has_no_interval_and_one_of_few_values_is_left_out() -> None:
    variable = np.array([0.0] * 9 + [1.0] * 3 + [2.0] * 12)
    cluster = np.array([0, 1, 2] * 4 + [3, 4, 5, 6] * 3)
    bins = bin_means(variable, np.ones(24), cluster, np.array([-0.5, 0.5, 1.5, 2.5]), 8)
    assert bins.centre.tolist() == [0.0, 2.0]
    assert bins.count.tolist() == [9.0, 12.0]
    assert np.isnan(bins.below[0])
    assert bins.below[1] == pytest.approx(1.0)


def test_edges_follow_both_width_and_numbers() -> None:
    variable = np.concatenate([np.random.default_rng(0).normal(0.0, 0.01, 5000), np.linspace(-1.0, 1.0, 200)])
    at = edges(variable, 40)
    assert at[0] == variable.min()
    assert at[-1] > variable.max()
    inside = np.sum(np.abs(at) < 0.02)
    assert 12 <= inside <= 28  # about half of the 41 where nearly all values are
    assert np.diff(at).max() < 0.15  # and no bin is wider than twice an even share of the span


def test_constant_and_repeated_values_have_bins_too() -> None:
    assert len(edges(np.full(100, 3.0), 40)) == 2
    steps = np.repeat([0.0, 1.0, 2.0], 50)
    place = np.digitize(steps, edges(steps, 40))
    assert len({place[0], place[60], place[140]}) == 3


def test_only_what_depends_explains() -> None:
    rng = np.random.default_rng(1)
    x, other = rng.uniform(-1.0, 1.0, (2, 2000))
    cluster = np.repeat(np.arange(100), 20)
    value = 2.0 + 3.0 * np.sin(3.0 * x) + rng.normal(size=2000)
    constant, by_x = explained(x, value, cluster, edges(x, 40))
    _, by_other = explained(other, value, cluster, edges(other, 40))
    power = np.mean(value**2)
    assert constant == pytest.approx(np.mean(value) ** 2 / power, abs=0.03)
    assert by_x == pytest.approx(1.0 - constant - 1.0 / power, abs=0.03)
    assert by_other < 0.01


def test_noise_explains_nothing() -> None:
    rng = np.random.default_rng(2)
    shares = [
        explained(x, rng.normal(size=1000), np.arange(1000) // 10, edges(x, 40)) for x in rng.normal(size=(50, 1000))
    ]
    assert np.max(shares) < 0.05


def test_clusters_are_of_one_run_and_half_a_second() -> None:
    time = np.array([0.0, 0.4, 0.6, 0.1])
    found = clusters(time, np.array([0, 0, 0, 1]))
    assert found[0] == found[1]
    assert len({found[0], found[2], found[3]}) == 3


def test_a_window_at_the_end_of_a_cluster_is_of_the_next_however_it_is_rounded() -> None:
    exact = np.arange(0.0, 100.0, 0.4)
    lanes = [clusters(exact * (1.0 + e), np.zeros(len(exact), dtype=np.int64), 0.4) for e in (-2e-16, 0.0, 2e-16)]
    assert all(np.array_equal(found, np.arange(len(exact))) for found in lanes)
