"""Starts of fits to breakaways: sizes of one kind at a time, and tangents that show which effect is missing."""

from functools import lru_cache

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.diagnose.coordinates import Coordinate, by_kind, coordinates
from pneumo_ros.diagnose.mechanics import driven_by_pressures, event_rows
from pneumo_ros.diagnose.slip_starts import Tangents, by_sizes
from pneumo_ros.diagnose.slips import DRAWS, Slips, errors, errors_of_each, friction_priors, textured
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical
from pneumo_ros.shooting.segments import Segments

HIDDEN = {"stribeck_shape.exponent": 1.8}
VOLTAGES = (0.83, -0.83, 1.0, -1.0, 2.0, -2.0)
STATIC = "lugre_friction.static_friction"
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


def test_events_by_several_models_in_one_batch_are_those_of_each() -> None:
    """To rounding, though each model guesses its own starts, and some starts are found sooner than others."""
    models = [alone().with_parameters({STATIC: share * alone()[STATIC]}) for share in (1.0, 1.02, 0.97)]
    found = errors_of_each(models, [slips().some(model) for model in models])
    for model, own in zip(models, found, strict=True):
        np.testing.assert_allclose(own, errors(model, slips().some(model)), rtol=1e-12)
    assert len({float(np.median(own)) for own in found}) == len(models)


def test_a_force_that_no_model_has_leaves_what_a_load_of_its_size_leaves() -> None:
    """Normally distributed forces of 1 N leave less than a load of 1 N in every event, but no order of magnitude."""
    loaded = truth().with_effects([*truth().effects, "constant_load"], {"constant_load.load": 1.0})
    runs = tuple(driven_by_pressures(truth(), constant_run(v, 3.0, model=loaded)) for v in VOLTAGES)
    rows = event_rows(runs)
    events = Slips(runs, runs, rows, rows).train(alone())
    left, large, small = (np.exp(np.mean(np.log(one))) for one in (errors(alone(), events), *drawn(events)))
    assert 0.1 * left < large < left
    assert small < 0.2 * large


def drawn(events: Segments) -> list[np.ndarray]:
    found = [textured(alone(), events, force) for force in (1.0, 0.1)]
    assert {one.shape for one in found} == {(DRAWS, len(events))}
    return found


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
