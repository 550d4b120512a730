"""Changes that must not change the answer, on one machine of the rig; benchmarks/bench_invariance.py has many."""

import sys
from pathlib import Path
from typing import Any

import pytest
from diagnose.recording import recordings_of

from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.plant import load_model

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
Case = tuple[Any, dict[str, Any]]  # the question as recorded, and what was found


@pytest.fixture(scope="module")
def leaking(tmp_path_factory: pytest.TempPathFactory) -> Case:
    """A machine with a leak of one chamber, so that a mirror moves it to the other one."""
    sys.path.insert(0, str(BENCHMARKS))
    from blind_case import found
    from invariance_changes import Question

    asked = Question(
        load_model("axis"), *recordings_of(tmp_path_factory.mktemp("leaking"), 22, "leakage_to_atmosphere")
    )
    return asked, found(diagnose(*asked))


@pytest.mark.check
@pytest.mark.parametrize("change", ["catalogue reversed", "recordings reversed", "mirrored"])
def test_the_answer_stays(leaking: Case, change: str) -> None:
    from blind_case import found
    from invariance_case import as_recorded
    from invariance_changes import OF_QUESTIONS
    from invariance_tables import said, same_answer, sizes

    asked, before = leaking
    after = found(diagnose(*OF_QUESTIONS[change](asked)))
    for added in after["added"]:
        added["parameters"] = as_recorded(added["effect"], added["parameters"], change)
    assert before["added"]
    assert same_answer(before, after), f"{said(before)} -> {said(after)}"
    assert all(distance <= 1.0 for _, distance in sizes(before, after))
