"""The friction map against known friction."""

import numpy as np
import pytest
from identify.making import own, rig

from pneumo_ros.compare.along import along
from pneumo_ros.compare.sliding import friction_map
from pneumo_ros.plant import load_model


def test_the_true_machine_lies_on_its_own_map() -> None:
    model, _, run = rig("train_sweep")
    found = friction_map(model, [along(model, run)])
    assert found.keys() == {"extending", "retracting"}
    for points in found.values():
        assert len(points.velocity) >= 5
        assert np.abs(points.force - points.model).max() < 0.15  # of 70 to 200 N
        inside = (points.low <= points.model) & (points.model <= points.high)
        assert np.mean(inside[np.isfinite(points.low)]) >= 0.8


def test_missing_friction_shows_as_it_is_although_the_model_does_not_have_it() -> None:
    """The map follows from Newton's law: the model's own friction cancels."""
    model, _, run = rig("train_sweep", effect="viscous_friction", size=180.0)
    for points in friction_map(model, [along(model, run)]).values():
        slope = np.polyfit(points.velocity, points.force - points.model, 1)[0]
        assert slope == pytest.approx(180.0, rel=0.05)


def test_the_map_does_not_depend_on_the_friction_of_the_model() -> None:
    model, _, run = own("sweep", seconds=10.0)
    wrong = load_model().with_parameters(
        {"lugre_friction.coulomb_friction": 50.0, "quadratic_drag.coefficient": 3000.0}
    )
    true, other = (friction_map(m, [along(m, run)])["extending"] for m in (model, wrong))
    assert other.force == pytest.approx(true.force, abs=0.1)
    assert np.all(other.model < true.model - 10.0)


def test_a_piston_that_rests_has_no_map() -> None:
    model, _, run = own("steps", seconds=2.0)
    still = type(run)("still", run.sample_time, np.full(len(run), 0.1), run.pressure_a, run.pressure_b, run.input,
                      run.measured, False)  # fmt: skip
    assert friction_map(model, [along(model, still)]) == {}
