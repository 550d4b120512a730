"""The static map: parameters from points, and a sentence where points do not determine them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from identify.constant import truth, wrong

from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.errors import DataError
from pneumo_ros.identify.campaign import FRICTION
from pneumo_ros.identify.friction_map import fit_map
from pneumo_ros.identify.static_map import MapFit, MapPoint, sliding_friction
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical

STATIC, COULOMB, STRIBECK, DRAG = FRICTION[:4]
SPEEDS = (0.004, 0.008, 0.012, 0.018, 0.03, 0.06, 0.1, 0.18)
SPREAD = 0.1  # N


def points(
    speeds: Sequence[float] = SPEEDS, model: Model | None = None, each: int = 10, seed: int = 0
) -> list[MapPoint]:
    """Points of a model's curve in both directions, with noise; each speed is a run."""
    rng = np.random.default_rng(seed)
    velocity = np.repeat([*speeds, *(-v for v in speeds)], each) * rng.uniform(0.98, 1.02, 2 * each * len(speeds))
    force = sliding_friction(model or truth(), velocity) + SPREAD * rng.standard_normal(len(velocity))
    runs = [f"run {k // each}" for k in range(len(velocity))]
    return [
        MapPoint(v, f, 1e-7, SPREAD, run) for v, f, run in zip(velocity.tolist(), force.tolist(), runs, strict=True)
    ]


def breakaway(force: float, direction: int = 1, ramp: float = 30.0) -> Breakaway:
    return Breakaway("run 0", 1000, 1.0, direction, force, ramp, 1.0, 4e-4)


def check(fit: MapFit, names: Sequence[str], within: float, model: Model | None = None) -> None:
    for name in names:
        true = (model or truth())[name]
        assert fit.values[name] == pytest.approx(true, rel=within), name
        low, high = fit.intervals[name]
        assert low - 0.5 * (high - low) < true < high + 0.5 * (high - low), name  # within two half widths
        assert high - low < 4.0 * within * true, name


def test_sliding_friction_is_the_published_curve() -> None:
    v = np.array([-0.15, -0.01, -1e-4, 1e-4, 0.004, 0.02, 0.2])
    g = 70.0 + 30.0 * np.exp(-((v / 0.01) ** 2))
    np.testing.assert_allclose(sliding_friction(truth(), v), np.sign(v) * (g + 4546.7 * v**2), rtol=1e-9)


def test_sliding_friction_without_a_stribeck_rise() -> None:
    flat = truth().with_parameters({STATIC: 0.0})
    at = np.array([0.05, -0.05])
    np.testing.assert_allclose(sliding_friction(flat, at), [81.37, -81.37], rtol=1e-3)


def test_all_four_parameters_from_slow_and_fast_points() -> None:
    fit = fit_map(wrong(), points(), [], FRICTION[:4])
    assert not fit.undetermined
    check(fit, FRICTION[:4], 0.02)
    assert fit.ratio == pytest.approx(1.0, abs=0.1)
    assert np.sqrt(np.mean(fit.residuals**2)) == pytest.approx(SPREAD, rel=0.1)


def test_a_far_start_finds_the_same() -> None:
    far = truth().with_parameters({STATIC: 30.0, COULOMB: 150.0, STRIBECK: 0.05, DRAG: 500.0})
    check(fit_map(far, points(), [], FRICTION[:4]), FRICTION[:4], 0.02)


def test_static_friction_is_not_below_coulomb_friction() -> None:
    """Breakaways at 40 N, as on a rig that vibrates, where sliding takes 70 N."""
    easy = points(model=truth().with_parameters({STATIC: 70.0}), speeds=SPEEDS[3:])
    fit = fit_map(wrong(), easy, [breakaway(40.0, way) for way in (1, -1, 1, -1)], (STATIC, COULOMB, DRAG))
    assert fit.values[STATIC] >= fit.values[COULOMB]
    assert fit.values[COULOMB] == pytest.approx(70.0, abs=1.0)


def test_an_outlying_run_costs_little() -> None:
    """Somebody leaned on the axis in one run of sixteen: least squares would be off by a newton."""
    spoilt = [replace(p, force=p.force + 15.0) if p.run == "run 6" else p for p in points()]
    fit = fit_map(wrong(), spoilt, [], FRICTION[:4])
    assert fit.values[COULOMB] == pytest.approx(truth()[COULOMB], abs=0.2)
    assert fit.values[DRAG] == pytest.approx(truth()[DRAG], rel=0.01)


def test_one_direction_is_enough() -> None:
    fit = fit_map(wrong(), [p for p in points() if p.velocity < 0.0], [], FRICTION[:4])
    check(fit, FRICTION[:4], 0.03)


