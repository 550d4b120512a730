"""Effects added by name to a model of the independent rig, which hides one."""

from dataclasses import replace
from functools import lru_cache

import pytest
from identify.making import recording_of
from rig import case as rig_case
from rig.effects import Wish, build

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.diagnose.adding import Adding, add, check_addable
from pneumo_ros.diagnose.polishing import telling
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run, make_run

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
