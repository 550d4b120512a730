"""In which order effects are added; a table replaces fits and predictions."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.score import Score
from pneumo_ros.diagnose.search import ROUNDS, UNHELPFUL, VANISHED, Search
from pneumo_ros.diagnose.steps import Step
from pneumo_ros.plant import Model, load_model

BASE = load_model("axis")
LOAD, DROOP, OFFSET, STRIBECK = "constant_load", "supply_pressure_droop", "pressure_sensor_offset", "stribeck_shape"


def candidate(name: str) -> Candidate:
    """A candidate to which nothing objects."""
    h = Hypothesis(name, (), np.empty(0), np.empty(0), np.empty(0), t=50.0)
    given: dict[str, Any] = {"gain": {"momentum": 0.5}, "size": 1.0, "share": 0.6}
    return Candidate(hypothesis=h, held=np.empty(0), first=False, score=Score(90.0, 10.0), **given)


class Played(Search):
    """Candidates are tried in the given order; their remaining misfit and the models' predictions come from tables."""

    def __init__(
        self,
        order: Sequence[str],
        errors: Mapping[frozenset[str], float],
        vanish: Mapping[str, str] | None = None,
        slipping: str = "",
    ) -> None:
        self.progress = lambda share, text: None
        self.slipping = slipping
        self.order, self.vanish, self.tried = order, vanish or {}, list[tuple[frozenset[str], str]]()
        self.start = BASE

        def larger(model: Model, h: Hypothesis) -> Model:
            return model.with_effects([*model.effects, h.name])

        self.fitter = cast(
            Fitter,
            SimpleNamespace(
                refit=lambda model: model,
                extended=larger,
                limits=[],
                added=lambda model: [name for name in model.effects if name not in BASE.effects],
                deviations=lambda model: dict.fromkeys(model.parameters, 1e-9),
            ),
        )
        self.refit = self.polish = cast(Any, self.fitter.refit)
        self.paying = set()
        self.logs = cast(Any, lambda model: {"position": np.full(9, np.log(errors[self.added(model)]))})
        self.slips = cast(Any, lambda model: None)
        self.recordings = np.zeros(9, dtype=np.int64)

    @staticmethod
    def added(model: Model) -> frozenset[str]:
        return frozenset(model.effects) - frozenset(BASE.effects)

    def round(self, model: Model, refused: Mapping[str, str]) -> Step:
        found = [candidate(n) for n in self.order if n not in refused and n not in model.effects]
        return Step(model, tuple(found), found[0] if found else None, (), {}, {})

    def extended(self, model: Model, candidate: Candidate) -> tuple[Model, list[str]]:
        self.tried.append((self.added(model), candidate.name))
        gone = [old for old, new in self.vanish.items() if new == candidate.name and old in model.effects]
        return model.with_effects([*(n for n in model.effects if n not in gone), candidate.name]), gone

    def slip_round(self, model: Model) -> tuple[Model, Step | None]:
        if not self.slipping:
            return model, None
        step = Step(model, (), candidate(self.slipping), (), {}, {})
        return model.with_effects([*model.effects, self.slipping]), step

    def settled(self, model: Model, smaller: Model | None = None) -> Model:
        return model


def errors(**each: float) -> dict[frozenset[str], float]:
    short = {"load": LOAD, "droop": DROOP, "offset": OFFSET, "stribeck": STRIBECK}
    return {frozenset(short[part] for part in key.split("_") if part != "base"): value for key, value in each.items()}


def names(search: Search) -> list[str]:
    return [step.added.name for step in search.run().steps if step.added]


def test_an_effect_that_predictions_reject_is_tried_again_after_another_is_added() -> None:
    search = Played([LOAD, DROOP], errors(base=10.0, load=11.0, droop=5.0, load_droop=1.0))
    assert names(search) == [DROOP, LOAD]


