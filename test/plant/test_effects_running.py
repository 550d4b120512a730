"""What every effect must do in a running kernel: compose, compile, equal plain Python, be switched on and off."""

import subprocess

import numpy as np
import pytest
from plant.catalogue import AXIS, CATALOGUE, in_python, machine, seeded

from pneumo_ros.plant import Model, Stepper

every_listed_effect = pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE])


@pytest.fixture(scope="module", autouse=True)
def _compiled(compiling: "subprocess.Popen[bytes]") -> None:
    assert compiling.wait(300) == 0


def run(model: Model, name: str) -> np.ndarray:
    """A short run through starts, reversals, high speed and an end stop."""
    random = seeded(name)
    start = model.state(y=0.98, v=0.5, p_a=6e5, p_b=1.1e5)
    voltage = np.repeat(random.uniform(-10.0, 10.0, 12), 5)
    return np.concatenate([model.simulate(voltage, start), model.simulate(voltage, model.state(v=-2.0))])


@every_listed_effect
def test_compiled_equals_python_to_the_bit(name: str) -> None:
    compiled = run(machine(name), name)
    assert np.isfinite(compiled).all()
    assert compiled.tobytes() == run(in_python(machine(name)), name).tobytes()


@every_listed_effect
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
