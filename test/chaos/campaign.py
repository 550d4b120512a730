"""Faults in random order, and their results."""

import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from chaos.disks import DISKS, FILES, available
from chaos.field import Field
from chaos.messages import MESSAGES
from chaos.pages import FULL, PAGES
from chaos.processes import PROCESSES

Fault = Callable[[Field], Any]


class Result(NamedTuple):
    """One kind of fault: how often it happened, the longest recovery time [s], and the failures."""

    name: str
    count: int
    longest: float
    broken: list[str]


class Outcome(NamedTuple):
    """A campaign: results by kind, messages in the recordings, and the time [s] that killed recorders lost."""

    results: list[Result]
    recorded: int
    losses: list[float]
    without: list[str]
    seconds: float

    @property
    def broken(self) -> list[str]:
        """Everything that did not hold."""
        return [words for result in self.results for words in result.broken]

    def text(self) -> str:
        """The table."""
        lines = [f"{'fault':36s} {'times':>6s} {'broken':>7s} {'longest s':>10s}"]
        for one in self.results:
            lines.append(f"{one.name:36s} {one.count:6d} {len(one.broken):7d} {one.longest:10.1f}")
        lines.append(f"{'all':36s} {sum(r.count for r in self.results):6d} {len(self.broken):7d}")
        worst = f"at most {max(self.losses):.2f} s" if self.losses else "never"
        lines.append(
            f"\nkill -9 cost a recording {worst} ({len(self.losses)} times); {self.recorded} messages read back"
        )
        lines += [f"not tried here, for want of root: {name}" for name in self.without]
        return "\n".join(lines + [f"\nbroken: {words}" for words in self.broken])


def kinds(folder: Path) -> tuple[dict[str, Fault], list[str]]:
    """Every fault that is possible on this machine, and the names of the others."""
    faults, disks = {**PROCESSES, **MESSAGES, **FILES, **PAGES}, {**DISKS, **FULL}
    return (faults | disks, []) if available(folder) else (faults, list(disks))


def order(faults: Iterable[str], count: int, random: Random) -> list[str]:
    """`count` names: all of them in a random order, then all again."""
    names, drawn = sorted(faults), []
    while len(drawn) < count:
        drawn += random.sample(names, len(names))
    return drawn[:count]


def campaign(
    folder: Path,
    count: int,
    seed: int,
    seconds: float,
    names: Iterable[str] = (),
    told: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """At most `count` faults, from `names` or all, in about `seconds`; after each, the conditions are checked.

    After a failure the processes are ended and new ones are started.
    """
    faults, without = kinds(folder)
    waiting = order(names or faults, count, Random(seed))
    counts, longest, broken = Counter[str](), Counter[str](), dict[str, list[str]]()
    fields, recorded, losses, begun = 0, 0, list[float](), time.monotonic()
    while waiting and time.monotonic() - begun < seconds:
        with ExitStack() as stack:
            fields += 1
            field, name = None, "the beginning"
            try:
                field = Field(folder / f"field_{fields}", seed + fields, stack)
                while waiting and time.monotonic() - begun < seconds:
                    name, at = waiting.pop(0), time.monotonic()
                    counts[name] += 1
                    faults[name](field)
                    field.probe.withdraw()  # next to its publishers no controller and no simulator starts
                    field.answers()
                    longest[name] = max(longest[name], time.monotonic() - at)
                    told(f"{sum(counts.values())}/{count} {name}: {time.monotonic() - at:.1f} s")
                name = "the end"
                field.end()
            except Exception as error:  # whatever it is, it broke something
                words = f"{name}: {error}\n" + traceback.format_exc(limit=-3)
                told(words)
                broken.setdefault(name, []).append(words)
            if field is not None:
                recorded, losses = recorded + field.counts["recorded"], losses + field.losses
            elif len(broken[name]) > 2:  # nothing runs here
                break
    names = [*counts, *(name for name in broken if name not in counts)]
    results = [Result(name, counts[name], longest[name], broken.get(name, [])) for name in sorted(names)]
    return Outcome(results, recorded, losses, without, time.monotonic() - begun)
