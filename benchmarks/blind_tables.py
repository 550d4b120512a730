"""Rates and tables of the blind benchmark, from its results, one dictionary per case."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from math import sqrt
from typing import Any

from pneumo_ros.command.demo.revealing import EXACT, GROUP, Judgement, judge, pairing

Result = dict[str, Any]
BANDS = ((0.7, 1.0), (0.4, 0.7), (0.2, 0.4))
# kinds that hide catalogue effects: target for right [%], if there is one
HIDING = {"single": 95.0, "pair": 90.0, "triple": 0.0, "rough": 85.0}
EMPTY = ("healthy", "rough_healthy")
Z = 1.96


def wilson(hits: int, of: int) -> tuple[float, float]:
    """95 % interval of a rate (Wilson 1927), as shares."""
    if not of:
        return 0.0, 1.0
    share, spread = hits / of, Z * Z / of
    middle = (share + 0.5 * spread) / (1.0 + spread)
    half = Z / (1.0 + spread) * sqrt(share * (1.0 - share) / of + 0.25 * spread / of)
    return max(middle - half, 0.0), min(middle + half, 1.0)


def rate(hits: int, of: int) -> str:
    """Hits, cases, per cent and interval."""
    if not of:
        return "-"
    low, high = wilson(hits, of)
    return f"{hits}/{of} {100.0 * hits / of:.0f} % ({100.0 * low:.0f}-{100.0 * high:.0f})"


def judgement(result: Result) -> Judgement:
    """The judge's verdict on a case of catalogue effects; in other kinds every added effect is false."""
    names = [hidden["effect"] for hidden in result["hidden"] if hidden["in_catalogue"]]
    return judge(names, additions(result))


def additions(result: Result) -> list[tuple[str, Sequence[str]]]:
    """Effects added, each with its rivals."""
    return [(added["effect"], added["group"]) for added in result["added"]]


def of_kind(results: Iterable[Result], *kinds: str) -> list[Result]:
    """Results of these kinds."""
    return [result for result in results if result["kind"] in kinds]


def in_band(results: Iterable[Result], low: float, high: float) -> list[Result]:
    """Results of a band of strengths, full strength in the highest."""
    return [r for r in results if low <= r["strength"] < high or r["strength"] == high == 1.0]


def rates_table(results: Sequence[Result]) -> str:
    """Right, missed and false by kind and by strength; "said": what was missed is named as what cannot be said."""
    lines = [_head("hidden effects")]
    for kind, target in HIDING.items():
        some = of_kind(results, kind)
        if not some:
            continue
        lines.append(_rates(kind, some) + (f"   (target for right: {target:g} %)" if target else ""))
        for low, high in BANDS:
            if band := in_band(some, low, high):
                lines.append(_rates(f"  strength {low:g}-{high:g}", band))
    return "\n".join(lines)


def excitations_table(results: Sequence[Result]) -> str:
    """The same by kind of excitation, where there is more than one."""
    by_kind: dict[str, list[Result]] = defaultdict(list)
    for result in of_kind(results, *HIDING):
        by_kind[result["excitation"]].append(result)
    if len(by_kind) < 2:
        return ""
    return "\n".join([_head("by excitation"), *(_rates(f"  {kind}", by_kind[kind]) for kind in sorted(by_kind))])


def _head(title: str) -> str:
    columns = ("exact", "group of 2-3", "right", "missed", "false addition", "named first", "right or said")
    return f"{title:24s}" + "".join(f"{name:>22s}" for name in columns)


def _rates(name: str, results: Sequence[Result]) -> str:
    judged = [judgement(result) for result in results]
    counts = (
        sum(j.word == EXACT for j in judged),
        sum(j.word == GROUP for j in judged),
        sum(j.right for j in judged),
        sum(bool(j.missed or j.vague) for j in judged),
        sum(bool(j.false) for j in judged),
        sum({h["effect"] for h in r["hidden"]} == {a["effect"] for a in r["added"]} for r in results),
        sum(right_or_said(r, j) for r, j in zip(results, judged, strict=True)),
    )
    return f"{name:24s}" + "".join(f"{rate(count, len(results)):>22s}" for count in counts)


def right_or_said(result: Result, judged: Judgement) -> bool:
    """Whether a diagnosis is right, or says of each effect that it missed that these recordings cannot tell."""
    unsaid = {*judged.missed, *judged.vague} - {*result.get("cannot_say", ())}
    return judged.right or not (unsaid or judged.false)


