"""The search for what a model lacks: refit, rank, try, add, repeat; then remove what does not improve predictions."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.blas import on_one_thread
from pneumo_ros.diagnose.basefit import strain, unaided
from pneumo_ros.diagnose.candidate import MATERIAL, RESOLVED, Candidate
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis, family_scales
from pneumo_ros.diagnose.judging import (
    NONE_WITHIN,
    best_forms,
    by_score,
    freedom,
    judged,
    lag_in,
    size_in,
    undetermined,
)
from pneumo_ros.diagnose.measures import force, unexplained_force
from pneumo_ros.diagnose.polishing import longest, polish
from pneumo_ros.diagnose.prediction import (
    no_worse,
    pays,
    recordings,
    removed,
    typical_error,
    usual_errors,
    window_logs,
    windowed,
)
from pneumo_ros.diagnose.refining import held_out, refine
from pneumo_ros.diagnose.rivals import rivals, simplest, twins
from pneumo_ros.diagnose.score import MARGIN, occam
from pneumo_ros.diagnose.screening import FINALISTS, SHORTLIST, STRAINED, screen, shortlist
from pneumo_ros.diagnose.slip_candidates import longer
from pneumo_ros.diagnose.slips import polished, slips, with_values_of
from pneumo_ros.diagnose.steps import Found, Step, without
from pneumo_ros.diagnose.strain import followed
from pneumo_ros.diagnose.timing import lateness, later
from pneumo_ros.diagnose.unseen import unseen
from pneumo_ros.diagnose.verdict import rises
from pneumo_ros.errors import OutOfTimeError
from pneumo_ros.heap import share_one_heap
from pneumo_ros.plant import Model
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.physical import COULOMB, STATIC, physical
from pneumo_ros.shooting.windows import fitting_horizon

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

TEXTURE = 0.01  # of the drive force: a larger force that is unexplained acts at breakaways, too
MOST_EFFECTS, ROUNDS = 4, 40  # effects added, and rounds: each tries one of at most eight candidates beside five models
ENOUGH = 40  # segments: what is found along the signals needs few more
VANISHED = "its size vanishes once all parameters are refitted"
UNHELPFUL = "predictions of held-out runs over 1 s do not improve with it"


@dataclass(frozen=True)
class Ranking:
    """The candidates for one model: their starting point, those judged, best first, and the first ranking of all."""

    base: BaseFit
    held: BaseFit
    candidates: list[Candidate]
    screened: list[Hypothesis]
    quiet: bool  # whether no significant force is unexplained


class Search:
    """The data and settings that do not change during one search."""

    def __init__(
        self, model: Model, train: Sequence[Run], held: Sequence[Run], progress: Progress | None = None,
        horizon: float | None = None,
    ) -> None:  # fmt: skip
        """`horizon` [s]: length of the windows in which runs are predicted, as in `fitting_horizon`."""
        share_one_heap()
        self.progress = progress or (lambda share, text: None)
        runs = on_one_clock([*train, *held])
        train, held = runs[: len(train)], runs[len(train) :]
        self.horizon = fitting_horizon(runs, horizon)
        self.late = lateness(model, train)  # s
        train, held = ([later(run, self.late) for run in runs] for runs in (train, held))
        self.fitter = Fitter(model, train, held)
        self.start, self.train, self.held = model, self.fitter.train, self.fitter.held
        self.recordings = recordings(self.held.runs, self.horizon)
        self.paying = set[str]()  # effects below the usual size that predictions gain by
        # results are kept, as they are needed again
        self.refit, self.polish = lru_cache(2)(self.fitter.refit), lru_cache(2)(self._polish)
        self.logs = lru_cache(16)(lambda model: window_logs(model, self.held.runs, self.horizon))
        self.imposed = any(run.imposed for run in (*train, *held))  # then no motion is predicted
        self.slips = lru_cache(1)(lambda model: None if self.imposed else slips(model, self.train.runs, self.held.runs))
        self.ranking = lru_cache(2)(self._rank)

    def predicted(self, model: Model) -> dict[str, float]:
        """By signal, the usual error over noise with which `model` predicts the held-out runs."""
        return usual_errors(self.logs(model))

    def rises(self, before: Model, after: Model) -> bool:
        """Whether predictions of the held-out runs get worse from one model to another."""
        return rises(self.logs(before), self.logs(after), self.recordings)

    @on_one_thread()
    def run(self, until: AbstractContextManager[None] | None = None) -> Found:
        """Add effects one after another while they pass every test; what was found by then if interrupted.

        `until` may interrupt the search by OutOfTimeError.
        """
        base = model = self.start
        steps, vanished = list[Step](), dict[str, str]()
        refused = vanished  # with this model: another model may need them
        back: tuple[Step, Model, list[str]] | None = None  # the best of those that predictions refuse, and its model
        try:
            with until or nullcontext():
                self.progress(0.05, "refitting the model as given")
                base = model = self.polish(self.fitter.refit(self.start))
                least = self.predicted(base)  # of all models so far: a correction of an added law is no effect
                for _ in range(ROUNDS):
                    k = len(model.effects) - len(base.effects)
                    self.progress(0.1 + 0.15 * k, f"ranking {'further ' if k else ''}candidates")
                    step = self.round(model, refused)
                    if step.added is None or k == MOST_EFFECTS:
                        two = self.both(*back, vanished, least) if back and k + 2 <= MOST_EFFECTS else None
                        if two is None:
                            steps.append(replace(step, added=None))
                            break
                        made, new, gone = two
                    else:
                        self.progress(0.2 + 0.15 * k, f"adding {step.added.name}")
                        new, gone = self.extended(model, step.added)
                        if step.added.name in gone or self.rises(model, new):
                            why = VANISHED if step.added.name in gone else UNHELPFUL
                            refused = refused | {step.added.name: why}
                            back = back or (step, new, gone)
                            continue
                        made = [step]
                    vanished = vanished | dict.fromkeys(gone, VANISHED)
                    refused, back = vanished, None
                    steps = [without(s, gone, VANISHED) for s in (*steps, *made)]
                    model = new
                    least = {name: min(least[name], error) for name, error in self.predicted(new).items()}
                else:
                    self.fitter.limits.append(f"the search ended after {ROUNDS} rounds with candidates left to try")
                    steps.append(replace(self.round(model, refused), added=None))
                self.progress(0.85, "judging breakaways and reversals")
                new, last = self.slip_round(model)
                if last is not None and last.added is not None and pays(least, self.predicted(new)):
                    model, gone = self.cleared(new, last.added.name)
                    steps[-1:] = [last, replace(steps[-1], model=model)]
                    steps = [without(s, gone, VANISHED) for s in steps]
                settled = self.settled(base)
                return self.kept(settled, self.settled(model, settled), steps)
        except KeyboardInterrupt as stop:
            steps = [step for step in steps if step.added is None or step.added.name in model.effects]
            late = isinstance(stop, OutOfTimeError)
            return Found(base, model, tuple(steps), interrupted=not late, deadline=late)

    def kept(self, base: Model, model: Model, steps: Sequence[Step]) -> Found:
        """The result, without the first addition with which predictions get worse and all later ones.

        An intermediate model is settled like the base and the final model before it is judged worse than them. That of
        a joint round is not judged: it is kept, or not, with the next one.
        """
        steps, before = list(steps), base
        for k in (k for k, step in enumerate(steps) if step.added is not None):
            final = not any(step.added for step in steps[k + 1 :])
            if steps[k].joint and not final:
                continue
            if not final and self.rises(before, steps[k + 1].model):
                steps[k + 1] = replace(steps[k + 1], model=self.settled(steps[k + 1].model, base))
            after = model if final else steps[k + 1].model
            if self.rises(before, after):
                first = k - 1 if k and steps[k - 1].joint else k
                last = without(steps[first], [step.added.name for step in steps[first:] if step.added], UNHELPFUL)
                return Found(base, steps[first].model if first else base, (*steps[:first], last))
            before = after
        return Found(base, model, tuple(steps))

    def extended(self, model: Model, candidate: Candidate) -> tuple[Model, list[str]]:
        """The refitted model with an effect added, without the effects whose size vanishes, and their names.

        An older effect that the new one contains is part of it from then on.
        """
        parts = [n for n in self.fitter.added(model) if n in model.library.find(candidate.name).contains]
        new = self.fitter.extended(model, candidate.hypothesis)
        new = self.refit(new.with_effects([n for n in new.effects if n not in parts]))
        for name in self.fitter.added(new):  # beside the new effect, older ones may explain as much by less
            new = self.fitter.simplest(new, name, self.horizon)
        std = self.fitter.deviations(new)
        added = self.fitter.added(new)
        idle = [n for n in added if self.idle(new, n, std, newest=candidate.name)]
        new = self.polish(new)
        small = [n for n in added if size_in(new, n) < MATERIAL and n not in self.paying]
        short = [n for n in added if lag_in(new, n, self.train.runs[0].sample_time) < RESOLVED]
        gone = [n for n in added if n in {*small, *short, *idle}]
        if gone:
            new = self.polish(self.fitter.refit(new.with_effects([n for n in new.effects if n not in gone])))
        return new, [*parts, *gone]

    def both(
        self, first: Step, alone: Model, gone: list[str], refused: Mapping[str, str], least: Mapping[str, float]
    ) -> tuple[list[Step], Model, list[str]] | None:
        """The round of an effect that predictions refuse, and the next one, their model, and what is gone.

        While two effects are missing, the right one alone may predict worse than a model whose errors make up for each
        other. So where no effect can be added alone, the two are, if both together predict better than every model
        before (`least`). alone, gone: as `extended` by the first one.
        """
        assert first.added is not None
        if first.added.name in gone:
            return None
        self.progress(0.8, f"adding {first.added.name} and another")
        second = self.round(alone, {**refused, **dict.fromkeys(gone, VANISHED)})
        if second.added is None:
            return None
        new, more = self.extended(alone, second.added)
        if not {first.added.name, second.added.name}.isdisjoint(more) or not pays(least, self.predicted(new)):
            return None
        return [replace(first, joint=True), second], new, [*gone, *more]

    def cleared(self, model: Model, newest: str) -> tuple[Model, list[str]]:
        """The model without older effects that are worth nothing beside the `newest`, which breakaways asked for.

        And their names: a Stribeck curve of 25 nats had stood in for a lag of the film.
        """
        older = [name for name in self.fitter.added(model) if name != newest]
        larger = self.refit(model) if older else model
        std = self.fitter.deviations(larger) if older else {}
        gone = [name for name in older if self.idle(larger, name, std)]
        if not gone:
            return model, gone
        return self.polish(self.refit(larger.with_effects([n for n in larger.effects if n not in gone]))), gone

    def idle(self, model: Model, name: str, std: Mapping[str, float], newest: str = "") -> bool:
        """Whether an effect of a model, as refitted to the equations, is worth less there than is asked of an effect.

        The `newest` one is asked, as its score was that of slopes: beside a low-pass of the position an overdamped load
        of 332 nats by slopes lost 689. Of others, only an effect whose sizes, over their deviations `std`, leave that
        open is taken out to see what it is worth: an exponent and a tail of one Stribeck curve may each be none, and
        together be worth 70 nats. Friction that was refitted to breakaways suits the equations less: by 141 nats beside
        a dwell time of 121, while that without it was left as it was.
        """
        beyond = NONE_WITHIN if name in self.paying else float(np.sqrt(2.0 * MARGIN))
        asked = name == newest and name not in self.paying
        if not asked and not undetermined(model, name, std, within=beyond):
            return False
        bare = self.refit(model.with_effects([n for n in model.effects if n != name]))
        return self.fitter.gain(model, bare) < MARGIN

    def _polish(self, model: Model) -> Model:
        """The model with friction refitted to breakaways and reversals, on which predictions depend.

        On a force-driven axis only where predictions get no worse, as no pressures limit its motion.
        """
        made = self.slips(model)
        if made is None:
            return model
        deviations = self.fitter.deviations(model)
        new = with_values_of(model, polished(*made, deviations, self.fitter.added(model), self.fitter.limits))
        names = [name for name in (STATIC, COULOMB) if name in new.parameters]
        values = physical(new, names, np.array([new[name] for name in names]))
        new = new.with_parameters(dict(zip(names, values.tolist(), strict=True)))
        better = not model.force_driven or self._no_worse(new, model, self.train.runs, self.horizon)
        return new if better else model

    def settled(self, model: Model, smaller: Model | None = None) -> Model:
        """The model refitted by prediction of segments, where nothing else determines the balance of forces.

        That is on recordings with too few breakaways, and on force-driven axes, whose motion no pressures limit; and
        only where predictions of training and held-out runs get no worse. The refit starts at the values of a `smaller`
        model that was settled: from elsewhere it may end in a valley, and the larger model would seem to predict worse.
        In a position loop, whose equations are biased, it starts at the values of the machine file as well, the better
        fit counts, and it is judged as it was made, by whole recordings.
        """
        if self.imposed or (not model.force_driven and self.slips(model) is not None):
            return model
        self.progress(0.9, "refitting by prediction")
        begins = [with_values_of(model, smaller)] if smaller else []
        if not model.self_driven:  # segments alone bias the parameters
            begins, sure = begins or [model], self.fitter.deviations(model)
        else:  # the drive follows the measured position, whose errors bias the equations
            begins, sure = [*begins, self.fitter.as_given(model)], {}
        fits = [polish(self.fitter, begin, self.train.runs, ENOUGH, sure=sure) for begin in begins]
        new = min(fits, key=lambda fit: fit.costs[-1]).model
        if model.self_driven:
            runs = [*self.train.runs, *self.held.runs]
            whole = longest(runs) * runs[0].sample_time
            better = all(self._no_worse(new, model, some, whole) for some in (self.train.runs, self.held.runs))
        else:
            better = self._no_worse(new, model, self.train.runs, self.horizon)
            better = better and no_worse(self.predicted(model), self.predicted(new))
        return new if better else model

    def _no_worse(self, new: Model, old: Model, runs: Sequence[Run], horizon: float) -> bool:
        """Whether one model predicts no signal of the runs worse than another, in windows of `horizon` [s]."""
        return no_worse(*(windowed(one, runs, horizon) for one in (old, new)))

    def slip_round(self, model: Model) -> tuple[Model, Step | None]:
        """The model with the effect that only breakaways and reversals show, if they need one, and the round.

        Not where a significant force is unexplained while the piston slides: it acts at breakaways, too.
        """
        made, ranking = self.slips(model), self.ranking(model)
        if made is None or not made[1].judge or not ranking.quiet:
            return model, None
        first = model.effects == self.start.effects
        against = partial(self.fitter.against, model)
        known, unknown = self.fitter.deviations(model), unexplained_force(self.train, ranking.base.residual)
        return longer(model, made, ranking.screened, known, against, first, self.fitter.limits, unknown)

    def round(self, model: Model, refused: Mapping[str, str]) -> Step:
        """The candidates tried with a model, and the best that is not `refused` (name: reason)."""
        ranking = self.ranking(model)
        base, held = ranking.base, ranking.held
        candidates = [replace(t, refused=refused.get(t.name, "")) for t in ranking.candidates]
        candidates = self.asked(model, candidates)
        candidates = self.told_apart(ranking, candidates)
        best = simplest(base, held, candidates)
        others = rivals(base, held, best, candidates) if best else []
        scales = [_scales(self.held, residual) for residual in (held.residual, best.held if best else held.residual)]
        blind = {} if best else self.unseen(model, ranking)
        return Step(model, tuple(candidates), best, tuple(others), scales[0], scales[1], blind)

    def told_apart(self, ranking: Ranking, candidates: list[Candidate]) -> list[Candidate]:
        """The candidates; those that change the same as the best one have the score of the model refitted with them."""
        alike = twins(ranking.held, candidates)
        if len(alike) < 2:
            return candidates
        reached = self.fitter.evidences(ranking.base.model, [one.hypothesis for one in alike])
        nats = [n - occam(ranking.base, one.hypothesis) for n, one in zip(reached, alike, strict=True)]
        scores = {
            one.name: replace(one.score, train=alike[0].score.nats + own - nats[0] - one.score.held)
            for one, own in zip(alike, nats, strict=True)
        }
        return by_score([replace(one, score=scores.get(one.name, one.score)) for one in candidates])

    def asked(self, model: Model, candidates: list[Candidate]) -> list[Candidate]:
        """The candidates; what the best one is worth in predictions, if its size or its share alone is objected to.

        What is slow for the usual machine, or less than a texture, hardly shows in windows of an equation, and adds up
        over a second. Both models have friction refitted to breakaways, on which predictions depend. A refit may end in
        another valley, which is no merit of the candidate: so it must predict better than that friction without it,
        too. Once effects are added, an inexact law of theirs may make another one the best: so all are asked, until
        one pays.
        """
        for k, one in enumerate(candidates):
            if not one.objections:
                break
            if replace(one, pays=1.0).objections or one.name in self.paying:
                continue
            new = self.polish(self.refit(self.fitter.extended(model, one.hypothesis)))
            alone = new.with_effects([name for name in new.effects if name != one.name])
            before = min(map(self.predicted, (model, alone)), key=typical_error)
            tried = replace(one, pays=removed(before, self.predicted(new)))
            candidates = [*candidates[:k], tried, *candidates[k + 1 :]]
            if not tried.objections:
                self.paying.add(one.name)
            if one.first or not tried.objections:
                break
        return candidates

    def unseen(self, model: Model, ranking: Ranking) -> dict[str, float]:
        """Effects that the recordings cannot show, without those that contain one of the model: it stands for them."""
        found = unseen(ranking.screened)
        return {n: nats for n, nats in found.items() if not {*model.effects} & {*model.library.find(n).contains}}

    def _rank(self, model: Model) -> Ranking:
        """Rank all candidates on the training runs, try the best on the held-out ones."""
        base, held = self.fitter.fits(self.fitter.shaped(self.unstrained(model)))
        nothing = unaided(base)
        held = replace(held, residual=held.residual + held.slopes @ nothing.shift)
        hypotheses, screened = self.hypotheses(base)
        candidates = self.judged(base, held, nothing, hypotheses, screened)
        quiet = force(self.held, held.residual, np.zeros(len(self.held))) <= TEXTURE * self.held.drive
        return Ranking(base, held, candidates, screened, quiet)

    def unstrained(self, model: Model) -> Model:
        """The model, or refitted to the equations if its parameters are far from what is known and the score is larger.

        Breakaways may have moved them; the slopes by which candidates are compared do not reach so far.
        """
        if strain(self.fitter.known(model).offset(model)) < STRAINED:
            return model
        new = self.fitter.refit(model)
        return new if self.fitter.gain(new, model) > 0.0 else model

    def hypotheses(self, base: BaseFit) -> tuple[list[Hypothesis], list[Hypothesis]]:
        """The best candidates fitted to all training runs, and the first ranking of all, by part of them."""
        part = self.fitter.ranking_fit(base.model)
        screened, bare = screen(part), unaided(part)
        fitted = sorted(
            refine(part, shortlist(part, bare, screened, SHORTLIST)), key=lambda h: freedom(part, h) - h.likelihood
        )
        return refine(base, shortlist(part, bare, fitted, FINALISTS), iterations=2, settled=True), screened

    def judged(
        self,
        base: BaseFit,
        held: BaseFit,
        nothing: Hypothesis,
        hypotheses: Sequence[Hypothesis],
        screened: Sequence[Hypothesis],
    ) -> list[Candidate]:
        """Candidates of the hypotheses, and of effects that strained base parameters may replace."""
        first = base.model.effects == self.start.effects
        candidates = judged(base, held, hypotheses, held_out(base, held, hypotheses), nothing, first)
        good = [candidate.name for candidate in candidates if not candidate.objections]
        relieving = followed(self.fitter, base, screened, nothing.relief, good)
        return best_forms(candidates + judged(base, held, *relieving, nothing, first))


def _scales(evidence: Evidence, residual: Array) -> dict[str, float]:
    return dict(zip(evidence.names, family_scales(evidence, residual).tolist(), strict=True))