@pytest.mark.parametrize(("together", "added"), [(1.0, [LOAD, DROOP]), (9.8, [])])
def test_two_effects_are_added_together_where_each_alone_predicts_worse(together: float, added: list[str]) -> None:
    """A line delay of 592 nats and a constant load of 398, each taken back as long as the other one was missing."""
    search = Played([LOAD, DROOP], errors(base=10.0, load=11.0, droop=12.0, load_droop=together))
    found = search.run()
    assert [step.added.name for step in found.steps if step.added] == added
    assert [name for name in found.model.effects if name in (LOAD, DROOP)] == added


def test_two_that_were_added_together_are_taken_back_together() -> None:
    """The last refit helps the base alone."""

    class Settling(Played):
        def settled(self, model: Model, smaller: Model | None = None) -> Model:
            return model.with_parameters({"piston.mass": 4.0}) if model.effects == BASE.effects else model

    search = Settling([LOAD, DROOP], errors(base=10.0, load=11.0, droop=12.0, load_droop=3.0))
    whole, settled = search.logs, {"position": np.full(9, np.log(2.0))}
    search.logs = cast(Any, lambda model: settled if model["piston.mass"] == 4.0 else whole(model))
    found = search.run()
    assert found.model.effects == BASE.effects
    assert {c.refused for c in found.steps[-1].candidates if c.name in (LOAD, DROOP)} == {UNHELPFUL}


def test_it_is_tried_once_beside_each_model() -> None:
    search = Played([LOAD, DROOP], errors(base=10.0, load=11.0, droop=5.0, load_droop=5.5))
    assert names(search) == [DROOP]
    assert search.tried == [(frozenset(), LOAD), (frozenset(), DROOP), (frozenset([DROOP]), LOAD)]


def test_what_vanished_beside_another_does_not_come_back() -> None:
    search = Played(
        [OFFSET, LOAD], errors(base=10.0, offset=6.0, load=1.0, load_offset=0.5), vanish={OFFSET: LOAD}
    )  # fmt: skip
    found = search.run()
    assert [step.added.name for step in found.steps if step.added] == [LOAD]
    assert [t.refused for t in found.steps[0].candidates if t.name == OFFSET] == [VANISHED]
    assert UNHELPFUL not in {t.refused for step in found.steps for t in step.candidates}


@pytest.mark.parametrize(("left", "objected"), [(6.0, False), (8.0, True)])
def test_what_the_equations_hardly_show_may_pay_in_predictions(left: float, objected: bool) -> None:
    """The best one is asked, whether or not nothing is objected to a weaker one; half of 10 squared is 7 squared."""
    search = Played([], errors(base=10.0, load=left, droop=1.0))
    best, weaker = replace(candidate(LOAD), share=0.0), replace(candidate(DROOP), score=Score(10.0, 10.0))
    judged = search.asked(search.start, [best, weaker])
    assert bool(judged[0].objections) == objected
    assert judged[1] is weaker
    assert search.paying == (set() if objected else {LOAD})


@pytest.mark.parametrize("first", [True, False])
def test_others_are_asked_only_beside_effects_that_were_added(first: bool) -> None:
    """What is missing alone would be the best one; the laws of added effects may be inexact."""
    search = Played([], errors(base=10.0, load=9.9, droop=2.0))
    judged = [replace(candidate(name), share=0.0, first=first) for name in (LOAD, DROOP)]
    assert [bool(one.objections) for one in search.asked(search.start, judged)] == [True, first]


