"""Packed long series are restored to their resolution; the browser's side is tested in test_plots."""

import base64
import zlib
from typing import Any

import numpy as np
import pytest

from pneumo_ros.report.series import encode, extremes


def decoded(packed: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """A packed series, unpacked as by the page's script."""

    def unpack(part: dict[str, Any]) -> np.ndarray:
        raw = np.frombuffer(zlib.decompress(base64.b64decode(part["data"])), dtype=np.uint8)
        folded = raw.reshape(4, -1).T.copy().view("<u4").ravel().astype(np.int64)
        values = np.where(folded % 2, -(folded + 1) // 2, folded // 2)
        for _ in range(part["order"]):
            values = np.cumsum(values)
        return values

    y = unpack(packed["y"]) * packed["scale"]
    for begin, end in packed["gaps"]:
        y[begin:end] = np.nan
    at = unpack(packed["x"]) if "x" in packed else np.arange(packed["count"])
    return packed["start"] + packed["step"] * at, y


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_values_come_back_to_half_a_step(noise: float) -> None:
    x = 2.0 + 1e-3 * np.arange(5000)
    y = np.sin(x) + np.random.default_rng(0).normal(0.0, 1.0, len(x)) * noise
    found_x, found_y = decoded(encode(x, y, 2e-4))
    assert found_x == pytest.approx(x, abs=1e-9)
    assert found_y == pytest.approx(y, abs=1.001e-4)


def test_gaps_and_infinities_come_back_as_gaps() -> None:
    x = np.arange(10.0)
    y = np.array([np.nan, 1.0, 2.0, np.inf, np.nan, 5.0, -np.inf, 7.0, 8.0, np.nan])
    found = decoded(encode(x, y, 0.5))[1]
    assert np.isnan(found).tolist() == (~np.isfinite(y)).tolist()
    assert found[[1, 2, 5, 7, 8]].tolist() == [1.0, 2.0, 5.0, 7.0, 8.0]


@pytest.mark.parametrize("y", [np.full(4, np.nan), np.empty(0), np.array([3.0])])
def test_there_may_be_next_to_nothing(y: np.ndarray) -> None:
    x, found = decoded(encode(np.arange(float(len(y))), y, 0.1))
    assert len(x) == len(found) == len(y)
    assert found == pytest.approx(y, abs=0.05, nan_ok=True)


def test_uneven_times_come_back() -> None:
    index = np.array([0, 1, 5, 6, 7, 100])
    x = 1e-3 * index
    assert decoded(encode(x, x, 1e-6))[0] == pytest.approx(x, abs=1e-12)


def test_what_diverges_is_stored_coarsely_instead_of_overflowing() -> None:
    y = np.array([0.0, 1e30, -1e30, 1e30, 5.0])
    found = decoded(encode(np.arange(5.0), y, 1e-6))[1]
    assert found == pytest.approx(y, abs=1e22)


def test_a_noisy_sample_takes_less_than_a_byte_and_a_half() -> None:
    y = np.cumsum(np.random.default_rng(0).normal(0.0, 0.01, 20_000)) + np.random.default_rng(1).normal(
        0.0, 1.0, 20_000
    )
    assert len(encode(1e-3 * np.arange(20_000), y, 0.2)["y"]["data"]) < 1.5 * 20_000


def test_every_bucket_keeps_its_extremes() -> None:
    error = np.random.default_rng(0).normal(size=1003)
    error[500:520] = np.nan
    kept = extremes(error, 10)
    assert len(kept) <= 2 * 101 + 5
    assert (np.diff(kept) > 0).all()
    assert (kept[0], kept[-1]) == (0, 1002)
    for begin in [*range(0, 500, 10), *range(520, 1000, 10)]:
        inside = error[kept[(kept >= begin) & (kept < begin + 10)]]
        assert (inside.min(), inside.max()) == (error[begin : begin + 10].min(), error[begin : begin + 10].max())


def test_small_buckets_keep_everything() -> None:
    assert extremes(np.arange(7.0), 2).tolist() == list(range(7))
