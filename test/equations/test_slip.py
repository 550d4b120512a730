"""The force at which a piston has slipped: against LuGre's equations, a limiting case, and recordings of the plant."""

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.equations.slip import SPEEDS, force_at_slip
from pneumo_ros.plant.effects.friction.lugre_friction import LugreFriction

STATIC, COULOMB, STRIBECK, MASS, WAY = 100.0, 70.0, 0.01, 5.0, 4e-4
BRISTLES = 1.4e6, 50.0, 0.9


def slipped(ramp: float, exponent: float) -> float:
    """The same force by explicit steps of 2 us from straight bristles at a force that they hold without sliding."""
    force, v, step = 0.9 * STATIC, ramp / BRISTLES[0], 2e-6
    z = y = force / BRISTLES[0]
    for _ in range(round(0.9 * STATIC / (ramp * step))):
        if y >= WAY:
            return force
        stribeck = float(np.exp(-((abs(v) / STRIBECK) ** exponent)))
        friction, _, der_z, _ = LugreFriction.equations(v, z, stribeck, 1.0, 0.0, 1.0, 0.0, STATIC, COULOMB, *BRISTLES)
        v += step * (force - friction) / MASS
        z, y, force = z + step * der_z, y + step * v, force + step * ramp
    raise AssertionError("it never slips")


@pytest.mark.parametrize("exponent", [0.8, 2.0])
@pytest.mark.parametrize("ramp", [100.0, 900.0])
def test_it_is_that_of_lugre_friction(ramp: float, exponent: float) -> None:
    level = COULOMB + (STATIC - COULOMB) * np.exp(-((SPEEDS / STRIBECK) ** exponent))
    force = force_at_slip(np.array([ramp]), np.array([WAY]), np.array([MASS]), *BRISTLES, level[None])
    assert force[0] == pytest.approx(slipped(ramp, exponent), abs=0.005 * STATIC)


def test_without_a_stribeck_curve_the_mass_takes_its_time() -> None:
    """s = ramp t^3 / (6 M) beyond the bristle's deflection, of a bristle that does not slide before."""
    ramp, mass = np.array([50.0, 500.0]), np.array([5.0, 20.0])
    force = force_at_slip(ramp, np.full(2, WAY), mass, 1e8, 0.0, 0.999, np.full((2, len(SPEEDS)), STATIC))
    assert force - STATIC == pytest.approx(ramp * np.cbrt(6.0 * mass * WAY / ramp), rel=0.05)


@pytest.mark.parametrize(("exponent", "sample_time"), [(0.8, 1e-3), (2.0, 1e-3), (0.8, 4e-3)])
def test_breakaways_of_the_true_machine_leave_noise(exponent: float, sample_time: float) -> None:
    """With an exponent of 0.8 they lie 4 N below static friction."""
    shape = {"stribeck_shape.exponent": exponent, "stribeck_shape.rational": 0.0}
    model = truth().with_effects([*truth().effects, "stribeck_shape"], shape)
    runs = [constant_run(volts, 3.0, sample_time, model=model) for volts in (0.83, -1.0, 2.0, -3.0)]
    evidence = Evidence(model, runs)
    residual = evidence.residual(model)[evidence.family == evidence.names.index("breakaway")]
    assert len(residual) >= 4
    assert np.abs(residual).max() < 2.0
    assert abs(residual.mean()) < 1.0