@pytest.mark.parametrize(("friction_alone", "objected"), [(9.0, False), (4.0, True)])
def test_friction_that_a_refit_came_upon_is_no_merit_of_a_candidate(friction_alone: float, objected: bool) -> None:
    """A refit of friction beside a Stribeck exponent of 2.1 +- 0.4 ended in a better valley, which needs no effect."""
    search = Played([], errors(base=10.0, load=3.0))
    friction = "lugre_friction.static_friction"
    search.polish = cast(Any, lambda model: model.with_parameters({friction: 1.1 * BASE[friction]}))
    there = {(False, False): 10.0, (True, False): friction_alone, (True, True): 3.0}
    search.logs = cast(
        Any,
        lambda model: {"position": np.full(9, np.log(there[model[friction] != BASE[friction], LOAD in model.effects]))},
    )
    judged = search.asked(search.start, [replace(candidate(LOAD), share=0.0)])
    assert bool(judged[0].objections) == objected


def test_the_best_one_is_not_asked_if_nothing_is_objected() -> None:
    search = Played([], {})
    judged = [candidate(DROOP), replace(candidate(LOAD), share=0.0)]
    assert search.asked(search.start, judged) == judged


@pytest.mark.parametrize(("with_it", "added"), [(13.0, []), (6.01, []), (5.9, [STRIBECK])])
def test_no_effect_is_kept_with_which_predictions_get_worse(with_it: float, added: list[str]) -> None:
    """Not even one of the best score: such a one raised held-out errors from 270 to 476 noise floors."""
    assert names(Played([STRIBECK], errors(base=6.0, stribeck=with_it))) == added


@pytest.mark.parametrize(("left", "added"), [(5.8, [STRIBECK]), (1.0, [STRIBECK, LOAD])])
def test_what_breakaways_ask_for_has_to_predict_better_than_every_model_before(left: float, added: list[str]) -> None:
    search = Played([STRIBECK], errors(base=6.0, stribeck=5.9, stribeck_load=left), slipping=LOAD)
    assert names(search) == added


def test_predictions_that_noise_explains_decide_nothing() -> None:
    assert names(Played([STRIBECK], errors(base=1.05, stribeck=1.06))) == [STRIBECK]


def test_an_addition_that_the_last_refit_makes_worse_is_taken_back_with_those_after_it() -> None:
    class Settling(Played):
        """Its last refits by prediction help the base, and nothing else."""

        def settled(self, model: Model, smaller: Model | None = None) -> Model:
            return model.with_parameters({"piston.mass": 4.0}) if model.effects == BASE.effects else model

    search = Settling([LOAD, DROOP], errors(base=10.0, load=5.0, load_droop=3.0))
    whole, settled = search.logs, {"position": np.full(9, np.log(4.0))}
    search.logs = cast(Any, lambda model: settled if model["piston.mass"] == 4.0 else whole(model))
    found = search.run()
    assert found.model.effects == BASE.effects
    assert [step.added for step in found.steps] == [None]
    assert {c.refused for c in found.steps[0].candidates if c.name == LOAD} == {UNHELPFUL}


def test_the_larger_model_is_settled_from_the_values_of_the_settled_base() -> None:
    """From elsewhere its refit may end in a valley, and it would seem to predict worse."""
    asked = list[tuple[tuple[str, ...], Model | None]]()

    class Settling(Played):
        def settled(self, model: Model, smaller: Model | None = None) -> Model:
            asked.append((model.effects, smaller))
            return model.with_parameters({"piston.mass": 4.0})

    Settling([LOAD], errors(base=10.0, load=5.0)).run()
    assert [(effects == BASE.effects, smaller and smaller["piston.mass"]) for effects, smaller in asked] == [
        (True, None),
        (False, 4.0),
    ]


def test_a_search_that_never_runs_out_of_candidates_ends_and_says_so() -> None:
    class Endless(Played):
        """Each round has new candidates, and none of them helps."""

        def round(self, model: Model, refused: Mapping[str, str]) -> Step:
            found = candidate(f"{LOAD}_{len(refused)}")
            return Step(model, (found,), found, (), {}, {})

        def extended(self, model: Model, candidate: Candidate) -> tuple[Model, list[str]]:
            return model, [candidate.name]

    search = Endless([], errors(base=10.0))
    found = search.run()
    assert [step.added for step in found.steps] == [None]
    assert search.fitter.limits == [f"the search ended after {ROUNDS} rounds with candidates left to try"]


