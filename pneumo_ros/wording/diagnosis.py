"""A diagnosis in words, as data: everything that terminal, report and workbench show."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneumo_ros.compare.wording import EQUATIONS, amount, number, times
from pneumo_ros.diagnose.outcome import ADEQUATE, UNKNOWN
from pneumo_ros.wording.additions import AdditionWords, additions, with_rivals
from pneumo_ros.wording.answers import AnswerWords, answers, at_the_machine
from pneumo_ros.wording.candidates import REASONS, CandidateWords, candidates, foremost
from pneumo_ros.wording.errors import StepWords, signals_table, steps
from pneumo_ros.wording.moved import moved_sentence, moved_table
from pneumo_ros.wording.naming import counted, equation_words, listed, sentence, the
from pneumo_ros.wording.remains import leaves, remains
from pneumo_ros.wording.table import Table


@dataclass(frozen=True)
class DiagnosisWords:
    """The words of a diagnosis, in the order in which they are read."""

    verdict: str  # as in the JSON
    badge: str  # the verdict in a word or two
    headline: str  # the verdict in a sentence, with the held-out error
    answers: tuple[AnswerWords, ...]  # a line for each added effect
    doing: tuple[str, ...]  # what to do at the machine
    notes: tuple[str, ...]
    equations: Table  # of the refitted model, before anything was added
    added: tuple[AdditionWords, ...]
    steps: tuple[StepWords, ...]
    signals: Table
    candidates: tuple[CandidateWords, ...]
    remains: tuple[str, ...]
    moved: str
    moved_table: Table | None
    experiment: str  # what to record next; may be empty
    horizon: float  # s, of the predicted windows

    def sentences(self) -> tuple[str, ...]:
        """Every sentence and reason that terminal, report and workbench must each show."""
        reasons = (reason for one in foremost(self.candidates) for reason in one.reasons[:REASONS])
        every = (
            self.headline, *self.doing, *self.notes, *(one.rivals for one in self.added), *reasons, *self.remains,
            self.moved, self.experiment,
        )  # fmt: skip
        return tuple(text for text in every if text)


def diagnosis(result: Mapping[str, Any]) -> DiagnosisWords:
    """The words of a diagnosis; `result` is the JSON of `diagnose`, of plain types."""
    effects = [one["effect"] for one in result["added"]]
    horizon, heads = result["horizon_s"], {"before": "refitted"} | ({"after": "final model"} if result["added"] else {})
    return DiagnosisWords(
        verdict=result["verdict"],
        badge=badge(result),
        headline=headline(result),
        answers=answers(result),
        doing=at_the_machine(result),
        notes=notes(result),
        equations=equations_table(result),
        added=additions(result["added"]),
        steps=steps([(one["model"], one["holdout_error"]) for one in result["course"]]),
        signals=signals_table(result["holdout"], heads, f"{horizon:g} s, rms over the held-out recordings"),
        candidates=candidates(result),
        remains=(*remains(result), *unseen(result)),
        moved=moved_sentence(result["refit"], effects),
        moved_table=moved_table(result["refit"], effects),
        experiment=result["suggested_experiment"],
        horizon=horizon,
    )


def unseen(result: Mapping[str, Any]) -> tuple[str, ...]:
    """A sentence for each experiment that would show effects which these recordings cannot show."""
    by_experiment: dict[str, list[str]] = {}
    for one in result.get("cannot_say", ()):
        by_experiment.setdefault(one["experiment"], []).append(one["effect"])
    return tuple(
        f"These recordings cannot show whether there is {listed(effects, 'or')}; to see it: {experiment}."
        for experiment, effects in by_experiment.items()
    )


def badge(result: Mapping[str, Any]) -> str:
    """The verdict in a word or two."""
    if result["verdict"] == ADEQUATE:
        return "Adequate"
    if result["verdict"] == UNKNOWN:
        return "Unknown effect"
    word = "Effect found" if len(result["added"]) == 1 else f"{len(result['added'])} effects found"
    return f"{word}, more remains" if result["unexplained"] else word


def headline(result: Mapping[str, Any]) -> str:
    """The verdict in a sentence, after a note if the search was interrupted or ran out of time."""
    if not (result["interrupted"] or result["deadline"]):
        return _verdict(result)
    rounds = result["rounds"]
    done = f"after {counted(rounds, 'round')} of the search" if rounds else "before any effect was tried"
    none = f"No effect had been added to '{result['model']}'; {_error(result)}."
    found = _verdict(result) if result["added"] else none
    stopped = "OUT OF TIME" if result["deadline"] else "INTERRUPTED"
    return f"{stopped} {done}; this is what had been found by then. {found}"


def _verdict(result: Mapping[str, Any]) -> str:
    model, names = result["model"], listed([with_rivals(one) for one in result["added"]])
    if result["verdict"] == ADEQUATE:
        good = f"'{model}' is adequate: with its parameters refitted, these recordings show nothing missing"
        return f"{good}; {_error(result)}."
    if result["verdict"] == UNKNOWN:
        besides = f"{names}, and besides " if result["added"] else ""
        why = "; ".join([*_reasons(result), _error(result)])
        return f"'{model}' lacks {besides}something that no known effect explains: {why}."
    with_it = "with it" if len(result["added"]) == 1 else "with them"
    return f"'{model}' lacks {names}: {with_it}, {_error(result)}."


def _reasons(result: Mapping[str, Any]) -> list[str]:
    """Reasons for the verdict 'unknown effect': the residual of an equation, and predictions that fail."""
    left = result["unexplained"]
    found = [leaves(result)] if left and left["material"] else []
    return [*found, *([result["because"]] if result.get("because") else [])]


def _error(result: Mapping[str, Any]) -> str:
    """The headline number: the held-out error, and what it was before effects were added."""
    after = result["course"][-1]["holdout_error"]
    if not result["added"]:
        return f"the held-out error is {times(after)} the noise floor"
    before = result["added"][0]["holdout_error_before"]
    way = "falls" if after < before else "goes"
    return f"the held-out error {way} from {times(before)} to {times(after)} the noise floor"


def notes(result: Mapping[str, Any]) -> tuple[str, ...]:
    """Equations that fail after the refit alone, whether effects were added, and the delay of a measured force."""
    failing = [the(name) for name in result["failing"] if name in EQUATIONS]
    places = [the(name) for name in result["failing"] if name not in EQUATIONS]
    verb = "fails" if len(failing) == 1 else "fail"
    found = [
        f"{sentence(listed(failing))} {verb} after the refit alone."
        if failing
        else "After the refit alone, no equation fails.",
        f"What was added acts in {listed(places)}." if places else "",
        "" if result["added"] else "No effect was added: no candidate passed every test.",
        delayed(result["input_delay_s"]),
    ]
    return tuple(text for text in found if text)


def delayed(late: float) -> str:
    """By how much [s] a measured force was delayed, if it was."""
    return (
        f"Positions come {number(1e3 * late, 2)} ms after the force; the force was delayed by as much." if late else ""
    )


def equations_table(result: Mapping[str, Any]) -> Table:
    """The verdict on each equation of the refitted model, before anything is added."""
    rows = []
    for name, judged in result["equations"]["before"].items():
        size, ratio = amount(judged["residual_rms"], name), times(judged["ratio_to_noise"])
        rows.append((equation_words(name), size, ratio, judged_words(judged, name in result["failing"])))
    count = counted(len(result["held_out"]), "recording")
    title = f"'{result['model']}' with its parameters refitted, on {count} held out"
    return Table(title, ("equation", "residual", "/ noise", "verdict"), tuple(rows), (1, 2))


def judged_words(judged: Mapping[str, Any], fails: bool) -> str:
    """The verdict on an equation; `judged` is its entry in the JSON."""
    if judged["explained_by_noise"] is None:
        return "not judged: nothing slides"
    if fails:
        return "FAILS"
    return "explained by noise" if judged["explained_by_noise"] else "more than noise, too little to matter"
