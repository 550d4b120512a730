"""The answer of a diagnosis: added effects with their intervals, equations that failed before, how to repeat it."""

from typing import TYPE_CHECKING, Any, Literal

from pneumo_ros.diagnose.outcome import ADEQUATE, FOUND, UNKNOWN
from pneumo_ros.report.chart import Badge, Section
from pneumo_ros.report.markup import Content, Html, table, tag, worded
from pneumo_ros.wording.additions import AdditionWords
from pneumo_ros.wording.diagnosis import DiagnosisWords

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Outcome
    from pneumo_ros.plant import Model

Tone = Literal["good", "found", "unknown"]
SIGNS: dict[str, tuple[str, Tone]] = {
    ADEQUATE: ("\N{CHECK MARK}", "good"),
    FOUND: ("+", "found"),
    UNKNOWN: ("?", "unknown"),
}


def badge(said: DiagnosisWords) -> Badge:
    """The verdict in a word, with its sign and tone."""
    sign, tone = SIGNS[said.verdict]
    return Badge(sign, said.badge, tone)


def notes(said: DiagnosisWords) -> Html:
    """Notes on the verdict as a list, and the equations before anything was added."""
    listed = tag("ul", [tag("li", text) for text in (*said.notes, said.moved)], class_="notes")
    moved = worded(said.moved_table, "Parameters that the refit moved") if said.moved_table else Html()
    return Html(listed + moved + worded(said.equations))


def answer_section(said: DiagnosisWords, outcome: "Outcome", origin: dict[str, Any]) -> Section:
    """The added effects, the notes, and the command line that repeats the diagnosis."""
    parts = (*(addition_section(one, outcome.model) for one in said.added), _repeat(outcome, origin))
    return Section("answer", "Answer", notes(said), parts=parts)


def addition_section(one: AdditionWords, model: "Model | None" = None) -> Section:
    """An added effect: how to recognise it (catalogue of `model`), its parameters with intervals, its rivals."""
    rows: list[tuple[Content, ...]] = [
        (p.meaning, tag("code", p.name), tag("strong", p.value), p.interval, p.unit) for p in one.parameters
    ]
    parts = [_hints(one.effect, model) if model else Html()]
    parts.append(tag("p", f"Held-out error {one.error}; {one.nats} nats."))
    if rows:
        head = ("parameter", "in the machine file", "value", "95 % interval", "unit")
        parts.append(table(head, rows, f"Parameters of {one.effect}", numeric=(2,)))
    if one.rivals:
        parts.append(tag("p", tag("span", "not alone", class_="chip rival"), " ", one.rivals))
    return Section(f"added-{one.effect}", f"+ {one.effect}", Html("".join(parts)))


def _hints(effect: str, model: "Model") -> Html:
    known = model.library.find(effect)
    hints = {"Shows as": known.signature, "Source": known.source}
    return tag("p", " ".join(f"{word}: {text}." for word, text in hints.items() if text), class_="soft")


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
