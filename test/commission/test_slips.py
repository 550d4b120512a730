"""Breakaways of a light piston that rings on soft bristles: below static friction, and not as sure as they look."""

from dataclasses import replace

import numpy as np
import pytest

from pneumo_ros.commission import moves
from pneumo_ros.commission.safe import safe
from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.commission.slips import ringing, surely_static
from pneumo_ros.commission.wiring import as_run
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.equations.breakaway import find_breakaways
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

WISHES = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
SOFT = {
    "lugre_friction.static_friction": 30.0, "lugre_friction.coulomb_friction": 9.4,
    "lugre_friction.stribeck_velocity": 0.006, "lugre_friction.bristle_stiffness": 3.25e5,
    "dead_zone.right_limit": 0.4, "dead_zone.left_limit": 0.22, "arctan_flow.voltage_gain": 0.02,
}  # fmt: skip


@pytest.fixture(scope="module")
def rings() -> tuple[Model, list[Run]]:
    """A machine whose piston rings, at 64 Hz and with a damping of 1 %, and its static trials."""
    truth = design(WISHES, load_shelf([])).model.with_parameters(SOFT)
    programme = safe(moves.static(truth), [truth])
    assert programme is not None
    done = SimulatedRig(truth).perform(programme, (), "static")
    return truth, [as_run(one, truth, ()) for one in done.recordings]


def offset(evidence: Evidence, model: Model) -> tuple[float, float, int]:
    """Weighted mean of the breakaways' residuals [N], its deviation, and how many count."""
    own = evidence.family == evidence.names.index("breakaway")
    noise = evidence.noise[own]
    weight = noise**-2.0
    residual = evidence.residual(model)[own] * noise
    return float(np.sum(weight * residual) / np.sum(weight)), float(np.sum(weight) ** -0.5), int(own.sum())


def test_breakaways_of_a_piston_that_rings_do_not_count(rings: tuple[Model, list[Run]]) -> None:
    truth, runs = rings
    every = Evidence(truth, runs)
    far, sure, count = offset(every, truth)
    assert far < -20.0 * sure
    kept = surely_static(every, truth)
    near, unsure, fewer = offset(kept, truth)
    assert 0 < fewer < count
    assert abs(near) < 2.0 * unsure
    assert unsure < 0.1 * truth["lugre_friction.static_friction"]
    others = every.family != every.names.index("breakaway")
    np.testing.assert_array_equal(kept.noise[kept.family != kept.names.index("breakaway")], every.noise[others])
    np.testing.assert_array_equal(offset(every, truth), (far, sure, count))


def test_ringing_dies_out_at_rest_and_grows_with_the_force(rings: tuple[Model, list[Run]]) -> None:
    truth, runs = rings
    one = next(one for run in runs for one in find_breakaways(truth, run))
    just, long = (ringing(truth, replace(one, rest=rest), 0.0) for rest in (0.15, 3.0))
    assert just > 0.5
    assert long < 1e-6
    slow, fast = (ringing(truth, replace(one, rest=3.0), ramp) for ramp in (100.0, 1700.0))
    assert slow < 0.01
    assert fast > 0.4
    stiff = truth.with_parameters({"lugre_friction.bristle_stiffness": 3.25e6})
    assert ringing(stiff, replace(one, rest=3.0), 1700.0) < 0.01
