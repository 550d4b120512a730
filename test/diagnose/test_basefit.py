"""The current model fitted within the prior knowledge of its parameters, and within their ranges."""

import sys
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from pneumo_ros.diagnose.basefit import ROUNDS_EACH, Known, fit_base, slopes
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import PROBE_SHARE, USUAL
from pneumo_ros.diagnose.hypothesis import OVERLAP, log_likelihood
from pneumo_ros.plant import Model, load_model

NAMES = tuple(
    f"{effect}.{key}"
    for effect, key in (
        ("viscous_friction", "coefficient"),
        ("asymmetric_viscous_friction", "coefficient_extension"),
        ("asymmetric_viscous_friction", "coefficient_retraction"),
    )
)
CENTRE, PRIOR = np.array([203.5, 0.0, 0.0]), np.array([6.0, 900.0, 1800.0])
NO_LOAD: dict[str, Any] = {"load": lambda model: 1.0, "by_load": lambda load: np.ones(1)}


def test_a_size_at_the_end_of_its_range_does_not_hold_what_trades_with_it() -> None:
    """Viscous friction of 160 and 230 N s/m by direction, of which 203 are known: neither part falls below zero."""
    axis = load_model("axis")
    model = axis.with_effects(
        [*axis.effects, "viscous_friction", "asymmetric_viscous_friction"],
        dict(zip(NAMES, (203.5, 30.0, 60.0), strict=True)),
    )
    speed = np.random.default_rng(3).uniform(-0.2, 0.2, 400)
    slopes = 10.0 * np.stack([speed, np.maximum(speed, 0.0), np.minimum(speed, 0.0)], axis=1)  # noise of 0.1 N
    measured = slopes @ np.array([160.0, 0.0, 70.0])
    columns = [list(model.parameters).index(name) for name in NAMES]
    evidence: Any = SimpleNamespace(
        names=("momentum 100 ms",),
        family=np.zeros(400, dtype=int),
        **NO_LOAD,
        residuals=lambda model, values, ranking=False: measured - values[:, columns] @ slopes.T,
    )
    known = Known(NAMES, CENTRE, PRIOR, np.array([0.05, 0.15, 0.3]))
    found = fit_base(cast(Evidence, evidence), model, known).model
    rows = np.concatenate([OVERLAP * slopes, np.diag(1.0 / PRIOR)])
    best = lsq_linear(rows, np.concatenate([OVERLAP * measured, CENTRE / PRIOR]), (0.0, np.inf)).x
    assert np.allclose([found[name] for name in NAMES], best, atol=0.05)
    assert abs(found[NAMES[0]] - 160.0) < 1.0


COULOMB = "lugre_friction.coulomb_friction"
COLUMN = list(load_model("axis").parameters).index(COULOMB)


GAIN = "arctan_flow.voltage_gain"


def test_a_slope_is_that_at_the_value_also_where_it_is_small_beside_its_default() -> None:
    """The default gain is 2 1/V; a valve of 0 to 10 V has 0.01 1/V, and the flow bends over it."""
    axis = load_model("axis").with_parameters({GAIN: 0.01})
    column, volts = list(axis.parameters).index(GAIN), np.array([1.0, 100.0])
    evidence: Any = SimpleNamespace(
        names=("momentum 100 ms",),
        family=np.zeros(2, dtype=int),
        **NO_LOAD,
        residuals=lambda model, values, ranking=False: np.arctan(values[:, column, None] * volts),
    )
    known = Known((GAIN,), np.array([0.1]), np.array([1.0]), np.array([PROBE_SHARE * USUAL * 2.0]))
    true = volts / (1.0 + (0.01 * volts) ** 2)
    assert np.allclose(slopes(cast(Evidence, evidence), axis, known)[1][:, 0], true, rtol=0.01)


class Alternating:
    """Evidence of two residuals, each better than the other by its own scales: ten outliers, or all a little wrong.

    Each one is a step away from the other, as along a law with kinks finer than any step.
    """

    names, family = ("momentum 100 ms",), np.zeros(1000, dtype=int)
    load, by_load = (staticmethod(one) for one in NO_LOAD.values())

    def __init__(self) -> None:
        self.calls = 0
        self.two = (np.where(np.arange(1000) < 10, 30.0, 0.0), np.full(1000, 2.52))
        self.which = {70.0: 0}  # of the two, by value of the parameter
        self.here, self.begin = 0, 70.0  # where slopes were asked for last

    def residuals(self, model: Model, values: np.ndarray, ranking: bool = False) -> np.ndarray:
        """Residuals (variants, 1000): of a known value and a probe of its slope, or of one or two shares of a step."""
        self.calls += 1
        assert self.calls < 500, "the fit goes round for ever"
        at = values[:, COLUMN].tolist()
        if at[0] in self.which:
            self.here, self.begin = self.which[at[0]], at[0]
            return np.stack([self.two[self.here] * (1.0 - 0.05 * (value - self.begin)) for value in at])
        self.which |= dict.fromkeys(at, 1 - self.here)
        return np.stack([self.two[1 - self.here]] * len(at))


def test_a_fit_ends_where_two_models_are_each_better_by_their_own_scales() -> None:
    axis = load_model("axis")
    known = Known((COULOMB,), np.array([70.0]), np.array([2.0]), np.array([0.1]))
    evidence: Any = Alternating()
    fitted = fit_base(cast(Evidence, evidence), axis, known)
    assert fitted.settled
    assert 3 <= evidence.calls < 10
    likelihoods = [log_likelihood(evidence, residual) for residual in evidence.two]
    assert evidence.which[fitted.model[COULOMB]] == np.argmax(likelihoods)


