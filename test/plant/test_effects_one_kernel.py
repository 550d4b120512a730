"""Every effect at work, in one kernel that holds all effects: the others are at their neutral values."""

import numpy as np
import pytest
from plant import checks
from plant.catalogue import (
    AXIS,
    CATALOGUE,
    EFFECTS,
    driven_in_one_kernel,
    everything,
    in_one_kernel,
    in_python,
    machine,
    moves_piston,
    neutral_values,
    seeded,
)

from pneumo_ros.plant import Model, Stepper

every_effect = pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE])
VOLTAGE = np.repeat(np.random.default_rng(4).uniform(-10.0, 10.0, 12), 5)


def run(model: Model, voltage: np.ndarray = VOLTAGE) -> np.ndarray:
    """A short run against an end stop, another of high speed, each through reversals."""
    start = model.state(y=0.98, v=0.5, p_a=6e5, p_b=1.1e5)
    return np.concatenate([model.simulate(voltage, start), model.simulate(voltage, model.state(v=-2.0))])


@every_effect
def test_compiled_equals_python_to_the_bit(name: str) -> None:
    model, random = in_one_kernel(name), seeded(name)
    for values in ({}, checks.own_values(EFFECTS[name], random)):
        given, voltage = model.with_parameters(values), VOLTAGE[3:7]
        assert run(given, voltage).tobytes() == run(in_python(given), voltage).tobytes()


@every_effect
def test_the_kernel_of_all_effects_is_that_of_the_machine(name: str) -> None:
    """Where an effect is listed behind others changes sums by rounding only."""
    small, large = in_python(machine(name)), in_one_kernel(name)
    one, other = run(small, VOLTAGE[3:7]), run(large, VOLTAGE[3:7])
    for state in small.states:
        ours, theirs = one[:, small.states.index(state)], other[:, large.states.index(state)]
        assert theirs == pytest.approx(ours, rel=1e-9, abs=1e-9 * max(np.abs(ours).max(), 1e-9)), state


def test_neutral_parameters_change_nothing() -> None:
    """At their neutral values effects have no influence on any state or signal."""
    neutral = {key: value for e in CATALOGUE if e.name not in AXIS.effects for key, value in neutral_values(e).items()}
    felt, usual = (
        model.outputs(run(model), np.tile(VOLTAGE, 2)) for model in (everything().with_parameters(neutral), AXIS)
    )
    for signal in (*AXIS.composition.observed, *AXIS.states):
        assert felt[signal] == pytest.approx(usual[signal], rel=1e-9, abs=1e-9 * np.abs(usual[signal]).max()), signal


@every_effect
def test_any_parameters_keep_every_step_stable(name: str) -> None:
    random = seeded(name)
    for values in [{}, *(checks.own_values(EFFECTS[name], random) for _ in range(3))]:
        extreme = values and name in AXIS.effects  # a bristle a million times stiffer than its friction needs 1e-4
        for step in (1e-4,) if extreme else (1e-4, 5e-4):
            assert checks.bounded(in_one_kernel(name).with_parameters(values), step, VOLTAGE), (step, values)


def test_switched_on_and_off_under_way() -> None:
    """As a node does it: states keep their values, the axis continues."""
    stepper = Stepper(AXIS, AXIS.state(p_a=3e5, p_b=4e5))
    for model in (AXIS, everything(), AXIS):
        before = dict(zip(stepper.model.states, stepper.state, strict=True))
        stepper.replace(model)
        after = dict(zip(model.states, stepper.state, strict=True))
        assert all(after[key] == before[key] for key in set(before) & set(after))
        for _ in range(50):
            assert np.isfinite(stepper.advance(3.0)).all()
    assert stepper.time == pytest.approx(0.15)


@pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE if moves_piston(effect)])
def test_friction_and_loads_give_no_energy(name: str) -> None:
    checks.check_dissipation(driven_in_one_kernel(name), EFFECTS[name])
