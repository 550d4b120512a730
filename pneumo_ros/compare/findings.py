"""Where a model fails, in sentences: from the JSON of `compare`, for the terminal and for the report."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pneumo_ros.compare.typical import typical_error
from pneumo_ros.compare.wording import EQUATIONS, REGIMES, SIGNALS, VARIABLES, amount, percent, times

Level = Literal["good", "bad", "open"]

_FOLLOWS = 0.1  # least share of the squared residual for which a variable or a constant is named
_TIED = 0.8  # of the best share: variables this close cannot be distinguished
_OFTEN = 0.1  # least share of the error for which a regime is named


@dataclass(frozen=True)
class Finding:
    """One sentence on an equation or a signal, and whether it is good, bad or open."""

    target: str
    level: Level
    verdict: str
    details: tuple[str, ...] = ()


def findings(result: Mapping[str, Any]) -> list[Finding]:
    """One finding for every equation and signal: verdict first, then where and when."""
    equations = [_equation(result, name) for name in result["equations"]]
    return equations + [_signal(result, name) for name in result["signals"]]


def verdict(result: Mapping[str, Any], judged: Sequence[Mapping[str, Any]] | None = None, where: str = "") -> str:
    """The whole comparison in one sentence; the error of `judged` runs, by default all, which `where` names."""
    error = headline(result, judged, where)
    same = set(result.get("refit", {}).get("runs", ())) & {run["name"] for run in result["runs"]}
    caution = " The model was refitted to recordings that it is scored on." if same else ""
    failing = [n for n, e in result["equations"].items() if e["explained_by_noise"] is False]
    runs = f"{len(result['runs'])} recording" + ("s" if len(result["runs"]) != 1 else "")
    if not failing:
        return f"Noise explains every equation of '{result['model']}' that {runs} could judge{error}.{caution}"
    *others, last = (_words(name) for name in failing)
    names = f"{', '.join(others)} and {last}" if others else last
    verb = "fails" if len(failing) == 1 else "fail"
    return f"'{result['model']}' against {runs}: {names} {verb}{error}.{caution}"


def explained(result: Mapping[str, Any], judged: Sequence[Mapping[str, Any]] | None = None) -> bool:
    """Whether noise explains every equation and the typical prediction of `judged` runs, by default all.

    It agrees with `verdict` and `headline`: one signal that is off in one run is a finding, not the verdict.
    """
    from pneumo_ros.compare.verdicts import SIGNAL_EXPLAINED  # with numpy, which `pneumo --help` does not wait for

    error = typical_error(result["runs"] if judged is None else judged)
    fails = any(one["explained_by_noise"] is False for one in result["equations"].values())
    return not fails and (error is None or error <= SIGNAL_EXPLAINED)


def headline(result: Mapping[str, Any], judged: Sequence[Mapping[str, Any]] | None = None, where: str = "") -> str:
    """The headline number as the end of a sentence, as `pneumo diagnose` has it; empty where nothing was predicted."""
    error = typical_error(result["runs"] if judged is None else judged)
    said = f"; the error over {result['horizon_s']:g} s is {times(error)} the noise floor"
    return "" if error is None else f"{said}{where}"


def _equation(result: Mapping[str, Any], name: str) -> Finding:
    found = result["equations"][name]
    if found["explained_by_noise"] is None:
        return Finding(
            name, "open", "is not judged: the piston never slides" if name == "momentum" else "is not judged"
        )
    size = f"{amount(found['residual_rms'], name)}, {times(found['ratio_to_noise'])} noise"
    if found["explained_by_noise"]:
        return Finding(name, "good", f"is explained by noise ({size})")
    details = (*_where(name, found), *_follows(found), *_when(result, name))
    return Finding(name, "bad", f"fails: {size}", details)


def _signal(result: Mapping[str, Any], name: str) -> Finding:
    found = result["signals"][name]
    size = f"{amount(found['rms'], name)} over {result['horizon_s']:g} s, {times(found['ratio_to_noise'])} noise"
    if found["explained_by_noise"]:
        return Finding(name, "good", f"is explained by noise ({size})")
    return Finding(name, "bad", f"is off by {size}", (*_where(name, found), *_when(result, name)))


def _where(name: str, found: Mapping[str, Any]) -> Iterator[str]:
    """The regimes in which the error is concentrated: their share of the error and of the time.

    Filling chamber a empties chamber b, so the flows of one chamber are named: the target's own if it has one.
    """
    other = ("filling_a", "exhausting_a") if "_b" in name else ("filling_b", "exhausting_b")
    shares = {n: s for n, s in found["regimes"].items() if s["share"] >= _OFTEN and n in REGIMES and n not in other}
    dense = sorted(shares, key=lambda n: -shares[n]["share"] * shares[n]["share"] / shares[n]["time_share"])
    dense_first = [n for n in dense if shares[n]["share"] > 1.2 * shares[n]["time_share"]][:2]
    if dense_first:
        parts = (
            f"{percent(shares[n]['share'])} in '{REGIMES[n]}' ({percent(shares[n]['time_share'])} of the time)"
            for n in dense_first
        )
        yield "where: " + ", ".join(parts)
    else:
        yield "where: everywhere alike"


def _concentration(regime: str, share: Mapping[str, Any]) -> str:
    return f"{percent(share['share'])} in '{REGIMES[regime]}' ({percent(share['time_share'])} of the time)"


def _follows(found: Mapping[str, Any]) -> Iterator[str]:
    """The variables that the residual depends on."""
    against = found["against"]
    shares = {n: a["explained_share"] for n, a in against.items()}
    best = max(shares.values(), default=0.0)
    constant = max((a["constant_share"] for a in against.values()), default=0.0)
    parts = [f"a constant ({percent(constant)})"] if constant >= _FOLLOWS else []
    if best >= _FOLLOWS:
        near = sorted((n for n in shares if shares[n] >= _TIED * best), key=lambda n: -shares[n])[:3]
        parts.append(" or ".join(f"{VARIABLES[n][0]} ({percent(shares[n])})" for n in near))
    if parts:
        yield "follows: " + ", then ".join(parts)
    elif against:
        yield "follows: none of velocity, position, voltage, pressures, time"


def _when(result: Mapping[str, Any], name: str) -> Iterator[str]:
    """The worst intervals over all runs."""
    kind = "error" if name in SIGNALS else "equations"
    every = [(run["name"], interval) for run in result["runs"] for interval in run[kind][name]["worst"]]
    every.sort(key=lambda pair: -pair[1]["ratio_to_noise"])
    parts = [f"{run} {w['start_s']:.1f}-{w['end_s']:.1f} s ({times(w['ratio_to_noise'])})" for run, w in every[:2]]
    if parts:
        yield "worst: " + ", ".join(parts)


def _words(name: str) -> str:
    return {**SIGNALS, **EQUATIONS}[name][0]
