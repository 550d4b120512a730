"""Short recordings of rig machines with a hidden effect; benchmarks/bench_blind.py has many."""

from pathlib import Path

import pytest
from diagnose.recording import recordings_of

from pneumo_ros.command.demo.revealing import judge
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.diagnose.ruler import RULER
from pneumo_ros.plant import load_model


def outcome_of(folder: Path, seed: int, *hidden: str) -> Outcome:
    """Record the worn machine of `seed` that hides these effects, and diagnose the recordings."""
    return diagnose(load_model("axis"), *recordings_of(folder, seed, *hidden))


@pytest.mark.check
@pytest.mark.parametrize(
    ("seed", "hidden", "parameter", "equation"),
    [
        (21, "viscous_friction=150", ("coefficient", 150.0), "momentum"),
        (22, "leakage_to_atmosphere=5e-10", ("conductance_b", 5e-10), "chamber_b"),
    ],
)
def test_a_hidden_effect_is_found(
    seed: int, hidden: str, parameter: tuple[str, float], equation: str, tmp_path: Path
) -> None:
    outcome = outcome_of(tmp_path, seed, hidden)
    name, (key, size) = hidden.partition("=")[0], parameter
    assert outcome.verdict == "effects_found"
    assert equation in outcome.failing
    assert judge([name], [(a.effect, a.indistinguishable_from) for a in outcome.added]).right
    (found,) = [a for a in outcome.added if a.effect == name]
    assert found.parameters[key].value == pytest.approx(size, rel=0.05)
    assert abs(found.parameters[key].value - size) < 3.0 * found.parameters[key].std
    assert all(one.std > 0.9 * RULER * size for one in found.parameters.values())  # also of the chamber that is tight
    assert outcome.waterfall[-1][1] < outcome.waterfall[1][1]  # held-out error, in the end and of the refitted base


@pytest.mark.check
def test_nothing_is_added_to_a_healthy_machine(tmp_path: Path) -> None:
    outcome = outcome_of(tmp_path, 23)
    assert outcome.added == ()
    assert outcome.verdict == "adequate"


@pytest.mark.check
def test_what_no_catalogue_has_is_not_called_adequate(tmp_path: Path) -> None:
    outcome = outcome_of(tmp_path, 24, "detent_force=15")
    assert outcome.verdict == "unknown_effect"
    assert outcome.unexplained is not None
    assert outcome.unexplained.equation == "momentum"
