"""Sentences of `pneumo identify`."""

from typing import Any

from pneumo_ros.command.identification_text import text


def result(**changes: Any) -> dict[str, Any]:
    """A small result, for wording."""
    one = {
        "before": 77.0,
        "value": 70.0,
        "low": 69.5,
        "high": 70.5,
        "unit": "N",
        "determined": True,
        "source": "steady motion",
    }
    quality = {"residual_rms_n": 0.5, "share_of_force": 0.005, "ratio_to_noise": 5.0}
    points = {"velocity": [0.1], "velocity_std": [5e-6], "force_std": [0.01]}
    flags = {"explained_by_noise": False, "fits": True, "window_s": 0.25, "points": points}
    return {
        "parameters": {"a.b": one}, "undetermined": {}, "correlations": [], "map": quality | flags | changes,
        "runs": [], "breakaways": [], "refused": [], "motion": None,
    }  # fmt: skip


def test_wording_of_a_map_that_fits_roughly_or_not_at_all() -> None:
    roughly = text(result(), verbose=False)
    assert "The static map fits roughly: residuals are 0.5 N rms, 0.5 % of the force and 5 x the noise." in roughly
    assert "The static map does NOT fit" in text(result(fits=False), verbose=False)
    assert "The static map fits: residuals" in text(result(explained_by_noise=True), verbose=False)


def test_wording_of_strong_correlation() -> None:
    pair = {"between": ["a.b", "a.c"], "r": -0.97, "strong": True}
    said = text(result() | {"correlations": [pair, pair | {"r": 0.5, "strong": False}]}, verbose=False)
    assert said.count("hard to distinguish") == 1
    assert "a.b and a.c are hard to distinguish (correlation -0.97)" in said
    assert "their errors go against each other" in said
