"""Every effect in a running kernel: composed, compiled, equal to plain Python, dissipative, switched on and off.

Last effect first: meanwhile another process compiles from the first one on.
"""

import numpy as np
import pytest
from plant import checks
from plant.catalogue import AXIS, CATALOGUE, EFFECTS, in_python, lone_machine, machine, moves_piston, seeded

from pneumo_ros.plant import Model, Stepper

pytestmark = pytest.mark.usefixtures("compiling")
every_effect = pytest.mark.parametrize("name", [effect.name for effect in reversed(CATALOGUE)])
VOLTAGE = np.repeat(np.random.default_rng(4).uniform(-10.0, 10.0, 12), 5)


def run(model: Model) -> np.ndarray:
    """A short run against an end stop, another of high speed, each through reversals."""
    start = model.state(y=0.98, v=0.5, p_a=6e5, p_b=1.1e5)
    return np.concatenate([model.simulate(VOLTAGE, start), model.simulate(VOLTAGE, model.state(v=-2.0))])


@every_effect
def test_compiled_equals_python_to_the_bit(name: str) -> None:
    compiled = run(machine(name))
    assert np.isfinite(compiled).all()
    assert compiled.tobytes() == run(in_python(machine(name))).tobytes()


@every_effect
def test_neutral_parameters_change_nothing(name: str) -> None:
    """At its neutral values an effect is there and not felt; a lag that ends at the shortest may leave a trace."""
    neutral = {key: p.neutral for key, p in EFFECTS[name].parameters.items() if p.neutral is not None}
    if neutral:
        model = machine(name).with_parameters({f"{name}.{key}": value for key, value in neutral.items()})
        felt = np.abs(run(model)[:, : len(AXIS.states)] - run(AXIS)).max(axis=0)
        assert np.all(felt <= [1e-4, 5e-3, 6e3, 6e3, 2e-6]), neutral


def bounded(model: Model, step: float) -> bool:
    """Whether a long step finds nothing that a short one does not; what both find extreme may be extreme."""
    start = model.state(p_a=3e5, p_b=4e5)
    coarse, fine = (np.abs(model.simulate(VOLTAGE, start, step=h)).max(axis=0) for h in (step, 2e-6))
    return bool(np.all(coarse <= 3.0 * fine + 1e-6))


@every_effect
def test_any_parameters_keep_the_default_step_stable(name: str) -> None:
    random = seeded(name)
    for _ in range(10):
        values = checks.own_values(EFFECTS[name], random)
        assert bounded(machine(name).with_parameters(values), step=1e-4), values


@every_effect
def test_the_longest_step_is_stable(name: str) -> None:
    assert bounded(machine(name), step=5e-4)


@every_effect
def test_switched_on_and_off_under_way(name: str) -> None:
    """As a node does it: states keep their values, the axis goes on."""
    stepper = Stepper(AXIS, AXIS.state(p_a=3e5, p_b=4e5))
    for model in (AXIS, machine(name), AXIS):
        before = dict(zip(stepper.model.states, stepper.state, strict=True))
        stepper.replace(model)
        after = dict(zip(model.states, stepper.state, strict=True))
        assert all(after[key] == before[key] for key in set(before) & set(after))
        for _ in range(50):
            assert np.isfinite(stepper.advance(3.0)).all()
    assert stepper.time == pytest.approx(0.15)


@pytest.mark.parametrize("name", [effect.name for effect in reversed(CATALOGUE) if moves_piston(effect)])
def test_friction_and_loads_give_no_energy(name: str) -> None:
    checks.check_dissipation(lone_machine(name), EFFECTS[name])
