"""Laws that differ from the catalogue's, and laws that do not, next to a second effect."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from pneumo_ros.diagnose.basefit import unaided
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.freedom import conditions, freed, relative
from pneumo_ros.diagnose.hypothesis import BaseFit
from pneumo_ros.plant import load_model

SIZE = 30.0  # N s/m
START = load_model("axis")
MODEL = START.with_effects([*START.effects, "viscous_friction"], {"viscous_friction.coefficient": SIZE})
N = 4000
RNG = np.random.default_rng(0)
SEEN = np.column_stack([RNG.uniform(-1.0, 1.0, N), RNG.uniform(0.05, 0.5, N), RNG.normal(size=N), np.zeros(N)])
POSITION, SPEED = SEEN[:, 0], SEEN[:, 1]
NOISE = 0.5  # N
PART = SimpleNamespace(
    run=SimpleNamespace(force_driven=True, sample_time=1.0),
    frame=SimpleNamespace(states=SEEN[:, [0, 1]]),
    held=SEEN[:, 2],
    families=[SimpleNamespace(run=0)],
)
EVIDENCE = cast(
    Evidence,
    SimpleNamespace(
        names=("momentum 100 ms",), family=np.zeros(N, dtype=np.int64), run=np.zeros(N, dtype=np.int64),
        time=np.arange(N, dtype=float), noise=np.full(N, NOISE), by_run=[PART], block=np.arange(N) // 20,
    ),
)  # fmt: skip
RELATIVE = relative(conditions(EVIDENCE), conditions(EVIDENCE))
LAW = SIZE * SPEED / NOISE  # what the catalogue's law adds to each residual, in deviations


def test_relative_conditions_have_no_mean() -> None:
    """Neither the deviations nor their squares: a law that bends keeps its mean. A constant condition is left out."""
    assert RELATIVE.shape == (N, 6)
    np.testing.assert_allclose(RELATIVE.mean(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(RELATIVE[:, :3].std(axis=0), 1.0)


def left(machine: np.ndarray, free: bool) -> float:
    """Root mean square of the model's residual for a machine with friction `machine`, with noise."""
    residual = RNG.normal(size=N) + machine - LAW
    slopes = -LAW[:, None]  # per usual size, which is the model's value
    fit = BaseFit(
        MODEL, MODEL, ("viscous_friction.coefficient",), np.array([SIZE]), np.zeros(1), EVIDENCE, residual, slopes
    )
    fit = freed(fit, ["viscous_friction"] if free else [], RELATIVE)
    return float(np.sqrt(np.mean(unaided(fit).residual ** 2)))


@pytest.mark.parametrize("power", [0.7, 1.4])
def test_another_power_of_the_same_effect_is_within_its_freedom(power: float) -> None:
    machine = LAW.mean() * (SPEED / SPEED.mean()) ** power
    assert left(machine, free=False) > 1.5
    assert left(machine, free=True) < 1.15


def test_an_effect_that_changes_along_the_stroke_is_within_its_freedom() -> None:
    machine = LAW * (1.0 + 0.2 * POSITION)
    assert left(machine, free=False) > 1.5
    assert left(machine, free=True) < 1.1


def test_another_effect_is_not_within_it() -> None:
    machine = LAW + 0.5 * LAW.mean() * np.sign(POSITION)  # changes where the first one does not
    alone = left(machine, free=False)
    assert left(machine, free=True) > 0.45 * alone
    assert left(machine, free=True) > 3.0


def test_a_model_without_additions_has_no_such_freedom() -> None:
    fit = BaseFit(MODEL, MODEL, (), np.empty(0), np.empty(0), EVIDENCE, np.zeros(N), np.empty((N, 0)))
    assert freed(fit, [], RELATIVE) is fit


def test_what_sensors_do_has_no_such_freedom() -> None:
    model = START.with_effects([*START.effects, "pressure_sensor_offset"])
    fit = BaseFit(model, model, (), np.empty(0), np.empty(0), EVIDENCE, np.zeros(N), np.empty((N, 0)))
    assert freed(fit, ["pressure_sensor_offset"], RELATIVE) is fit
