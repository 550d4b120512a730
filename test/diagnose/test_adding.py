"""Effects added by name to a model of the independent rig, which hides one."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from identify.making import recording_of
from rig import case as rig_case
from rig.effects import Wish, build

import pneumo_ros as pn
from pneumo_ros.compare.compare import Comparison
from pneumo_ros.diagnose.adding import Adding, add, agreed, check_addable
from pneumo_ros.diagnose.polishing import telling
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run, make_run
from pneumo_ros.shooting.refit import Estimate

LOAD = 35.0  # N against extension
SECONDS = 12.0


@lru_cache(maxsize=1)
def runs() -> tuple[Run, ...]:
    """A worn machine with a load, which creeps and slides, recorded by the independent rig."""
    case = build(7, [Wish("constant_load", LOAD)])
    names = ("train_slow", "holdout_slow")
    whole = [make_run(recording_of(run)) for run in rig_case.make_runs(case, names, step=4e-5)]
    return tuple(first(run, SECONDS) for run in whole)


def first(run: Run, seconds: float) -> Run:
    """The beginning of a run."""
    n = round(seconds / run.sample_time)
    signals = {name: getattr(run, name)[:n] for name in ("position", "pressure_a", "pressure_b", "measured")}
    return replace(run, **signals, input=run.input[: (n - 1) * PARTS])


@lru_cache(maxsize=1)
def added() -> Adding:
    """The load, added to the default machine."""
    train, held = runs()
    return add(load_model(), ["constant_load"], [train], [held])


@pytest.mark.check
def test_the_rigs_load_is_fitted_and_pays_on_a_run_held_out() -> None:
    found = added()
    own = found.estimates["constant_load.load"]
    assert abs(own.value) == pytest.approx(LOAD, rel=0.03)
    assert own.determined
    assert found.held_out
    assert found.judged == ("holdout_slow",)
    given, before, after = found.errors
    assert after < 1.3
    assert before > 20.0 * after
    assert given > after
    assert isinstance(found.after, Comparison)


@pytest.mark.check
def test_what_the_model_has_is_estimated_against_what_was_known() -> None:
    one = added().estimates["lugre_friction.static_friction"]
    assert one.before == load_model()["lugre_friction.static_friction"]
    assert one.prior == pytest.approx(0.03 * one.before)


def test_two_fits_that_disagree_widen_the_interval() -> None:
    def one(value: float, std: float) -> Estimate:
        return Estimate(value, std, value - 1.96 * std, value + 1.96 * std, 10.0, 3.0)

    predicted = {name: one(10.0, 0.1) for name in ("near", "far", "unseen", "alone")} | {"lost": one(10.0, np.inf)}
    along = {"near": one(10.5, 0.6), "far": one(11.0, 0.6), "unseen": one(20.0, np.inf), "lost": one(11.0, 0.1)}
    found = agreed(predicted, along, {"alone": 0.2})
    assert {name: one.std for name, one in found.items()} == pytest.approx(
        {"near": 0.1, "far": 0.8, "unseen": 0.1, "alone": np.hypot(0.1, 0.2), "lost": np.inf}
    )
    assert found["far"].value == 10.0
    assert found["far"].high == pytest.approx(10.0 + 1.96 * 0.8)


@pytest.mark.check
def test_intervals_hold_where_another_effect_is_missing() -> None:
    """A leak is not added: dead zones by prediction are 4 of their deviations off, and say so."""
    axis, noise = load_model(), {"position": 1e-5, "pressure_a": 300.0, "pressure_b": 300.0}
    hidden = {"viscous_friction.coefficient": 40.0, "cross_piston_leakage.conductance": 1e-10}
    truth = axis.with_effects([*axis.effects, "viscous_friction", "cross_piston_leakage"], hidden)
    shapes = ("sine:2.5,0.5", "sine:1.5,0.25", "sine:3.5,1.0")
    train = [
        make_run(pn.simulate(truth, shape, seconds=6.0, noise=noise, seed=seed, name=shape))
        for seed, shape in enumerate(shapes)
    ]
    found = add(axis, ["viscous_friction"], train)
    known = {name: one for name, one in found.estimates.items() if one.determined}
    assert len(known) > 5
    assert all(one.low < truth[name] < one.high for name, one in known.items())


def test_segments_hold_the_breakaways() -> None:
    train, _ = runs()
    (starts,) = telling(load_model(), [train], 500, 40)
    assert 10 <= len(starts) <= 40
    assert len(telling(load_model(), [train], 500, 6)[0]) == 6


@pytest.mark.parametrize(
    ("effects", "sentence"),
    [
        ([], "name an effect"),
        (["constant_lod"], "did you mean constant_load"),
        (["lugre_friction"], "already"),
        (["payload_mass", "payload_mass"], "named twice"),
        (["arm_load"], r"not fitted.*arm_load: \{urdf: arm.urdf, joint"),
    ],
)
def test_what_cannot_be_added_is_refused(effects: list[str], sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        check_addable(load_model(), effects)


def test_a_model_without_friction_cannot_be_given_a_whole_one() -> None:
    bare = load_model().with_effects(["dead_zone", "arctan_flow", "end_stop"])
    with pytest.raises(UsageError, match="put it into the machine file instead"):
        check_addable(bare, ["lugre_friction"])
