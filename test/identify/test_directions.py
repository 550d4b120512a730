"""The map for machines that differ between directions, or have an effect that the model lacks."""

from dataclasses import replace
from functools import lru_cache

import pytest
from identify.constant import constant_runs, wrong
from identify.making import rig

from pneumo_ros.identify.campaign import FRICTION, Identification, identify
from pneumo_ros.identify.directions import by_direction
from pneumo_ros.identify.friction_map import fit_map
from pneumo_ros.identify.static_map import MapPoint, map_points
from pneumo_ros.identify.steady import find_windows
from pneumo_ros.plant import load_model

STATIC, COULOMB, STRIBECK, DRAG = FRICTION[:4]


@lru_cache(maxsize=1)
def campaign() -> Identification:
    """A few runs of a machine with the same friction in both directions."""
    return identify(wrong(), constant_runs(0.83, -0.83, 7.0, -7.0))


def steady_points(effect: str, size: float) -> list[MapPoint]:
    """Points of the independent rig with a hidden effect."""
    runs = [rig(f"constant_{name}", 3, effect, size) for name in ("p0880", "m0880", "p1500", "m7000")]
    return [point for model, _, run in runs for point in map_points(find_windows(model, run))]


def test_a_hidden_effect_shows_in_the_map() -> None:
    """Viscous friction: the base model leaves residuals, with the effect only noise is left."""
    base, points, name = load_model(), steady_points("viscous_friction", 180.0), "viscous_friction.coefficient"
    with_it = base.with_effects([*base.effects, "viscous_friction"])
    plain = fit_map(base, points, [], (COULOMB, DRAG))
    full = fit_map(with_it, points, [], (COULOMB, DRAG, name))
    assert plain.ratio > 3.0
    assert full.ratio == pytest.approx(1.0, abs=0.2)
    assert full.values[name] == pytest.approx(180.0, rel=0.05)


def test_directions_of_a_symmetric_machine_do_not_differ() -> None:
    sides = by_direction(campaign(), FRICTION[:4])
    assert {COULOMB, DRAG, STATIC} <= set(sides["compared"])
    assert sides["differ"] == []
    for side in (sides["extending"], sides["retracting"]):
        assert side["parameters"][COULOMB]["value"] == pytest.approx(70.0, rel=0.01)


def test_directions_of_an_asymmetric_rig_differ() -> None:
    found = replace(campaign(), points=tuple(steady_points("asymmetric_friction", 0.2)), breakaways=())
    sides = by_direction(found, (COULOMB,))
    assert sides["differ"] == [COULOMB]
    back, forth = (sides[side]["parameters"][COULOMB]["value"] for side in ("retracting", "extending"))
    assert back - forth == pytest.approx(0.2 * 70.0, rel=0.1)


def test_breakaways_count_for_their_own_direction() -> None:
    """Those of one direction are left out: the other one has as many as before."""
    right = tuple(one for one in campaign().breakaways if one.direction == 1)
    assert 0 < len(right) < len(campaign().breakaways)
    sides = by_direction(replace(campaign(), breakaways=right), (COULOMB,))
    assert [sides[name]["breakaways"] for name in ("extending", "retracting")] == [len(right), 0]


def test_a_direction_without_runs_has_its_sentence() -> None:
    sides = by_direction(identify(wrong(), constant_runs(0.83, 1.0, 7.0)), FRICTION[:4])
    assert "0 steady stretches are too few" in sides["retracting"]["problem"]
    assert sides["compared"] == []
