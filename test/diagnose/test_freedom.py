"""Laws that differ from the catalogue's, and laws that do not, next to a second effect."""

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from pneumo_ros.diagnose.basefit import unaided
from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.freedom import (
    LAW_SPREAD,
    conditions,
    freed,
    loosened,
    points_of,
    profile_slopes,
    relative,
    shaping,
    uneven,
    unevenness,
)
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.score import log_prior
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
    frame=SimpleNamespace(states=SEEN[:, [0, 1]], chambers=()),
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


PROFILE = "position_dependent_friction"
KNOTS = np.array(
    [np.roll(np.eye(1, 25)[0], k)[np.minimum((POSITION + 1.0) * 12.5, 24.0).astype(int)] for k in range(25)]
)


@pytest.mark.parametrize(("rough", "goes"), [(0.5, True), (10.0, False)])
def test_friction_is_never_the_same_all_along_the_stroke(rough: float, goes: bool) -> None:
    """A profile that the model lacks is free by a tenth of its usual size: a texture goes, a tight spot stays."""
    tight = np.random.default_rng(1).normal(0.0, rough * 0.5, 25) @ KNOTS  # deviations; half of one: a tenth of usual
    residual, slopes = RNG.normal(size=N) + tight, np.zeros((N, 1))
    fit = BaseFit(START, START, ("a",), np.ones(1), np.zeros(1), EVIDENCE, residual, slopes)
    free = uneven(fit, {PROFILE: 0.5 * KNOTS.T})
    assert (free.bends, free.own) == (25, slice(0, 1))
    left = float(np.sqrt(np.mean(unaided(free).residual ** 2)))
    assert (left < 1.03) is goes
    with_profile = START.with_effects([*START.effects, PROFILE])
    assert uneven(replace(fit, model=with_profile), {PROFILE: KNOTS.T}).bends == 0
    with_spot = with_profile.with_parameters({f"{PROFILE}.knot_12": 0.0, f"{PROFILE}.spot_height": 0.2})
    assert uneven(replace(fit, model=with_spot), {PROFILE: KNOTS.T}).bends == 25  # of another form of the same effect


@pytest.mark.parametrize("spread", [0.2, 1.0])
def test_points_of_a_profile_that_is_a_candidate_are_known_as_effects_are(spread: float) -> None:
    """To a share of a usual size about the candidate's own sizes; points that training does not pass, about zero."""
    fit = BaseFit(START, START, ("a",), np.ones(1), np.ones(1), EVIDENCE, np.zeros(N), np.zeros((N, 1)))
    fit = uneven(fit, {PROFILE: 0.5 * KNOTS.T})
    some = tuple(coordinates(START.library.find(PROFILE))[3:6])
    h = Hypothesis(PROFILE, some, np.array([1.0, 2.0, 3.0]), np.zeros(26), fit.residual)
    free = loosened(fit, h, spread)
    assert free.offset == pytest.approx([1.0, 0.0, 0.0, 0.0, *(np.arange(1, 4) / spread), *([0.0] * 19)])
    np.testing.assert_allclose(free.slopes[:, points_of(fit, some)], fit.slopes[:, 1:] * spread / LAW_SPREAD)
    # taken back to nothing, its points cost nothing; as they are, each half the square of its size in spreads
    here, back = np.zeros(26), -free.offset * points_of(fit, some)
    assert log_prior(free, here, h) - log_prior(free, back, h) == pytest.approx(-0.5 * (1.0 + 4.0 + 9.0) / spread**2)
    spot = tuple(coordinates(START.library.find(PROFILE))[25:])  # another form of it has no points
    other = replace(h, coordinates=spot, u=np.array([1.0, 2.0 * spot[1].expected, 3.0]))
    assert loosened(fit, other, spread) is fit
    assert log_prior(fit, here, other) - log_prior(free, back, h) == pytest.approx(-0.5 * (1.0 + 4.0 + 9.0))


def test_slopes_of_a_profile_are_those_of_its_texture() -> None:
    """By usual sizes, in the order of the candidate's coordinates; no other effect has such points."""
    fit = BaseFit(START, START, ("a",), np.ones(1), np.ones(1), EVIDENCE, np.zeros(N), np.zeros((N, 1)))
    fit, own = uneven(fit, {PROFILE: 0.5 * KNOTS.T}), tuple(coordinates(START.library.find(PROFILE))[3:6])
    np.testing.assert_allclose(profile_slopes(fit, own[::-1]), 0.5 * KNOTS.T[:, [5, 4, 3]] / LAW_SPREAD)
    assert profile_slopes(fit, coordinates(START.library.find("constant_load"))).size == 0
    assert profile_slopes(replace(fit, names=("a",)), own).size == 0


def test_a_model_without_free_parameters_has_no_points() -> None:
    """As sealed chambers whose motion is imposed: an array without an element still says which of them."""
    fit = BaseFit(START, START, (), np.ones(0), np.zeros(0), EVIDENCE, np.zeros(N), np.zeros((N, 0)))
    assert np.zeros(0)[points_of(fit, coordinates(START.library.find("heat_exchange")))].shape == (0,)


def test_only_profiles_are_free_where_the_model_lacks_them() -> None:
    """A tenth of the usual size of each knot, and nothing of an effect of one size."""
    lacking = {name: coordinates(START.library.find(name)) for name in (PROFILE, "viscous_friction")}
    whole = START.with_effects([*START.effects, *lacking], dict.fromkeys((c.name for c in lacking[PROFILE][:25]), 0.0))
    knots = [c.name for c in lacking[PROFILE][:25]]
    at = [list(whole.parameters).index(name) for name in knots]
    linear = SimpleNamespace(residuals=lambda model, values, ranking: 3.0 * values[:, at])
    found = unevenness(cast(Evidence, linear), whole, lacking)
    assert list(found) == [PROFILE]
    np.testing.assert_allclose(found[PROFILE], 0.03 * np.eye(25), atol=1e-12)


def test_what_shapes_the_law_of_an_added_effect_is_no_other_effect() -> None:
    """The curve of a valve: its subsonic index and the critical ratio of each path; not what shapes nothing added."""
    iso = START.with_effects([*START.effects, "choked_flow"])
    assert set(shaping(iso, ["choked_flow"])) == {"path_critical_ratios", "subsonic_index"}
    assert shaping(iso, []) == shaping(MODEL, ["viscous_friction"]) == {}
