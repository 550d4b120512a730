"""Regimes of known motions: constructed by hand, and simulated."""

import numpy as np
import pytest
from identify.making import own

from pneumo_ros.compare.along import Along, along
from pneumo_ros.compare.regimes import MEANING, regimes, stretches
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run

DT = 1e-3
NOISE = 5e-6  # m


def moved(velocity: np.ndarray, start: float = 0.0, voltage: float = 2.0) -> Along:
    """A noisy run of the given velocity [m/s] with both pressures at 3 bar and a held voltage."""
    n = len(velocity)
    position = start + np.cumsum(velocity) * DT + np.random.default_rng(0).normal(0.0, NOISE, n)
    pressure = np.full(n, 3e5)
    held = np.full((n - 1) * PARTS, voltage)
    return along(load_model(), Run("hand", DT, position, pressure, pressure, held, np.ones(n, dtype=bool), False))


def phase(*parts: tuple[float, float]) -> np.ndarray:
    """Velocities held for some seconds each."""
    return np.concatenate([np.full(round(seconds / DT), velocity) for velocity, seconds in parts])


def spans(mask: np.ndarray) -> list[tuple[float, float]]:
    """Begin and end of the true stretches [s]."""
    return [(a * DT, b * DT) for a, b in zip(*stretches(mask), strict=True)]


def test_rest_between_two_motions_is_stick_and_ends_in_a_breakaway() -> None:
    masks = regimes(moved(phase((0.1, 0.5), (0.0, 0.6), (0.1, 0.5))))
    ((begin, end),) = spans(masks["stick"])
    assert begin == pytest.approx(0.5, abs=0.015)  # velocities are means over +-12 ms
    assert end == pytest.approx(1.1, abs=0.015)
    ((before, after),) = spans(masks["breakaway"])
    assert before == pytest.approx(end - 0.02, abs=1e-9)
    assert after == pytest.approx(end + 0.1, abs=1e-9)
    assert not masks["reversal"].any()


def test_stick_and_slide_part_the_time() -> None:
    masks = regimes(along(*own("creep", seconds=5.0)[::2]))
    assert masks["stick"].any()
    assert masks["slide"].any()
    assert (masks["stick"] ^ masks["slide"]).all()


def test_a_change_of_direction_is_a_reversal_unless_the_piston_rests_in_it() -> None:
    quick = regimes(moved(phase((0.1, 0.5), (-0.1, 0.5))))
    ((begin, end),) = spans(quick["reversal"])
    assert begin == pytest.approx(0.45, abs=0.02)
    assert end == pytest.approx(0.55, abs=0.02)
    assert not quick["stick"].any()
    rested = regimes(moved(phase((0.1, 0.5), (0.0, 0.5), (-0.1, 0.5))))
    assert not rested["reversal"].any()
    assert rested["breakaway"].any()


def test_the_ends_of_the_stroke_are_near_within_two_per_cent_of_it() -> None:
    masks = regimes(moved(phase((0.1, 1.0)), start=0.9))
    ((begin, _),) = spans(masks["near_end_stop"])
    assert begin == pytest.approx((0.96 - 0.9) / 0.1, abs=0.005)  # stroke 2 m: 40 mm before 1 m


@pytest.mark.parametrize(
    ("voltage", "named"),
    [
        (2.0, {"filling_a", "exhausting_b"}),
        (-2.0, {"filling_b", "exhausting_a"}),
        (0.0, {"valve_near_null"}),
        (0.85, {"valve_near_null", "filling_a", "exhausting_b"}),
    ],
)
def test_the_valve_decides_what_fills_and_what_empties(voltage: float, named: set[str]) -> None:
    masks = regimes(moved(phase((0.05, 0.5)), voltage=voltage))
    flowing = {name for name in masks if name.startswith(("filling", "exhausting", "valve"))}
    assert {name for name in flowing if masks[name].all()} == named
    assert not any(masks[name].any() for name in flowing - named)


def test_the_dead_zone_of_the_model_decides_what_is_near_null() -> None:
    motion = moved(phase((0.05, 0.5)), voltage=0.85)
    narrow = load_model().with_parameters({"dead_zone.right_limit": 0.5})
    assert regimes(motion)["valve_near_null"].all()
    assert not regimes(along(narrow, motion.run))["valve_near_null"].any()


def test_an_axis_without_chambers_has_no_regimes_of_valve_or_chambers() -> None:
    model = load_model()
    sections = {n: v for n, v in model.parameters.items() if n.partition(".")[0] in ("piston", "air", "lugre_friction")}
    driven = type(model).build(["lugre_friction"], sections, frame=("piston", "air"))
    n = 600
    run = Run(
        "driven", DT, 0.1 * DT * np.arange(n), None, None, np.zeros((n - 1) * PARTS), np.ones(n, dtype=bool), True
    )
    assert regimes(along(driven, run)).keys() == {"stick", "breakaway", "slide", "reversal", "near_end_stop"}


def test_every_regime_has_its_meaning() -> None:
    assert regimes(moved(phase((0.1, 0.3)))).keys() == MEANING.keys()
