"""The misfit on held-out recordings: parameters of the machine that changed between recordings, or a missing effect."""

import pytest
from identify.making import own, rig

from pneumo_ros.diagnose.between import Moved, moved_between
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

COULOMB = "lugre_friction.coulomb_friction"


def moved(model: Model, train: Run, held: Run) -> Moved | None:
    """The answer for the momentum equation, without candidates."""
    return moved_between(Fitter(model, [train], [held], []), model, "momentum")


def test_friction_that_was_higher_on_held_out_recordings_is_named() -> None:
    model, _, train = own("steps")
    found = moved(model, train, own("sweep", friction=1.04)[2])
    assert found is not None
    assert found.share > 0.9
    before, after, unit = found.parameters[COULOMB]
    assert after / before == pytest.approx(1.04, abs=0.01)
    assert unit == "N"
    assert not any(name.startswith(("dead_zone", "arctan_flow")) for name in found.parameters)


def test_a_law_that_is_missing_is_no_change_of_parameters() -> None:
    model, _, train = rig("train_steps", 1)
    assert moved(model, train, rig("train_steps", 1, "spring_load", 60.0)[2]) is None


def test_where_nothing_remains_nothing_moved() -> None:
    model, _, train = own("steps")
    assert moved(model, train, own("sweep")[2]) is None


def test_repeats_that_agree_within_a_per_cent_are_of_one_machine() -> None:
    """Friction 0.8 % higher: its misfit is more than noise, and the parameters remove it, but none moves by 1 %."""
    model, _, train = own("steps")
    assert moved(model, train, own("sweep", friction=1.008)[2]) is None
