"""The answer of a diagnosis: verdict in a sentence, what was added and how well it is known, how to repeat it."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.wording import VARIABLES, amount, times
from pneumo_ros.diagnose.outcome import ADEQUATE, FOUND, UNKNOWN
from pneumo_ros.report.chart import Badge, Section
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.naming import effect_words, interval, listed, resolved, the
from pneumo_ros.report.residuals import FOLLOWS

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Addition, Outcome
    from pneumo_ros.plant import Model

ENOUGH = 1.3  # times the noise: more than noise and the estimate of a start explain


def badge(outcome: "Outcome") -> Badge:
    """The verdict in a word."""
    if outcome.verdict == ADEQUATE:
        return Badge("\N{CHECK MARK}", "Adequate", "good")
    if outcome.verdict == FOUND:
        word = "Effect found" if len(outcome.added) == 1 else f"{len(outcome.added)} effects found"
        return Badge("+", f"{word}, more remains" if outcome.unexplained else word, "found")
    return Badge("?", "Unknown effect", "unknown")


def verdict_sentence(outcome: "Outcome") -> str:
    """The whole diagnosis in one sentence, two where something remains."""
    name = outcome.model.name
    if outcome.verdict == ADEQUATE:
        return f"Once its parameters are refitted, '{name}' lacks nothing of size that these recordings show."
    found = f"'{name}' lacks {listed([_with_rivals(one) for one in outcome.added])}. " if outcome.added else ""
    if outcome.because:
        off = f"No effect of the catalogue explains that, {outcome.because}."
        return f"{found}{_remaining(outcome)} {off}" if outcome.unexplained else found + off
    return found + (_remaining(outcome) if outcome.unexplained else _fall(outcome))


def _with_rivals(one: "Addition") -> str:
    rivals = [effect_words(name) for name in one.indistinguishable_from]
    return effect_words(one.effect) + (f" (or {listed(rivals, 'or')})" if rivals else "")


def _remaining(outcome: "Outcome") -> str:
    """What no effect of the catalogue explains."""
    left = outcome.unexplained
    assert left is not None
    ratio = outcome.after.equations[left.equation].ratio_to_noise
    what = f"{amount(left.rms, left.equation)} rms, {times(ratio)} the noise"
    beside = {0: "S", 1: "Beside it, s"}.get(len(outcome.added), "Beside them, s")
    return (
        f"{beside}omething that no effect of the catalogue explains is at work in {the(left.equation)}: "
        f"{what}{follows(outcome)}."
    )


def follows(outcome: "Outcome") -> str:
    """', following position' where a variable explains a share worth naming."""
    left = outcome.unexplained
    if left is None or left.share < FOLLOWS:
        return ""
    return f", following {VARIABLES[left.against][0]}"


def _fall(outcome: "Outcome") -> str:
    """How the equation that failed worst improved."""
    judged = [name for name in outcome.failing if name in outcome.before.equations]
    if not judged:
        return ""
    worst = max(judged, key=lambda name: outcome.before.equations[name].ratio_to_noise)
    before, after = (one.equations[worst].ratio_to_noise for one in (outcome.before, outcome.after))
    with_it = "With it" if len(outcome.added) == 1 else "With them"
    return (
        f"{with_it}, the residual of {the(worst)} on recordings that were never fitted falls from "
        f"{times(before)} to {times(after)} the noise."
    )


def answer_section(outcome: "Outcome", origin: dict[str, Any]) -> Section:
    """What was added, what to beware of, and the command line that repeats it."""
    parts = (*(_addition(one, outcome.model) for one in outcome.added), _repeat(outcome, origin))
    body = tag("ul", [tag("li", text) for text in notes(outcome)], class_="notes")
    return Section("answer", "Answer", body, parts=parts)


def notes(outcome: "Outcome") -> list[str]:
    """What was judged, and what the verdict does not say."""
    found = []
    if outcome.interrupted:
        found.append("The search was interrupted: this is what it had found by then.")
    if outcome.failing:
        names = listed([the(name) for name in outcome.failing])
        found.append(f"After the refit alone, this fails: {names}.")
    else:
        found.append("After the refit alone, no equation fails: what the model has is enough.")
    if not outcome.added:
        found.append("No effect was added: none of the catalogue passed every test (see the evidence).")
    elif outcome.verdict != UNKNOWN and outcome.unexplained is None:
        found.append("What remains in every equation is noise, or too little to be worth an effect.")
    last = outcome.waterfall[-1][1]
    if last > ENOUGH:
        found.append(
            f"Held-out recordings predicted over {outcome.after.horizon:g} s are still {times(last)} the noise floor "
            "off (see the held-out error)."
        )
    return found


def _addition(one: "Addition", model: "Model") -> Section:
    """An added effect: how it shows, its parameters with intervals, its rivals."""
    effect = model.library.find(one.effect)
    rows: list[tuple[Content, ...]] = []
    for key, value in one.parameters.items():
        dotted = f"{one.effect}.{key}"
        known = model.specification(dotted)
        span = interval(value.value, value.std, known.low, known.high)
        number = tag("strong", resolved(value.value, value.std))
        rows.append((known.meaning, tag("code", dotted), number, span, value.unit))
    hints = {"Shows as": effect.signature, "Source": effect.source}
    parts = [tag("p", " ".join(f"{word}: {text}." for word, text in hints.items() if text), class_="soft")]
    if rows:
        head = ("parameter", "in the machine file", "value", "95 % interval", "unit")
        parts.append(table(head, rows, f"Parameters of {effect_words(one.effect)}", numeric=(2,)))
    if one.indistinguishable_from:
        rivals = listed([effect_words(name) for name in one.indistinguishable_from], "or")
        text = f"These recordings cannot tell it from {rivals}: any of them would explain what was seen as well."
        parts.append(tag("p", tag("span", "not alone", class_="chip rival"), " ", text))
    return Section(f"added-{one.effect}", f"+ {effect_words(one.effect)}", Html("".join(parts)))


def _repeat(outcome: "Outcome", origin: dict[str, Any]) -> Section:
    """The command line, and the recordings on both sides."""
    made = f"Made by pneumo_ros {origin['versions']['pneumo_ros']} on {origin['created']}; files and their hashes: "
    body = (
        tag("pre", tag("code", origin["command"])),
        tag("p", tag("b", f"Fitted ({len(outcome.train)}): "), ", ".join(outcome.train)),
        tag("p", tag("b", f"Held out, never fitted ({len(outcome.held)}): "), ", ".join(outcome.held)),
        tag("p", made, tag("a", "Origin", href="#origin"), ".", class_="soft"),
    )
    return Section("repeat", "To repeat it", Html("".join(body)))
