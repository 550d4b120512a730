"""Bad input for every parser: how many inputs gave a clear error, how many a result, and how many broke something.

Inputs are drawn by property-based testing: recordings, databases and texts with random damage, and grammars of files
that are nearly right. A traceback, a message of more than 2000 characters, a warning of Python, 10 s of a processor,
1 GB, or a file made by code in an input counts as broken. Then a recording is cut at random places: every message
of a whole chunk before the cut must be read, and nothing that the uncut file does not contain.

    python benchmarks/fuzz.py [--inputs 100000] [--cuts 500] [--seed 1] [--only WORD]

Each parser has a process of its own. The exit code is 1 when anything is broken.
"""

import argparse
import math
import multiprocessing
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]

KEPT = 3  # broken inputs shown of each parser


class Row(NamedTuple):
    """One parser: inputs by verdict, worst processor time [s], memory above the start [MB], and what is broken."""

    name: str
    kinds: dict[str, int]
    seconds: float
    memory: float
    broken: dict[str, bytes]


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=100_000, help="in all (default 100000)")
    parser.add_argument("--cuts", type=int, default=500, help="of a recording (default 500)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="parsers whose name has this word in it")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="put inputs that broke a parser here")
    parser.add_argument("--jobs", type=int, default=2, help="parsers side by side (default 2)")
    return parser.parse_args()


def fuzz_one(job: tuple[int, int, int]) -> Row:
    """Parser number, inputs and seed; runs in a process of its own."""
    from fuzz import judging
    from fuzz.parsers import PARSERS
    from hypothesis import HealthCheck, given, seed, settings

    number, count, chosen = job
    parser, kinds, broken, worst = PARSERS[number], Counter[str](), dict[str, bytes](), [0.0]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        begun = judging.peak()
        judging.limit_memory()

        def one(data: bytes) -> None:
            verdict = judging.judge(parser, data, Path(folder))
            kinds[verdict.kind] += 1
            worst[0] = max(worst[0], verdict.seconds)
            if verdict.kind == judging.BROKEN:
                broken.setdefault(place(verdict.words), data)

        rules = settings(
            max_examples=count,
            database=None,
            deadline=None,
            suppress_health_check=list(HealthCheck),
            phases=["generate"],
        )
        seed(chosen)(rules(given(parser.inputs())(one)))()
        return Row(parser.name, dict(kinds), worst[0], judging.peak() - begun, broken)


def place(words: str) -> str:
    """What distinguishes one failure from another: its last lines."""
    return "\n    ".join(words.strip().splitlines()[-4:])


def table(rows: list[Row]) -> str:
    """A line for each parser, and their sum."""
    lines = ["parser                      inputs  clear errors  results  broken  worst ms  worst MB"]
    for row in [*rows, total(rows)]:
        counts = [row.kinds.get(kind, 0) for kind in ("clear error", "result", "traceback")]
        cells = "{:13d} {:8d} {:7d}".format(*counts)
        lines.append(f"{row.name:26s} {sum(counts):7d} {cells} {1e3 * row.seconds:9.0f} {row.memory:9.0f}")
    return "\n".join(lines)


def total(rows: list[Row]) -> Row:
    """The sum of the rows; the worst of times and memory."""
    kinds = Counter[str]()
    for row in rows:
        kinds.update(row.kinds)
    return Row("all", dict(kinds), max(row.seconds for row in rows), max(row.memory for row in rows), {})


def main() -> int:
    """Fuzz, cut, print; 1 if anything is broken."""
    from fuzz import cutting
    from fuzz.parsers import PARSERS

    options, begun = arguments(), time.monotonic()
    chosen = [number for number, parser in enumerate(PARSERS) if options.only in parser.name]
    each = math.ceil(options.inputs / len(chosen))
    jobs = [(number, each, options.seed) for number in chosen]
    with multiprocessing.get_context("spawn").Pool(options.jobs, maxtasksperchild=1) as pool:
        rows = []
        for row in pool.imap(fuzz_one, jobs):
            rows.append(row)
            print(f"{len(rows)}/{len(jobs)} {row.name}: {sum(row.kinds.values())} inputs", file=sys.stderr, flush=True)
    print(f"seed {options.seed}, {time.monotonic() - begun:.0f} s\n{table(rows)}")
    for row in rows:
        for number, (words, data) in enumerate(list(row.broken.items())[:KEPT]):
            print(f"\n{row.name}:\n    {words}\n    input: {data[:100]!r}")
            if options.keep:
                options.keep.mkdir(exist_ok=True)
                (options.keep / f"{row.name.replace(' ', '_')}_{number}").write_bytes(data)
    cuts = cutting.campaign(options.cuts, options.seed) if options.cuts else None
    print("" if cuts is None else f"\n{cuts.text()}")
    return int(any(row.broken for row in rows) or (cuts is not None and bool(cuts.wrong)))


if __name__ == "__main__":
    sys.exit(main())
