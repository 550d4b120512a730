"""Shares of errors at known places."""

import numpy as np
import pytest

from pneumo_ros.compare.shares import Errors, by_regime, pooled, window_share, worst

DT = 1e-3
TIME = np.arange(10_000) * DT


def errors(value: np.ndarray, **masks: np.ndarray) -> Errors:
    """Errors on a grid of 10 s with noise 1."""
    return Errors.of(TIME, value, 1.0, DT, {name: mask.astype(float) for name, mask in masks.items()})


def test_shares_of_a_partition_add_up_and_stand_beside_the_time() -> None:
    early = TIME < 2.0
    found = by_regime(errors(np.where(early, 3.0, 1.0), early=early, late=~early, never=TIME < 0.0))
    assert found.keys() == {"early", "late"}
    assert found["early"].share + found["late"].share == pytest.approx(1.0)
    assert found["early"].share == pytest.approx(2.0 * 9.0 / (2.0 * 9.0 + 8.0))
    assert found["early"].time_share == pytest.approx(0.2)
    assert found["early"].seconds == pytest.approx(2.0)
    assert found["early"].rms == pytest.approx(3.0)
    assert found["early"].ratio_to_noise == pytest.approx(3.0)


def test_ratios_use_the_noise_of_their_own_samples() -> None:
    noise = np.where(TIME < 5.0, 1.0, 10.0)
    found = Errors.of(TIME, noise * 2.0, noise, DT, {"all": np.ones_like(TIME)})
    assert by_regime(found)["all"].ratio_to_noise == pytest.approx(2.0)


def test_what_was_not_predicted_does_not_count() -> None:
    value = np.where(TIME < 5.0, np.nan, 1.0)
    found = by_regime(errors(value, first=TIME < 5.0, second=TIME >= 5.0))
    assert found.keys() == {"second"}
    assert found["second"].share == pytest.approx(1.0)
    assert found["second"].time_share == pytest.approx(1.0)


def test_the_worst_intervals_are_where_the_errors_were_put() -> None:
    value = np.random.default_rng(0).normal(0.0, 1.0, len(TIME))
    value[(TIME > 3.0) & (TIME < 3.6)] += 20.0
    value[(TIME > 7.0) & (TIME < 7.2)] -= 50.0
    first, second, third = worst(errors(value, late=TIME >= 5.0, early=TIME < 5.0))
    assert (first.start, first.end) == pytest.approx((7.0, 7.2), abs=0.2)
    assert first.regimes == ("late",)
    assert (second.start, second.end) == pytest.approx((3.0, 3.6), abs=0.2)
    assert second.regimes == ("early",)
    assert second.ratio_to_noise == pytest.approx(20.0, rel=0.2)
    assert third.ratio_to_noise < 2.0
    assert first.share + second.share > 0.95


def test_one_event_is_named_once() -> None:
    value = 1.0 + 30.0 * np.exp(-(((TIME - 5.0) / 0.3) ** 2))
    first, second, _ = worst(errors(value))
    assert first.start < 5.0 < first.end
    assert second.end < first.start or second.start > first.end
    assert second.ratio_to_noise < 0.3 * first.ratio_to_noise


def test_nothing_has_no_worst_interval() -> None:
    assert worst(errors(np.full(len(TIME), np.nan))) == []
    assert worst(errors(np.zeros(len(TIME)))) == []
    assert by_regime(errors(np.zeros(len(TIME)), all=TIME >= 0.0)) == {}


def test_predictions_that_diverged_still_have_a_place() -> None:
    value = np.ones(len(TIME))
    value[6000:6100] = 1e300
    (interval, *_) = worst(errors(value))
    assert interval.start <= 6.0 <= interval.end
    assert interval.share == pytest.approx(1.0)


def test_runs_pool_by_their_length() -> None:
    short = Errors.of(TIME[:1000], np.full(1000, 2.0), 1.0, DT, {"here": np.ones(1000)})
    both = by_regime(pooled([errors(np.ones(len(TIME)), there=TIME >= 0.0), short]))
    assert both["here"].share == pytest.approx(4.0 * 1000 / (4.0 * 1000 + 10_000))
    assert both["there"].time_share == pytest.approx(10_000 / 11_000)


def test_masks_become_shares_of_windows() -> None:
    mask = (TIME >= 4.0).astype(float)
    shares = window_share(mask, DT, np.array([2.0, 4.0, 6.0, 9.999]), 0.1)
    assert shares == pytest.approx([0.0, 0.5, 1.0, 1.0], abs=0.01)


def test_a_window_holds_as_many_samples_before_its_centre_as_after_it() -> None:
    shares = window_share(np.arange(100.0), DT, DT * np.array([0.0, 50.0, 99.0]), 10 * DT)
    assert shares == pytest.approx([2.5, 50.0, 96.5])