class Falling(Alternating):
    """Evidence whose residual gets smaller with every call, and promises more by its slopes: the fit never settles."""

    def residuals(self, model: Model, values: np.ndarray, ranking: bool = False) -> np.ndarray:
        """Residuals (variants, 1000)."""
        self.calls += 1
        assert self.calls < 500, "the fit goes round for ever"
        fall = np.ones((len(values), 1000))
        fall[:, :20] -= 0.1 * (values[:, [COLUMN]] - values[0, COLUMN])  # slopes promise that little of it goes
        return 1e6 * 0.8**self.calls * fall


def test_a_fit_that_does_not_settle_ends_and_says_so() -> None:
    axis = load_model("axis")
    known = Known((COULOMB,), np.array([70.0]), np.array([1e3]), np.array([0.1]))
    evidence: Any = Falling()
    fitted = fit_base(cast(Evidence, evidence), axis, known, iterations=3)
    assert not fitted.settled
    assert fitted.taken == 3
    assert evidence.calls == 3 * (ROUNDS_EACH + 2)


def test_slopes_that_keep_their_promise_are_made_once() -> None:
    axis = load_model("axis")
    known, made = Known((COULOMB,), np.array([70.0]), np.array([2.0]), np.array([0.1])), list[int]()

    def residuals(model: Model, values: np.ndarray, ranking: bool = False) -> np.ndarray:
        made.append(len(values))
        return (values[:, COLUMN, None] - 71.0) * np.linspace(1.0, 9.0, 400)

    fake = SimpleNamespace(names=("momentum 100 ms",), family=np.zeros(400, dtype=int), residuals=residuals, **NO_LOAD)
    evidence: Any = fake
    fitted = fit_base(cast(Evidence, evidence), axis, known)
    assert abs(fitted.model[COULOMB] - 71.0) < 0.01
    assert made == [1, 2, 1], "the model, slopes, and the whole step"


class Scripted:
    """A descent whose steps, gain and promise in nats, are given for each set of slopes."""

    def __init__(self, *steps: list[tuple[float, float]]) -> None:
        self.model, self.sets = load_model("axis"), list(steps)
        self.steps: list[tuple[float, float]] = []

    def __call__(self, *_: object) -> "Scripted":
        return self

    def renew(self) -> None:
        """Take the next set of slopes."""
        self.steps = self.sets.pop(0)

    def step(self) -> tuple[float, float]:
        """The next step."""
        return self.steps.pop(0)

    def little(self, gain: float) -> bool:
        """Whether it is less than 0.65 nats."""
        return gain < 0.65

    def in_the_same_noise(self) -> bool:
        """As no model is heavier."""
        return True


@pytest.mark.parametrize(("gain", "taken"), [(18_708.6, 1), (17_217.0, 2)])
def test_slopes_that_erred_are_made_again_before_a_fit_ends(
    gain: float, taken: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Slopes that erred by 1492 of 18709 nats saw nothing of 21 nats by which breakaways were too far off."""
    descent = Scripted([(gain, 18_709.0), (0.0, 0.06)], [(20.0, 20.1), (0.0, 0.0)])
    monkeypatch.setattr(sys.modules[fit_base.__module__], "_Descent", descent)
    fitted = fit_base(cast(Any, None), descent.model, cast(Any, None))
    assert (fitted.taken, fitted.settled) == (taken, True)


MASS, PISTON, HUNG = "payload_mass.mass_added", 5.0, 4.5  # kg


def weighed(excess: float) -> tuple[float, float]:
    """A load found and its slope-wise best change, both in kg, from accelerations with as much noise as motion.

    excess: force that nothing explains, over the noise of the force sensor.
    """
    axis = load_model("axis")
    model = axis.with_effects([*axis.effects, "payload_mass"], {MASS: 1.0})
    column, rng = list(model.parameters).index(MASS), np.random.default_rng(7)
    true, sensor = rng.normal(0.0, 1.0, 20_000), 0.1
    seen = true + rng.normal(0.0, 0.5, len(true))
    force = (PISTON + HUNG) * true + sensor * (1.0 + excess) * rng.normal(0.0, 1.0, len(true))
    noise = np.hypot(0.5 * PISTON, sensor)
    share = 0.5 * PISTON / noise
    evidence: Any = SimpleNamespace(
        names=("momentum 100 ms",),
        family=np.zeros(len(true), dtype=int),
        load=lambda model: (PISTON + model[MASS]) / PISTON,
        by_load=lambda load: np.sqrt(1.0 + share**2 * (load**2 - 1.0)) * np.ones(len(true)),
        residuals=lambda model, values, ranking=False: ((PISTON + values[:, [column]]) * seen - force) / noise,
    )
    known = Known((MASS,), np.array([0.0]), np.array([20.0]), np.array([0.01]))
    found = fit_base(cast(Evidence, evidence), model, known).model
    r, steep = slopes(cast(Evidence, evidence), found, known)
    return found[MASS], float(-(r @ steep[:, 0]) / (steep[:, 0] @ steep[:, 0]) * known.prior[0])


def test_noise_of_the_acceleration_draws_no_mass_towards_zero() -> None:
    """Least squares in a fixed unit would find 5 + m = 9.5 / (1 + 0.25), a load of 2.6 kg."""
    found, further = weighed(0.0)
    assert abs(found - HUNG) < 0.15
    assert abs(further) < 0.05, "the slopes disagree with the fit"


def test_what_exceeds_the_noise_makes_no_mass_heavier() -> None:
    """A force of 50 times the sensor's noise, as large as what the noise of the acceleration leaves."""
    assert abs(weighed(50.0)[0] - HUNG) < 0.6
