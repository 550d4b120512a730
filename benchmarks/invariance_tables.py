"""The table of changes: how often the answer stayed, and the sizes in it."""

from collections.abc import Mapping, Sequence
from itertools import permutations
from math import hypot
from typing import Any

from blind_tables import Z, rate
from invariance_changes import AS_RECORDED, CHANGES

Result = dict[str, Any]
Pairs = Sequence[tuple[Result, Result]]  # as recorded, and after the change


def same_effect(one: Result, other: Result) -> bool:
    """Whether two additions name one effect, or either is among the rivals of the other."""
    return one["effect"] == other["effect"] or one["effect"] in other["group"] or other["effect"] in one["group"]


def same_answer(one: Result, other: Result) -> bool:
    """Whether two diagnoses have the same verdict and the same added effects, in any order."""
    if one["verdict"] != other["verdict"] or len(one["added"]) != len(other["added"]):
        return False
    orders = permutations(other["added"])
    return any(all(map(same_effect, one["added"], order)) for order in orders)


def sizes(one: Result, other: Result) -> list[tuple[str, float]]:
    """Parameters of effects added in both and their distance in joint 95 % intervals, where both determine them."""
    after = {added["effect"]: added["parameters"] for added in other["added"]}
    found = []
    for added in one["added"]:
        for key, (value, std) in added["parameters"].items():
            value_after, std_after = after.get(added["effect"], {}).get(key, (value, None))
            if std is not None and std_after is not None:
                joint = Z * hypot(std, std_after)
                found.append((f"{added['effect']}.{key}", abs(value_after - value) / joint))
    return found


def table(results: Sequence[Result]) -> str:
    """One line for each change that has results, then each answer and each size that changed."""
    first = {r["seed"]: r for r in results if r["change"] == AS_RECORDED}
    lines = [f"{'change':22s}{'same answer':>24s}{'sizes that agree':>24s}   other answer for machine"]
    details = []
    for change in CHANGES:
        if pairs := paired(first, results, change):
            lines.append(row(change, pairs))
            details += [line for before, after in pairs for line in differences(before, after)]
    return "\n".join([*lines, *(["", "what changed", *details] if details else [])])


def paired(first: Mapping[int, Result], results: Sequence[Result], change: str) -> Pairs:
    """Results of a change beside those as recorded, by seed."""
    changed = sorted((r for r in results if r["change"] == change), key=lambda r: r["seed"])
    return [(first[r["seed"]], r) for r in changed if r["seed"] in first]


def row(change: str, pairs: Pairs) -> str:
    """Rates of a change with their intervals, and the machines with another answer."""
    other = [after["seed"] for before, after in pairs if not same_answer(before, after)]
    apart = [distance for before, after in pairs for _, distance in sizes(before, after)]
    same, agree = rate(len(pairs) - len(other), len(pairs)), rate(sum(d <= 1.0 for d in apart), len(apart))
    return f"{change:22s}{same:>24s}{agree:>24s}   {', '.join(map(str, other)) or '-'}"


def differences(before: Result, after: Result) -> list[str]:
    """What differs between two results, with the words that repeat the second."""
    words = f"[{after['seed']} '{after['change']}']"
    hidden = " + ".join(after["hidden"]) or "nothing"
    apart = [f"{name} by {d:.1f} intervals" for name, d in sizes(before, after) if d > 1.0]
    lines = [] if same_answer(before, after) else [f"  {words} {hidden}: {said(before)} -> {said(after)}"]
    return lines + ([f"  {words} {hidden}: {', '.join(apart)}"] if apart else [])


def said(result: Result) -> str:
    """Verdict and added effects, each with its rivals."""
    found = [f"{a['effect']}{[*a['group']] if a['group'] else ''}" for a in result["added"]]
    return f"{result['verdict']}, {' + '.join(found) or 'nothing added'}"
