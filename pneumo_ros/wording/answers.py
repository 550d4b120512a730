"""The answer of a diagnosis on one page: what is missing, its size, how sure that is, what to do at the machine."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneumo_ros.compare.wording import times
from pneumo_ros.diagnose.outcome import ADEQUATE, UNKNOWN
from pneumo_ros.diagnose.score import MARGIN
from pneumo_ros.wording.additions import ParameterWords, parameter
from pneumo_ros.wording.naming import NORMAL, listed
from pneumo_ros.wording.table import Table

MANY, SHOWN = 6, 3  # sizes of an effect that are listed each, as only a profile has more than four; and of a profile

# equation -> the parts of the machine that it describes
PLACES = {
    "momentum": "piston, rod, guide and load",
    "chamber_a": "chamber a, its hose and its port of the valve",
    "chamber_b": "chamber b, its hose and its port of the valve",
}


@dataclass(frozen=True)
class AnswerWords:
    """One added effect: its size with the 95 % interval, how sure it is, and how a person recognises it."""

    effect: str
    size: str
    sure: str
    shows: str  # empty for an effect that does not say


def answers(result: Mapping[str, Any]) -> tuple[AnswerWords, ...]:
    """A line for each addition in the JSON of `diagnose`."""
    return tuple(_answer(one) for one in result["added"])


def _answer(one: Mapping[str, Any]) -> AnswerWords:
    effect = str(one["effect"])
    return AnswerWords(effect, _sizes(effect, one["parameters"]), _sure(one), one.get("signature", ""))


def _sizes(effect: str, parameters: Mapping[str, Any]) -> str:
    """Each size; of the many of a profile the largest that are not zero, and where they are."""
    if len(parameters) <= MANY:
        return "; ".join(_size(parameter(effect, key, one)) for key, one in parameters.items()) or "no parameter"
    sure = [(key, one) for key, one in parameters.items() if one["std"] and abs(one["value"]) > NORMAL * one["std"]]
    if not sure:
        return f"{len(parameters)} coefficients, each of which may be 0"
    largest = sorted(sure, key=lambda item: -abs(item[1]["value"]))[:SHOWN]
    each = "; ".join(_size(parameter(effect, key, one), one.get("meaning", "")) for key, one in largest)
    return f"{len(sure)} of {len(parameters)} coefficients are not 0; the largest: {each}"


def _size(one: ParameterWords, called: str = "") -> str:
    """'conductance 3.0e-10 kg/(s Pa) (95 %: 2.9e-10 to 3.1e-10)'."""
    span = one.interval if one.interval == "not determined" else f"95 %: {one.interval}"
    return f"{called or one.key.replace('_', ' ')} {one.value} {one.unit}".rstrip() + f" ({span})"


def _sure(one: Mapping[str, Any]) -> str:
    """The evidence, the held-out error without and with it, and whether another effect explains as much."""
    rivals = one["indistinguishable_from"]
    alone = f"{listed(rivals, 'or')} would explain as much" if rivals else "no other effect explains as much"
    nats = f"{one['score']['nats']:.0f} nats of evidence, {MARGIN:g} are asked" if "score" in one else ""
    error = f"held-out error {times(one['holdout_error_before'])} -> {times(one['holdout_error_after'])}"
    return "; ".join(part for part in (nats, error, alone) if part)


def answers_table(found: tuple[AnswerWords, ...]) -> Table:
    """A row for each effect."""
    rows = tuple((one.effect, one.size, one.sure, one.shows) for one in found)
    return Table("", ("what is missing", "its size", "how sure", "how it shows"), rows)


def remedies(found: Mapping[str, str]) -> tuple[str, ...]:
    """A sentence for each effect that says what to do about it; found: effects and their remedies, "" for none."""
    return tuple(f"At the machine, for {effect}: {remedy}." for effect, remedy in found.items() if remedy)


def at_the_machine(result: Mapping[str, Any]) -> tuple[str, ...]:
    """A sentence for each effect that says what to do; one sentence where nothing is missing."""
    if result["verdict"] == ADEQUATE:
        return ("At the machine there is nothing to do: the model explains these recordings.",)
    known = remedies({one["effect"]: one.get("remedy", "") for one in result["added"]})
    left = result["unexplained"]
    if result["verdict"] != UNKNOWN or not left:
        return known
    why = "no known effect explains what happens there"
    if result.get("interrupted") or result.get("deadline"):
        why = "the search was stopped before it could say which effect explains what happens there"
    return (*known, f"At the machine, look at {PLACES[left['equation']]}: {why}.")
