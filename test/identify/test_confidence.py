"""Intervals: they contain the true value as often as stated, also with similar errors within a run."""

import numpy as np
import pytest

from pneumo_ros.identify.confidence import central_jacobian, half_widths

TRUTH = np.array([1.0, 2.0])


def line(groups: int, each: int, shared: float, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[str]]:
    """Estimate, half widths, least errors and groups of a line through points with a common error per group."""
    rng = np.random.default_rng(seed)
    labels = np.repeat(np.arange(groups), each)
    x = rng.uniform(0.0, 1.0, groups)[labels] + 0.01 * rng.standard_normal(len(labels))  # a run has about one speed
    error = rng.standard_normal(len(labels)) + shared * rng.standard_normal(groups)[labels]
    design = np.stack([np.ones(len(x)), x], axis=1)
    estimate = np.linalg.lstsq(design, design @ TRUTH + error, rcond=None)[0]
    residual = design @ estimate - (design @ TRUTH + error)
    half, _ = half_widths(residual, design, np.ones(len(x)), [str(k) for k in labels])
    return estimate, half, design, [str(k) for k in labels]


def coverage(groups: int, each: int, shared: float) -> np.ndarray:
    """Share of 400 repetitions in which the intervals contain each parameter."""
    held = []
    for seed in range(400):
        estimate, half, _, _ = line(groups, each, shared, seed)
        held.append(np.abs(estimate - TRUTH) <= half)
    return np.mean(held, axis=0)


@pytest.mark.parametrize("groups", [6, 14])
def test_intervals_cover_the_truth_with_errors_of_whole_runs(groups: int) -> None:
    share = coverage(groups, 25, shared=1.0)
    assert (share > 0.91).all()
    assert (share < 0.985).all()


def test_intervals_cover_the_truth_with_independent_errors() -> None:
    share = coverage(14, 25, shared=0.0)
    assert (share > 0.93).all()
    assert (share < 0.999).all()


def test_errors_of_whole_runs_widen_the_intervals() -> None:
    """Twenty-five points of one run with a common error count little more than one point."""
    half = line(14, 25, shared=3.0, seed=1)[1]
    alone = line(14, 25, shared=0.0, seed=1)[1]
    assert (half > 5.0 * alone).all()


def test_residuals_below_their_noise_do_not_narrow_the_intervals() -> None:
    """The stated noise is a floor: a lucky fit of few points must not claim more than the sensors allow."""
    x = np.linspace(0.0, 1.0, 40)
    design = np.stack([np.ones(40), x], axis=1)
    half, _ = half_widths(np.full(40, 0.01), design, np.ones(40), ["one"] * 40)
    expected = 2.024 * np.sqrt(np.diag(np.linalg.inv(design.T @ design)))  # Student's t of 38
    np.testing.assert_allclose(half, expected, rtol=1e-3)


def test_correlation_is_that_of_the_inverse() -> None:
    _, _, design, groups = line(14, 25, 0.0, 3)
    _, correlation = half_widths(np.ones(len(design)), design, np.ones(len(design)), groups)
    inverse = np.linalg.inv(design.T @ design)
    assert correlation[0, 1] == pytest.approx(inverse[0, 1] / np.sqrt(inverse[0, 0] * inverse[1, 1]))
    np.testing.assert_allclose(np.diag(correlation), 1.0)


def test_what_is_not_seen_has_no_finite_interval() -> None:
    rng = np.random.default_rng(0)
    seen = rng.standard_normal((60, 2))
    jacobian = np.column_stack([seen, np.zeros(60)])
    half, correlation = half_widths(rng.standard_normal(60), jacobian, np.ones(60), ["run"] * 60)
    assert np.isfinite(half[:2]).all()
    assert np.isinf(half[2])
    assert np.isnan(correlation[2, 0])


def test_what_is_seen_as_a_sum_only_has_no_finite_interval() -> None:
    """The second and third parameter have the same effect: neither is known, the first is."""
    rng = np.random.default_rng(0)
    one, two = rng.standard_normal((2, 60))
    half, _ = half_widths(rng.standard_normal(60), np.column_stack([one, two, -3.0 * two]), np.ones(60), ["run"] * 60)
    assert np.isfinite(half[0])
    assert np.isinf(half[1:]).all()


def test_what_was_known_before_counts_as_information_but_not_as_a_run() -> None:
    rng = np.random.default_rng(0)
    design = np.column_stack([rng.standard_normal(60), np.zeros(60)])
    known = np.vstack([design, [0.0, 2.0]])
    groups = [*(str(k // 6) for k in range(60)), ""]
    half, _ = half_widths(rng.standard_normal(61), known, np.ones(61), groups)
    assert half[1] == pytest.approx(2.0 / 2.0, rel=0.2)  # two deviations of 1 / 2


def test_what_was_known_before_does_not_make_five_runs_six() -> None:
    """Five runs do not show the correlation of errors within runs; the intervals assume independent errors."""
    rng = np.random.default_rng(0)
    shared = 5.0 * rng.standard_normal(5).repeat(12)
    design = np.append(np.ones(60), 1e-3)[:, None]
    groups = [*(str(k // 12) for k in range(60)), ""]
    half, _ = half_widths(np.append(shared, 0.0), design, np.ones(61), groups)
    assert half[0] == pytest.approx(2.0 * np.sqrt(np.mean(shared**2) / 60.0), rel=0.02)


def test_what_one_run_alone_shows_keeps_its_interval() -> None:
    """Leaving that run out leaves nothing: the interval is that of independent errors."""
    rng = np.random.default_rng(0)
    design = np.column_stack([np.ones(60), np.zeros(60)])
    design[:2, 1] = 1.0, 1.1
    groups = [str(k // 6) for k in range(60)]
    half, _ = half_widths(rng.standard_normal(60), design, np.ones(60), groups)
    assert 1.0 < half[1] < 2.0


def test_scale_of_a_parameter_does_not_matter() -> None:
    rng = np.random.default_rng(0)
    design, residual = rng.standard_normal((60, 2)), rng.standard_normal(60)
    groups = [str(k // 6) for k in range(60)]
    half, _ = half_widths(residual, design, np.ones(60), groups)
    small, _ = half_widths(residual, design * [1.0, 1e12], np.ones(60), groups)
    np.testing.assert_allclose(small, half * [1.0, 1e-12])


def test_central_jacobian_of_a_parabola_is_exact() -> None:
    x = np.array([2.0, -0.5, 0.0])
    found = central_jacobian(lambda p: np.array([p[0] ** 2 + p[1], 3.0 * p[2] - p[0] * p[1]]), x)
    np.testing.assert_allclose(found, [[4.0, 1.0, 0.0], [0.5, -2.0, 3.0]], atol=1e-9)