def test_without_slow_points_the_stribeck_velocity_stays() -> None:
    fit = fit_map(wrong(), points((0.06, 0.1, 0.18)), [breakaway(100.1), breakaway(99.8, -1)], FRICTION[:4])
    assert set(fit.undetermined) == {STRIBECK}
    assert fit.undetermined[STRIBECK].startswith("needs steady points below 39 mm/s")
    assert "the slowest is at 59 mm/s" in fit.undetermined[STRIBECK]
    assert fit.values[STRIBECK] == wrong()[STRIBECK]
    assert STRIBECK not in fit.intervals
    check(fit, (COULOMB, DRAG), 0.01)
    assert fit.values[STATIC] == pytest.approx(100.0, abs=0.5)


def test_without_slow_points_and_breakaways_static_friction_stays_too() -> None:
    fit = fit_map(wrong(), points((0.06, 0.1, 0.18)), [], FRICTION[:4])
    assert set(fit.undetermined) == {STRIBECK, STATIC}
    assert fit.undetermined[STATIC].endswith("and no breakaway from rest was recorded")


def test_at_one_speed_friction_is_not_split_up() -> None:
    """Only the sum of Coulomb friction and drag is seen: neither is determined, and neither moves."""
    fit = fit_map(wrong(), points((0.1,)), [breakaway(100.0)], FRICTION[:4])
    assert {COULOMB, DRAG} <= set(fit.undetermined)
    assert "needs speeds over a factor of 1.5; the speeds here span 98 to 102 mm/s" in fit.undetermined[DRAG]
    assert "these runs leave it anywhere between" in fit.undetermined[COULOMB]
    assert fit.values[COULOMB] == wrong()[COULOMB]
    assert fit.values[DRAG] == wrong()[DRAG]


def test_what_is_asked_for_but_not_shown_widens_the_rest() -> None:
    """With known drag, one speed gives Coulomb friction; with both unknown, it gives neither."""
    alone = fit_map(truth(), points((0.1,)), [], (COULOMB,))
    check(alone, (COULOMB,), 0.01)
    assert COULOMB in fit_map(truth(), points((0.1,)), [], (COULOMB, DRAG)).undetermined


def test_viscous_friction_beside_drag() -> None:
    name = "viscous_friction.coefficient"
    sticky = truth().with_effects([*truth().effects, "viscous_friction"], {name: 100.0})
    start = wrong().with_effects([*truth().effects, "viscous_friction"])
    fit = fit_map(start, points(model=sticky), [], (*FRICTION[:4], name))
    check(fit, (STATIC, COULOMB, STRIBECK, DRAG, name), 0.05, sticky)
    place = fit.names.index
    assert fit.correlation[place(DRAG), place(name)] < -0.9
    assert fit_map(wrong(), points(model=sticky), [], FRICTION[:4]).ratio > 3.0


def test_no_viscous_friction_is_an_answer_too() -> None:
    name = "viscous_friction.coefficient"
    start = wrong().with_effects([*truth().effects, "viscous_friction"])
    fit = fit_map(start, points(), [], (*FRICTION[:4], name))
    low, high = fit.intervals[name]
    assert low < 0.0 < high or fit.values[name] < 3.0
    assert high < 10.0


def test_a_value_on_its_bound_has_an_interval() -> None:
    """Forces that would need negative viscous friction: it is zero, and the others are as without it."""
    name = "viscous_friction.coefficient"
    start = truth().with_effects([*truth().effects, "viscous_friction"], {name: 0.0})
    less = [replace(p, force=p.force - 6.0 * p.velocity) for p in points(each=60)]
    fit = fit_map(start, less, [], (*FRICTION[:4], name))
    assert fit.values[name] == 0.0 == fit.intervals[name][0]
    assert 0.0 < fit.intervals[name][1] < 6.0
    assert fit.values[COULOMB] == pytest.approx(69.8, abs=0.4)


def test_a_held_value_on_its_bound_does_no_harm() -> None:
    name = "viscous_friction.coefficient"
    start = truth().with_effects([*truth().effects, "viscous_friction"], {name: 0.0})
    fit = fit_map(start, points((0.1,)), [breakaway(100.0)], (*FRICTION[:4], name))
    assert name in fit.undetermined
    assert fit.values[name] == 0.0


def test_too_few_points_are_refused() -> None:
    too_few = "4 steady stretches are too few for 4 friction parameters; record more"
    with pytest.raises(DataError, match=f"{too_few} constant-voltage runs"):
        fit_map(wrong(), points((0.005, 0.03), each=1), [], FRICTION[:4])
    moved = mechanical(wrong(), by_force=True)
    assert moved is not None
    with pytest.raises(DataError, match=f"{too_few} runs at constant velocity, or fit .*--refit"):
        fit_map(moved, points((0.005, 0.03), each=1), [], FRICTION[:4])


def test_the_same_points_give_the_same_numbers() -> None:
    first, second = (fit_map(wrong(), points(), [breakaway(100.0)], FRICTION[:4]) for _ in range(2))
    assert first.values == second.values
    assert first.intervals == second.intervals
