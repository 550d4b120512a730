"""Starts of fits to breakaways: sizes of one kind at a time, and tangents that show which effect is missing."""

from functools import lru_cache

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.diagnose.coordinates import Coordinate, by_kind, coordinates
from pneumo_ros.diagnose.mechanics import driven_by_pressures, event_rows
from pneumo_ros.diagnose.slip_starts import Tangents, by_sizes
from pneumo_ros.diagnose.slips import Slips, friction_priors
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical

HIDDEN = {"stribeck_shape.exponent": 1.8}
VOLTAGES = (0.83, -0.83, 1.0, -1.0, 2.0, -2.0)
RIVALS = ("friction_lag", "payload_mass", "backlash")


def alone() -> Model:
    found = mechanical(truth())
    assert found is not None
    return found


def kinds_of(name: str) -> list[tuple[Coordinate, ...]]:
    return by_kind(coordinates(truth().library.find(name)))


@lru_cache(maxsize=1)
def slips() -> Slips:
    """Of a model that lacks the exponent of the machine that is recorded."""
    machine = truth().with_effects([*truth().effects, "stribeck_shape"], HIDDEN)
    runs = tuple(driven_by_pressures(truth(), constant_run(v, 3.0, model=machine)) for v in VOLTAGES)
    rows = event_rows(runs)
    return Slips(runs, runs, rows, rows)


@pytest.mark.check
def test_along_its_tangent_what_is_missing_promises_most() -> None:
    tangents = Tangents.of(alone(), slips(), {name: 1e-3 * alone()[name] for name in friction_priors(alone(), {})})
    (exponent,), _ = kinds_of("stribeck_shape")
    loss, model = tangents.best("stribeck_shape", (exponent,))
    assert model["stribeck_shape.exponent"] < 2.0
    assert model["stribeck_shape.rational"] == 0.0
    assert model["stribeck_shape.exponent"] == pytest.approx(HIDDEN["stribeck_shape.exponent"], abs=0.05)
    assert all(loss < tangents.best(name, own)[0] for name in RIVALS for own in kinds_of(name))


def test_sizes_of_different_kinds_are_tried_one_at_a_time() -> None:
    """A longer tail replaces a smaller exponent: a fit of both finds neither."""
    exponent, rational = (by_sizes(alone(), slips(), "stribeck_shape", own)[1] for own in kinds_of("stribeck_shape"))
    assert exponent["stribeck_shape.exponent"] != 2.0
    assert exponent["stribeck_shape.rational"] == 0.0
    assert rational["stribeck_shape.exponent"] == 2.0
    assert rational["stribeck_shape.rational"] != 0.0


def test_shapes_are_tried_around_the_best_size() -> None:
    _, model = by_sizes(alone(), slips(), "dwell_time_breakaway", *kinds_of("dwell_time_breakaway"))
    assert any(model["dwell_time_breakaway.rise"] == pytest.approx(size) for size in (6.0, 20.0, 50.0))
    shaped = [model[f"dwell_time_breakaway.{key}"] for key in ("time_constant", "distance")]
    usual = [model.specification(f"dwell_time_breakaway.{key}").default for key in ("time_constant", "distance")]
    factors = np.array(shaped) / usual
    assert np.sum(factors != 1.0) <= 1
    assert set(factors.round(9).tolist()) <= {0.25, 0.5, 1.0, 2.0, 4.0}
