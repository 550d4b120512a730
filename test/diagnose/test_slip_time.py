"""The duration of a slip: against the plant, and against a limiting case."""

from dataclasses import replace

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.diagnose.slip_time import UNSURE, slip_times
from pneumo_ros.equations.breakaway import find_breakaways, force_spread, holding_force

STATIC = 100.0  # N, of the paper's machine


@pytest.mark.parametrize("volts", [0.83, -1.0, 3.0, 7.0])
def test_it_is_what_the_plant_takes(volts: float) -> None:
    """Integrated at 10 kHz, from the bristle's highest load: the force is then the static friction."""
    run, model = constant_run(volts, noisy=False), truth()
    (found,) = find_breakaways(model, run)
    (seconds,) = slip_times(model, [found])
    force = found.direction * holding_force(model, run)[found.index - round(seconds / run.sample_time)]
    assert abs(force - STATIC) < 2.0 * force_spread(found.ramp, UNSURE * seconds)
    assert force_spread(found.ramp, UNSURE * seconds) < 0.3 * found.spread


def test_without_a_stribeck_curve_the_force_alone_accelerates_it() -> None:
    """s = ramp t^3 / (6 M), where friction hardly grows over the first centimetres a second."""
    model = truth().with_parameters({"lugre_friction.coulomb_friction": STATIC, "quadratic_drag.coefficient": 0.0})
    (found,) = find_breakaways(truth(), constant_run(3.0))
    way = found.slip - STATIC / model["lugre_friction.bristle_stiffness"]
    expected = np.cbrt(6.0 * model["piston.mass"] * way / found.ramp)
    assert slip_times(model, [found])[0] == pytest.approx(expected, rel=0.02)


def test_heavy_pistons_take_longer_but_never_longer_than_a_rest() -> None:
    (found,) = find_breakaways(truth(), constant_run(1.0))
    light, heavy, fixed = (
        slip_times(truth().with_parameters({"piston.mass": m}), [found])[0] for m in (2.0, 20.0, 1e4)
    )
    assert 1.5 * light < heavy < fixed == pytest.approx(0.15, abs=1e-3)


def test_the_direction_of_the_rise_does_not_matter() -> None:
    (found,) = find_breakaways(truth(), constant_run(1.0))
    assert slip_times(truth(), [replace(found, ramp=-found.ramp)]) == slip_times(truth(), [found])


def test_a_payload_weighs_as_much_as_the_piston() -> None:
    (found,) = find_breakaways(truth(), constant_run(1.0))
    loaded = truth().with_effects([*truth().effects, "payload_mass"], {"payload_mass.mass_added": 3.0})
    heavy = truth().with_parameters({"piston.mass": truth()["piston.mass"] + 3.0})
    assert slip_times(loaded, [found]) == pytest.approx(slip_times(heavy, [found]))