@pytest.mark.parametrize(
    ("offset", "gain", "moves"),
    [(4.0, 10.0, True), (4.0, -10.0, False), (1.0, 10.0, False)],
    ids=["far and better", "far and worse", "near"],
)
def test_candidates_are_compared_where_slopes_reach(offset: float, gain: float, moves: bool) -> None:
    """Breakaways moved a parameter by four deviations; a refit to the equations may have the larger score."""
    model, refitted = load_model("axis"), load_model("paper")
    known = SimpleNamespace(offset=lambda _: np.array([offset]))
    gains = {(id(refitted), id(model)): gain}
    fitter = SimpleNamespace(
        known=lambda _: known, refit=lambda _: refitted, gain=lambda new, old: gains[id(new), id(old)]
    )
    found = Search.unstrained(cast(Search, SimpleNamespace(fitter=fitter)), model)
    assert found is (refitted if moves else model)


def extending(**given: Any) -> Search:
    """A search that adds effects as they are, sure and worth it, unless something else is `given` of its fitter."""
    search = Played([], {})
    search.horizon, search.paying = 1.0, set()
    search.train = cast(Evidence, SimpleNamespace(runs=[SimpleNamespace(sample_time=1e-3)]))
    usual: dict[str, Any] = {
        "refit": lambda model: model,
        "extended": lambda model, h: model.with_effects([*model.effects, h.name]),
        "added": lambda model: [name for name in model.effects if name not in BASE.effects],
        "simplest": lambda model, name, horizon: model,
        "deviations": lambda model: dict.fromkeys(model.parameters, 1e-9),
        "gain": lambda new, old: 50.0,
    }
    search.fitter = cast(Fitter, SimpleNamespace(**(usual | given)))
    return search


def test_an_older_effect_is_simplified_beside_a_new_one() -> None:
    """A late position had got a low-pass of 1.4 ms before a leak was found, and kept it: its delay was 14 % off."""
    delay, low_pass = "position_sensor_delay.delay", "position_sensor_delay.low_pass"
    late = BASE.with_effects([*BASE.effects, "position_sensor_delay"], {delay: 9.1e-3, low_pass: 1.4e-3})

    def simplest(model: Model, name: str, horizon: float) -> Model:
        beside = "constant_load" in model.effects and name == "position_sensor_delay"
        return model.with_parameters({delay: 10.5e-3, low_pass: 0.0} if beside else {})

    search = extending(simplest=simplest)
    new, gone = Search.extended(search, late, candidate(LOAD))
    assert (new[delay], new[low_pass], gone) == (10.5e-3, 0.0, [])


@pytest.mark.parametrize(("low_pass", "gone"), [(0.6e-3, ["position_sensor_delay"]), (1.6e-3, [])])
def test_a_delay_that_a_refit_makes_shorter_than_a_sample_is_none(low_pass: float, gone: list[str]) -> None:
    """1.6 ms as a candidate, where a play of 0.4 mm is true: refitted they were a low-pass of 0.6 ms, and stayed."""
    values = {"position_sensor_delay.delay": 0.0, "position_sensor_delay.low_pass": low_pass}

    search = extending(simplest=lambda model, name, horizon: model.with_parameters(values))
    assert Search.extended(search, BASE, candidate("position_sensor_delay"))[1] == gone


def test_an_older_effect_is_part_of_a_new_one_that_contains_it() -> None:
    """16 N s/m both ways beside 4 and 50 N s/m: neither is determined, so that no deviation says that one is none."""
    older, newer = "viscous_friction", "asymmetric_viscous_friction"
    model = BASE.with_effects([*BASE.effects, older, LOAD])
    search = extending(deviations=lambda model: dict.fromkeys(model.parameters, np.inf))
    new, gone = Search.extended(search, model, candidate(newer))
    assert gone == [older]
    assert {*new.effects} - {*BASE.effects} == {newer, LOAD}
    new, gone = Search.extended(search, BASE.with_effects([*BASE.effects, LOAD]), candidate(newer))
    assert gone == []
    assert {*new.effects} - {*BASE.effects} == {newer, LOAD}


