"""Effects that only breakaways and reversals show: they must determine the size, and enough of them must show it."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from pneumo_ros.diagnose import slip_candidates
from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.coordinates import Coordinate, coordinates
from pneumo_ros.diagnose.slip_candidates import (
    Misfit,
    SlipFits,
    Slipping,
    as_candidate,
    deviations_better,
    paired,
    resized,
)
from pneumo_ros.diagnose.slips import Slips
from pneumo_ros.plant import Model, load_model

Array = NDArray[np.float64]

MODEL = load_model("axis")
EFFECT = "dwell_time_breakaway"
RISE = 12.0  # N
SAMPLES = 300


def tried(model: Model, before: Array, after: Array, std: dict[str, float], q: float = 0.5) -> Candidate:
    effect = coordinates(MODEL.library.find(EFFECT))
    return as_candidate(Slipping(EFFECT, model, after, after, std), effect, before, Misfit(before, q), SAMPLES, True)


@pytest.mark.parametrize(("std", "objects"), [(1.5, False), (13.8, True), (None, True)])
def test_a_size_that_nothing_determines_is_refused(std: float | None, objects: bool) -> None:
    """All other evidence supports it: each event fits ten times better."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    before, after = np.full(40, 10.0), np.full(40, 1.0)
    known = {} if std is None else {f"{EFFECT}.rise": std}
    candidate = tried(model, before, after, known)
    assert any("uncertainty" in words for words in candidate.objections) is objects
    assert bool(candidate.objections) is objects


@pytest.mark.parametrize(("changed", "objects"), [(16, False), (3, True)])
def test_an_effect_in_two_events_of_five_shows_in_the_upper_quartile(changed: int, objects: bool) -> None:
    """The others scatter about the noise with it as without it."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    rng = np.random.default_rng(1)
    before, after = (1.05 + 0.003 * rng.standard_normal(40) for _ in range(2))
    before[:changed] = 30.0
    assert bool(tried(model, before, after, {f"{EFFECT}.rise": 1.5}, 0.75).objections) is objects


@pytest.mark.parametrize(("least", "poor", "share"), [(1.0, True, 8.0 / 9.0), (4.0, True, 1.0), (8.0, False, 1.0)])
def test_what_noise_and_texture_leave_is_no_misfit(least: float, poor: bool, share: float) -> None:
    before = Misfit(np.full(40, 10.0), 0.5, least)
    assert before.poor is poor
    assert before.share(np.full(40, 2.0)) == pytest.approx(share)
    assert before.share(np.full(40, 12.0)) < 0.0


def test_what_the_equations_along_the_motion_speak_against_is_refused() -> None:
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    before, after = np.full(40, 10.0), np.full(40, 1.0)
    for against, objects in ((-3.0, False), (60.0, False), (130.0, True)):  # forty events support it by 3 each
        candidate = Slipping(EFFECT, model, after, after, {f"{EFFECT}.rise": 1.5}, against)
        own = coordinates(MODEL.library.find(EFFECT))
        candidate = as_candidate(candidate, own, before, Misfit(before), SAMPLES, True)
        assert any("contradict it" in words for words in candidate.objections) is objects
        assert bool(candidate.objections) is objects


def test_events_count_by_the_scatter_of_what_each_gains() -> None:
    """Forty events whose error halves each; whose errors fall or rise by chance; a single one that falls far."""
    rng = np.random.default_rng(1)
    before = np.exp(rng.normal(1.0, 1.0, 40))
    assert paired(before, 0.5 * before * np.exp(0.1 * rng.standard_normal(40)), SAMPLES) > 40.0
    assert abs(paired(before, np.exp(rng.normal(1.0, 1.0, 40)), SAMPLES)) < 2.0
    one = before.copy()
    one[0] *= 1e-6
    assert 0.0 < paired(before, one, SAMPLES) < 1.0
    assert paired(one, before, SAMPLES) == -paired(before, one, SAMPLES)
    assert paired(before, before, SAMPLES) == 0.0


def test_sizes_grow_and_shapes_stay() -> None:
    """For an effect that grows as its size falls, such as a bandwidth, the inverse grows."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT, "valve_spool_dynamics"], {f"{EFFECT}.rise": RISE})
    assert resized(coordinates(MODEL.library.find(EFFECT)), model, 2.0) == {f"{EFFECT}.rise": 2.0 * RISE}
    spool = resized(coordinates(MODEL.library.find("valve_spool_dynamics")), model, 2.0)
    (name,) = [name for name, value in spool.items() if value != model[name]]
    assert spool[name] == pytest.approx(0.5 * model[name])


LAG, TRUE = "friction_lag", 8e-3
BEGUN = {"backlash": 1e-4, LAG: 2e-3}  # initial sizes of the candidates


FITTED: list[tuple[str, bool]] = []  # names of candidates that were fitted, and whether to some events only


