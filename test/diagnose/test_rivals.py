"""Which effects count as rivals, and which of two equally good ones is chosen."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.rivals import rivals, simplest
from pneumo_ros.diagnose.score import Score
from pneumo_ros.plant import load_model

RNG = np.random.default_rng(0)
N = 400
NOISE = RNG.normal(size=N)
TRACE = 3.0 * np.sin(0.1 * np.arange(N))


def evidence() -> Evidence:
    """The part of the evidence that the comparison of candidates reads: one family, blocks of ten."""
    names, family, block = ("momentum 100 ms",), np.zeros(N, dtype=np.int64), np.arange(N) // 10
    return cast(Evidence, SimpleNamespace(names=names, family=family, block=block))


def fit() -> BaseFit:
    """A base that leaves noise and a trace."""
    model = load_model("axis")
    return BaseFit(model, model, (), np.empty(0), np.empty(0), evidence(), NOISE + TRACE, np.empty((N, 0)))


def candidate(name: str, left: np.ndarray, nats: float = 100.0) -> Candidate:
    """A candidate that leaves `left` in training and held-out runs alike."""
    h = Hypothesis(name, (), np.empty(0), np.empty(0), left, t=50.0)
    given: dict[str, Any] = {"gain": {"momentum": 0.9}, "size": 1.0, "share": 1.0}
    return Candidate(hypothesis=h, held=left, first=True, score=Score(nats, 1.0), **given)


def test_what_leaves_the_same_is_a_rival() -> None:
    best, other = candidate("constant_load", NOISE), candidate("spring_load", NOISE + 0.01 * TRACE, 99.0)
    assert [r.name for r in rivals(fit(), fit(), best, [best, other])] == ["spring_load"]


def test_an_effect_with_a_worse_score_is_no_rival() -> None:
    best, other = candidate("constant_load", NOISE), candidate("spring_load", NOISE + 0.7 * TRACE, 91.0)
    assert rivals(fit(), fit(), best, [best, other]) == []


def test_an_effect_that_changes_something_else_is_no_rival() -> None:
    best, other = (
        candidate("constant_load", NOISE),
        candidate("spring_load", NOISE + TRACE - 3.0 * RNG.normal(size=N), 99.0),
    )
    assert rivals(fit(), fit(), best, [best, other]) == []


def test_of_two_that_explain_the_same_the_contained_one_is_taken() -> None:
    general, simple = candidate("asymmetric_viscous_friction", NOISE), candidate("viscous_friction", NOISE, 99.0)
    chosen = simplest(fit(), fit(), [general, simple])
    assert chosen is simple
    assert rivals(fit(), fit(), simple, [general, simple]) == []


def test_the_general_one_is_taken_where_recordings_ask_for_it() -> None:
    general, simple = (
        candidate("asymmetric_viscous_friction", NOISE),
        candidate("viscous_friction", NOISE + 0.7 * TRACE, 60.0),
    )
    assert simplest(fit(), fit(), [general, simple]) is general


def test_a_small_part_that_recordings_only_just_show_is_no_reason_for_the_general_one() -> None:
    """Even with many recordings: a machine's law differs from the catalogue's by a twentieth."""
    sure = 20.0 * fit().residual  # so much noise below the trace
    base = replace(fit(), residual=sure)
    general = candidate("asymmetric_viscous_friction", NOISE)
    simple = candidate("viscous_friction", NOISE + 0.8 * TRACE, 99.0)
    assert simplest(base, base, [general, simple]) is simple


def test_the_contained_one_is_taken_though_it_removes_too_little_for_itself() -> None:
    general = candidate("asymmetric_viscous_friction", NOISE)
    simple = replace(candidate("viscous_friction", NOISE, 99.0), share=0.1)
    chosen = simplest(fit(), fit(), [general, simple])
    assert chosen is not None
    assert chosen.name == "viscous_friction"
    assert not chosen.objections


def test_what_removes_too_little_is_not_taken_where_the_general_one_does_too() -> None:
    general = replace(candidate("asymmetric_viscous_friction", NOISE), share=0.1)
    simple = replace(candidate("viscous_friction", NOISE, 99.0), share=0.1)
    assert simplest(fit(), fit(), [general, simple]) is None
