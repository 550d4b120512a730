"""Every effect in a kernel of its own, as a machine has it: compiled, equal to plain Python, dissipative, switched.

A hundred kernels take minutes to compile; `test_effects_one_kernel.py` tests the same on one kernel of all effects.
"""

import numpy as np
import pytest
from plant import checks
from plant.catalogue import (
    AXIS,
    CATALOGUE,
    EFFECTS,
    in_python,
    lone_machine,
    machine,
    moves_piston,
    needs,
    neutral_values,
    seeded,
)

from pneumo_ros.plant import Model, Stepper

pytestmark = pytest.mark.check
every_effect = pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE])
VOLTAGE = np.repeat(np.random.default_rng(4).uniform(-10.0, 10.0, 12), 5)


def run(model: Model) -> np.ndarray:
    """A short run against an end stop, another of high speed, each through reversals."""
    start = model.state(y=0.98, v=0.5, p_a=6e5, p_b=1.1e5)
    return np.concatenate([model.simulate(VOLTAGE, start), model.simulate(VOLTAGE, model.state(v=-2.0))])


def observed(model: Model) -> dict[str, np.ndarray]:
    """Every state and signal of such a run that the axis has, too."""
    signals = model.outputs(run(model), np.tile(VOLTAGE, 2))
    return {name: signals[name] for name in (*AXIS.composition.observed, *AXIS.states) if name in signals}


@every_effect
def test_compiled_equals_python_to_the_bit(name: str) -> None:
    compiled = run(machine(name))
    assert np.isfinite(compiled).all()
    assert compiled.tobytes() == run(in_python(machine(name))).tobytes()


@pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE if neutral_values(effect)])
def test_neutral_parameters_change_nothing(name: str) -> None:
    """At its neutral values an effect has no influence on any state or signal, exactly or to rounding."""
    present = machine(name).with_parameters(neutral_values(EFFECTS[name]))
    absent = machine(name).with_effects([effect for effect in machine(name).effects if effect != name])
    if name not in AXIS.effects:
        assert set(absent.effects) == {*AXIS.effects, *needs(EFFECTS[name])}
    felt, usual = observed(present), observed(absent)
    for signal in usual:
        assert felt[signal] == pytest.approx(usual[signal], rel=1e-9, abs=1e-9 * np.abs(usual[signal]).max()), signal


@every_effect
def test_any_parameters_keep_every_step_stable(name: str) -> None:
    random = seeded(name)
    for values in [{}, *(checks.own_values(EFFECTS[name], random) for _ in range(10))]:
        extreme = values and name in AXIS.effects  # a bristle a million times stiffer than its friction needs 1e-4
        for step in (1e-4,) if extreme else (1e-4, 5e-4):
            assert checks.bounded(machine(name).with_parameters(values), step, VOLTAGE), (step, values)


@every_effect
def test_switched_on_and_off_under_way(name: str) -> None:
    """As a node does it: states keep their values, the axis continues."""
    stepper = Stepper(AXIS, AXIS.state(p_a=3e5, p_b=4e5))
    for model in (AXIS, machine(name), AXIS):
        before = dict(zip(stepper.model.states, stepper.state, strict=True))
        stepper.replace(model)
        after = dict(zip(model.states, stepper.state, strict=True))
        assert all(after[key] == before[key] for key in set(before) & set(after))
        for _ in range(50):
            assert np.isfinite(stepper.advance(3.0)).all()
    assert stepper.time == pytest.approx(0.15)


@pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE if moves_piston(effect)])
def test_friction_and_loads_give_no_energy(name: str) -> None:
    checks.check_dissipation(lone_machine(name), EFFECTS[name])