class Stuck(SlipFits):
    """Fits that stay at their start; the misfit is the distance from the true lag; the other candidate is refused."""

    def _fitted(self, name: str, begin: Model, own: Sequence[Coordinate], some: bool = False) -> Slipping:
        FITTED.append((name, some))
        size = next(begin[c.name] for c in coordinates(begin.library.find(name)) if c.is_size)
        error = np.full(40, 1.2 if name != LAG else 1.0 + 1.5 * abs(np.log2(size / TRUE)))
        return Slipping(name, begin, error, error, {f"{name}.time_constant": 1e-4}, 0.0 if name == LAG else 60.0, some)


@pytest.mark.parametrize("begun", [2e-3, 32e-3, 8e-3])
def test_a_fit_that_explains_part_is_restarted_from_other_sizes(begun: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where another one explains more but the equations along the motion contradict it, which ends its fits."""

    def begins(alone: Model, _found: Slips, name: str, _own: Sequence[Coordinate]) -> tuple[float, Model]:
        key = next(c.name for c in coordinates(alone.library.find(name)) if c.is_size)
        return 1.0, alone.with_effects([*alone.effects, name], {key: BEGUN[name]})

    monkeypatch.setattr(slip_candidates, "by_sizes", begins)
    monkeypatch.setitem(BEGUN, LAG, begun)
    nothing = np.empty(0, dtype=np.int64)
    FITTED.clear()
    tried = Stuck(MODEL, Slips((), (), nothing, nothing), {}, lambda *_: 0.0, Misfit(np.full(40, 6.0))).tried([*BEGUN])
    assert {c.name: c.model[f"{LAG}.time_constant"] for c in tried if c.name == LAG} == {LAG: pytest.approx(TRUE)}
    assert ("backlash", False) not in FITTED
    assert not any(c.some for c in tried if c.name == LAG)


@pytest.mark.parametrize("lag", [TRUE, 1e-5])
def test_a_candidate_that_explains_nothing_of_some_events_is_not_fitted_to_all(
    lag: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = MODEL.with_effects([*MODEL.effects, LAG], {f"{LAG}.time_constant": lag})
    monkeypatch.setattr(slip_candidates, "by_sizes", lambda *_: (1.0, begun))
    nothing = np.empty(0, dtype=np.int64)
    FITTED.clear()
    (found,) = Stuck(MODEL, Slips((), (), nothing, nothing), {}, lambda *_: 0.0, Misfit(np.full(40, 6.0))).tried([LAG])
    assert [(LAG, True), (LAG, False)][: 2 if lag == TRUE else 1] == FITTED
    assert found.model is begun


class Numbered(Slips):
    """Events that are their own number."""

    def train(self, model: Model) -> Any:
        return SimpleNamespace(pick=lambda chosen: self.train_rows[chosen].tolist())


@pytest.mark.parametrize(
    ("count", "some"), [(40, [0, 4, 7, 11, 14, 18, 21, 25, 28, 32, 35, 39]), (5, [0, 1, 2, 3, 4]), (0, [])]
)
def test_some_events_are_spread_evenly(count: int, some: list[int]) -> None:
    assert Numbered((), (), np.arange(count), np.arange(0)).some(MODEL) == some


@pytest.mark.parametrize(("std", "costs"), [(0.2, False), (0.01, True)])
def test_a_shape_that_the_events_do_not_determine_costs_nothing(std: float, costs: bool) -> None:
    """A damping of exactly zero is infinitely improbable as a factor, and as good as any within its deviation."""
    name = "load_compliance"
    own = coordinates(MODEL.library.find(name))
    zero = next(c for c in own if c.role == "damping")
    model = MODEL.with_effects([*MODEL.effects, name], {c.name: 0.0 if c is zero else c.typical for c in own})
    before, after = np.full(40, 10.0), np.full(40, 1.0)
    spread = {c.name: 0.1 * c.typical for c in own} | {zero.name: std * zero.typical}
    candidates = [
        as_candidate(Slipping(name, one, after, after, spread), own, before, Misfit(before), SAMPLES, True)
        for one in (model, model.with_parameters({zero.name: zero.typical}))
    ]
    lost = candidates[1].score.nats - candidates[0].score.nats
    assert 0.0 < lost < 20.0
    assert (lost > 4.0) == costs


def test_events_that_nothing_changes_and_single_wild_ones_decide_nothing() -> None:
    before = np.ones(40)
    assert deviations_better(before, before, SAMPLES) == 0.0
    wild = before.copy()
    wild[0] = 1e6
    assert deviations_better(wild, before, SAMPLES) == pytest.approx(1.0)
    assert deviations_better(before, wild, SAMPLES) == pytest.approx(-1.0)
    assert deviations_better(np.full(40, 2.0), before, SAMPLES) == pytest.approx(np.sqrt(40.0))