@pytest.mark.parametrize(("worth", "gone"), [(7.0, [LOAD]), (50.0, [])])
def test_what_breakaways_ask_for_may_replace_an_older_effect(worth: float, gone: list[str]) -> None:
    size = "constant_load.load"
    both = BASE.with_effects([*BASE.effects, LOAD, STRIBECK], {size: 1.0})
    search = extending(
        deviations=lambda model: dict.fromkeys(model.parameters, 1e-9) | {size: 0.6},
        gain=lambda new, old: worth if LOAD in new.effects and LOAD not in old.effects else 0.0,
    )
    found = Search.cleared(search, both, STRIBECK)
    assert found[1] == gone
    assert (LOAD in found[0].effects) == (not gone)


@pytest.mark.parametrize(
    ("deviation", "worth", "gone"),
    [(0.6, 7.0, True), (0.6, 50.0, False), (0.2, 50.0, False), (0.2, 7.0, True), (0.01, -689.0, True)],
)
def test_an_effect_that_is_worth_nothing_once_refitted_is_not_added(deviation: float, worth: float, gone: bool) -> None:
    """However sure its size is: slopes promised 332 nats of a load that lost 689 beside a low-pass."""
    size = "constant_load.load"

    def extended(model: Model, h: Hypothesis) -> Model:
        return model.with_effects([*model.effects, h.name], {size: 1.0})

    search = extending(
        extended=extended,
        deviations=lambda model: dict.fromkeys(model.parameters, 1e-9) | {size: deviation},
        gain=lambda new, old: worth if LOAD in new.effects and LOAD not in old.effects else 0.0,
    )
    assert (LOAD in Search.extended(search, BASE, candidate(LOAD))[1]) == gone


def test_what_an_effect_is_worth_does_not_depend_on_friction_refitted_to_breakaways() -> None:
    """Beside a dwell time that refit cost the equations 141 nats, and without it nothing."""
    size, friction = "constant_load.load", "lugre_friction.static_friction"

    def gain(new: Model, old: Model) -> float:
        return 121.0 - 141.0 * (new[friction] != BASE[friction])

    search = extending(deviations=lambda model: dict.fromkeys(model.parameters, 1e-9) | {size: 20.0}, gain=gain)
    search.polish = cast(
        Any, lambda model: model.with_parameters({friction: 1.1 * BASE[friction]}) if LOAD in model.effects else model
    )
    new, gone = Search.extended(search, BASE, candidate(LOAD))
    assert gone == []
    assert new[friction] == 1.1 * BASE[friction]


@pytest.mark.parametrize(
    ("deviation", "worth", "gone"),
    [(0.6, 7.0, True), (0.6, 50.0, False), (0.3, 50.0, False), (0.3, 7.0, True), (0.2, 7.0, False)],
    ids=["none", "each size may be none", "unsure and needed", "unsure and idle", "sure"],
)
def test_an_older_effect_is_worth_something_beside_a_new_one(deviation: float, worth: float, gone: bool) -> None:
    """A dwell time of 10 nats stood in for another Stribeck curve, and stayed when that one was found."""
    size = "constant_load.load"
    loaded = BASE.with_effects([*BASE.effects, LOAD], {size: 1.0})
    search = extending(
        deviations=lambda model: dict.fromkeys(model.parameters, 1e-9) | {size: deviation},
        gain=lambda new, old: worth if LOAD in new.effects and LOAD not in old.effects else 0.0,
    )
    found = Search.extended(search, loaded, candidate(STRIBECK))[1]
    assert (LOAD in found) == gone