def empty_table(results: Sequence[Result]) -> str:
    """Machines with nothing hidden."""
    lines = [f"{'nothing hidden':24s}{'nothing added':>22s}{'verdict adequate':>22s}"]
    for kind in EMPTY:
        if some := of_kind(results, kind):
            clean, adequate = sum(not r["added"] for r in some), sum(r["verdict"] == "adequate" for r in some)
            target = "   (target for nothing added: 99 %)"
            lines.append(f"{kind:24s}{rate(clean, len(some)):>22s}{rate(adequate, len(some)):>22s}{target}")
    return "\n".join(lines)


def right_equation(result: Result) -> bool:
    """Whether the remaining misfit is reported in an equation that contains the hidden effect."""
    left = result["unexplained"]
    return bool(left) and left["equation"] in result["hidden"][0]["equations"]


def outside_table(results: Sequence[Result]) -> str:
    """Effects that no catalogue has."""
    columns = ("flagged as unknown", "adequate", "look-alike added", "remainder shown")
    lines = [f"{'outside the catalogue':24s}" + "".join(f"{name:>22s}" for name in columns)]
    some = of_kind(results, "outside")
    by_name = {"all": some} if some else {}
    for result in some:
        by_name.setdefault(result["hidden"][0]["effect"], []).append(result)
    by_name |= {f"  strength {low:g}-{high:g}": band for low, high in BANDS if (band := in_band(some, low, high))}
    for name, group in by_name.items():
        counts = (
            sum(r["verdict"] == "unknown_effect" and right_equation(r) for r in group),
            sum(r["verdict"] == "adequate" for r in group),
            sum(bool(r["added"]) for r in group),
            sum(right_equation(r) for r in group),
        )
        target = "   (targets: flagged in the right equation 90 %, adequate never)" if name == "all" else ""
        lines.append(f"{name:24s}" + "".join(f"{rate(count, len(group)):>22s}" for count in counts) + target)
    return "\n".join(lines)


def confusion_table(results: Sequence[Result]) -> str:
    """Hidden effects against found ones; additions without a match are shown beside missed effects, or alone."""
    seen: dict[str, Counter[str]] = defaultdict(Counter)
    for result in results:
        names, added = [hidden["effect"] for hidden in result["hidden"]], additions(result)
        found = pairing(names, added)
        left = [effect for place, (effect, _) in enumerate(added) if place not in found.values()]
        for name in names:
            if name in found:
                effect, rivals = added[found[name]]
                seen[name][
                    f"{'=' if effect == name else effect}{f' (one of {1 + len(rivals)})' if rivals else ''}"
                ] += 1
            else:
                seen[name][" + ".join(left) or "nothing"] += 1
        if left and len(found) == len(names):
            seen["(nothing)"][" + ".join(left)] += 1
    lines = ["truth                         found: times (= itself; one of n: it leaves n open)"]
    for name in sorted(seen):
        lines.append(f"{name:30s}" + ", ".join(f"{other}: {n}" for other, n in seen[name].most_common()))
    return "\n".join(lines)


def failures(results: Sequence[Result]) -> str:
    """Every case that is not right, by effect, with the arguments that repeat it."""
    lines = ["not right"]
    for result in sorted(results, key=lambda r: ([h["shape"] for h in r["hidden"]], r["kind"], r["seed"])):
        outside = result["kind"] == "outside"
        if result["verdict"] == "unknown_effect" and right_equation(result) if outside else judgement(result).right:
            continue
        found = [f"{a['effect']}{[*a['group']] if a['group'] else ''}" for a in result["added"]]
        hidden = " + ".join(f"{h['shape']}={h['size']:.3g}" for h in result["hidden"]) or "nothing"
        words = " ".join(map(str, (result[key] for key in ("kind", "seed", "strength", "excitation"))))
        said = f"{result['verdict']}, {', '.join(found) or 'nothing added'}"
        open_ones = [h["effect"] for h in result["hidden"] if h["effect"] in result.get("cannot_say", ())]
        said += f", cannot say whether {' or '.join(open_ones)}" if open_ones else ""
        lines.append(f"  {hidden}: {said}   [{words}]")
    if len(lines) > 1:
        lines.append(
            "  repeat one by: python benchmarks/blind_case.py KIND SEED STRENGTH EXCITATION, the words in brackets"
        )
    return "\n".join(lines)
