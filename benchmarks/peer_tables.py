"""The table of bench_peers: what each method names, machine by machine, and how often it is right."""

import statistics
from collections.abc import Callable, Sequence
from typing import Any

from blind_tables import rate

Result = dict[str, Any]
FIRST, WIDTH = 56, 38


def line(result: Result) -> str:
    """One result in a line."""
    names = ", ".join(result["named"]) or "nothing"
    return f"{machine(result)}: {result['method']} names {names}; {result['wall']:.0f} s"


def machine(result: Result) -> str:
    """Seed, hidden effect, strength and excitation."""
    if not result["hidden"]:
        return f"{result['seed']} nothing ({result['excitation']})"
    return f"{result['seed']} {result['hidden'][0]} ({result['strength']:.2f}, {result['excitation']})"


def cell(result: Result) -> str:
    """What a method names first, how many besides, seconds."""
    first, more = result["named"][:1], len(result["named"]) - 1
    return f"{first[0] if first else 'nothing'}{f' +{more}' if more > 0 else ''} {result['wall']:.0f} s"


def first_right(result: Result) -> bool:
    """Whether the hidden effect is the one that is named first."""
    return bool(result["named"][:1] == [effect(result)])


def alone_right(result: Result) -> bool:
    """Whether the hidden effect is the only one named."""
    return bool(result["named"] == [effect(result)])


def among(result: Result) -> bool:
    """Whether the hidden effect is one of those named."""
    return effect(result) in result["named"]


def effect(result: Result) -> str:
    """The catalogue's name of the hidden effect, without its shape."""
    return str(result["hidden"][0]).partition(":")[0]


def table(results: Sequence[Result], methods: Sequence[str]) -> str:
    """The whole table."""
    hiding = [one for one in results if one["hidden"]]
    empty = [one for one in results if not one["hidden"]]
    lines = [_row("hidden effect (strength, excitation)", methods), *_machines(hiding, methods)]
    for title, right in (
        ("named first, rightly", first_right),
        ("named alone, rightly", alone_right),
        ("named", among),
    ):
        lines.append(_row(title, [_rate(hiding, method, right) for method in methods]))
    lines += ["", _row("nothing hidden", methods), *_machines(empty, methods)]
    lines.append(_row("something named", [_rate(empty, method, lambda one: bool(one["named"])) for method in methods]))
    return "\n".join([*lines, "", _row("median time", [_seconds(results, method) for method in methods])])


def _machines(results: Sequence[Result], methods: Sequence[str]) -> list[str]:
    by_machine: dict[str, dict[str, str]] = {}
    for one in sorted(results, key=lambda one: one["seed"]):
        by_machine.setdefault(machine(one), {})[one["method"]] = cell(one)
    return [_row(name, [cells.get(method, "-") for method in methods]) for name, cells in by_machine.items()]


def _row(first: str, cells: Sequence[str]) -> str:
    return f"{first:{FIRST}s}{''.join(f'{text:{WIDTH}s}' for text in cells)}".rstrip()


def _rate(results: Sequence[Result], method: str, hit: Callable[[Result], bool]) -> str:
    own = [one for one in results if one["method"] == method]
    return rate(sum(map(hit, own)), len(own))


def _seconds(results: Sequence[Result], method: str) -> str:
    own = [one["wall"] for one in results if one["method"] == method]
    return f"{statistics.median(own):.0f} s" if own else "-"
