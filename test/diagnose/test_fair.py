"""Comparisons of models that are fair to both: with a texture of any machine, and where slopes do not reach so far."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from identify.making import rig

from pneumo_ros.diagnose.basefit import unaided
from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.judging import judged
from pneumo_ros.diagnose.refining import held_out, refine
from pneumo_ros.diagnose.rivals import twins
from pneumo_ros.diagnose.score import MARGIN, Score, occam
from pneumo_ros.diagnose.screening import screen
from pneumo_ros.diagnose.search import Ranking, Search
from pneumo_ros.plant import Model, load_model

PROFILE, LOAD, ASYMMETRIC = "position_dependent_friction", "constant_load", "asymmetric_friction"
RUNS = ("train_sweep", "holdout_sweep")
BASE = load_model("axis")
COULOMB = "lugre_friction.coulomb_friction"


def ranked(fitter: Fitter, base: BaseFit, held: BaseFit) -> dict[str, Candidate]:
    """The candidates of a fit, judged on training runs and held-out ones, by name."""
    nothing = unaided(base)
    held = replace(held, residual=held.residual + held.slopes @ nothing.shift)
    best = {h.name: h for h in reversed(screen(base))}
    fitted = refine(base, list(best.values()), settled=True)
    found = judged(base, held, fitted, held_out(base, held, fitted), nothing, True)
    return {one.name: one for one in found}


def both_ways() -> tuple[Fitter, Model]:
    """Coulomb friction that differs between directions, and a model of which it is 10 N too small."""
    (model, _, train), (_, _, held) = (rig(name, 0, f"{ASYMMETRIC}:coulomb", -0.15) for name in RUNS)
    fitter = Fitter(model, [train], [held], [LOAD, ASYMMETRIC])
    off = fitter.refit(model)
    return fitter, off.with_parameters({COULOMB: off[COULOMB] - 10.0})


class Candidates:
    """Candidates of which only the scores and the changes on held-out runs count."""

    @staticmethod
    def candidate(name: str, score: Score) -> Candidate:
        """One that leaves nothing on held-out runs."""
        h = Hypothesis(name, (), np.empty(0), np.empty(0), np.empty(0))
        given: dict[str, Any] = {"gain": {}, "size": 1.0, "share": 1.0, "first": True}
        return Candidate(h, np.zeros(2), score=score, **given)

    @staticmethod
    def ranking() -> Ranking:
        """Held-out runs leave one deviation without any of them."""
        held = cast(BaseFit, SimpleNamespace(residual=np.ones(2)))
        return Ranking(cast(BaseFit, SimpleNamespace(model=BASE)), held, [], [], True)

    @staticmethod
    def search(reached: list[float]) -> Search:
        """A search whose refits reach this evidence."""
        found = Search.__new__(Search)
        found.fitter = cast(Fitter, SimpleNamespace(evidences=lambda _model, _hypotheses: reached))
        return found


def test_a_profile_is_compared_with_none_and_not_with_a_small_one() -> None:
    """The texture that any machine may have takes in a bow of 6 %, at three to eight deviations, in all recordings."""
    (model, _, train), (_, _, held) = (rig(name, 0, f"{PROFILE}:bow", 0.06) for name in RUNS)
    fitter = Fitter(model, [train], [held], [PROFILE])
    one = ranked(fitter, *fitter.fits(fitter.refit(model)))[PROFILE]
    assert one.score.nats > MARGIN
    assert one.score.held > 5.0 * MARGIN
    assert one.share > 0.7


def test_a_texture_is_still_no_profile() -> None:
    (model, _, train), (_, _, held) = (rig(name, 0, f"{PROFILE}:bow", 0.006) for name in RUNS)
    fitter = Fitter(model, [train], [held], [PROFILE])
    assert ranked(fitter, *fitter.fits(fitter.refit(model)))[PROFILE].objections


def test_models_refitted_with_two_effects_differ_as_their_scores_do() -> None:
    """Where slopes reach far enough, and wherever the model is when it is refitted."""
    fitter, off = both_ways()
    base, held = fitter.fits(off)
    found = ranked(fitter, base, held)
    alike = [found[LOAD], found[ASYMMETRIC]]
    reached = fitter.evidences(off, [one.hypothesis for one in alike])
    load, asymmetric = (n - occam(base, one.hypothesis) for n, one in zip(reached, alike, strict=True))
    by_slopes = found[ASYMMETRIC].score.nats - found[LOAD].score.nats
    assert asymmetric - load == pytest.approx(by_slopes, abs=0.5 * MARGIN)
    assert [one.name for one in twins(held, alike)] == [LOAD, ASYMMETRIC]


def test_a_model_is_refitted_from_that_with_the_other_effect_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """From its own start asymmetric friction ended where breakaways were 30 noises off, 223 nats worse than a load."""
    fitter, off = both_ways()
    base, held = fitter.fits(off)
    found = ranked(fitter, base, held)
    alike = [found[one].hypothesis for one in (LOAD, ASYMMETRIC)]
    best, starts = fitter.evidences(off, alike), list[Model]()
    refit, gain = fitter.refit, "arctan_flow.voltage_gain"

    def first_in_a_valley(model: Model) -> Model:
        starts.append(model)
        lost = ASYMMETRIC in model.effects and len(starts) == 2
        return model.with_parameters({gain: 3.0 * model[gain]}) if lost else refit(model)

    monkeypatch.setattr(fitter, "refit", first_in_a_valley)
    assert fitter.evidences(off, alike) == pytest.approx(best, abs=0.5 * MARGIN)
    assert ASYMMETRIC in starts[-1].effects


@pytest.mark.parametrize(("ahead", "first"), [(-4.0, LOAD), (20.0, ASYMMETRIC)])
def test_effects_that_change_the_same_have_the_scores_of_refitted_models(
    ahead: float, first: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By slopes from afar, an asymmetric friction was 15 nats worse than a constant load, and is 6 better."""
    score, found = Score(90.0, 10.0), Candidates()
    monkeypatch.setattr(
        import_module(Search.__module__), "occam", lambda _base, h: {LOAD: 1.0, ASYMMETRIC: 3.0}[h.name]
    )
    search, other = found.search([0.0, ahead + 2.0]), found.candidate("valve_hysteresis", score=Score(50.0, 5.0))
    alike = [found.candidate(LOAD, score=score), found.candidate(ASYMMETRIC, score=Score(75.0, 9.0))]
    told = search.told_apart(found.ranking(), [*alike, replace(other, held=np.array([0.0, 1.0]))])
    assert [one.name for one in told] == [*sorted([LOAD, ASYMMETRIC], key=lambda n: n != first), "valve_hysteresis"]
    scores = {one.name: one.score for one in told}
    assert scores[LOAD] == score
    assert scores[ASYMMETRIC].nats == pytest.approx(score.nats + ahead)
    assert scores[ASYMMETRIC].held == 9.0
    assert scores["valve_hysteresis"] == Score(50.0, 5.0)
