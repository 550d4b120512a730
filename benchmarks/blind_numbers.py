"""How much hangs on the numbers that decide: the decisions of blind machines, each number halved and doubled.

Every round of every result of `bench_blind.py` keeps what was measured of each candidate. Here the rules of
`pneumo_ros.diagnose.candidate` decide each round anew, with one of their numbers halved or doubled. A round counts as
changed where another candidate, or none, would be added, and a machine where one of its rounds is. Scores stand as they
were measured; later rounds of a changed machine are those of the unchanged one.

    python benchmarks/blind_numbers.py [--json .cache/blind.jsonl] [--code HASH]
"""

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from blind_case import DECIDING, ROOT, code_hash
from blind_tables import rate
from resuming import kept

from pneumo_ros.diagnose import candidate
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.score import Score

Result = dict[str, Any]
Number = float | tuple[float, ...]
NUMBERS = ("MARGIN", "MATERIAL", "SHARE_LEAST", "RESOLVED")  # of `candidate`
FACTORS = (0.5, 2.0)


def judged(one: Result) -> candidate.Candidate:
    """A candidate as it was measured, without its residuals."""
    none = np.empty(0)
    return candidate.Candidate(
        Hypothesis(one["effect"], (), none, none, none), none, {}, score=Score(one["train"], one["heldout"]),
        **{key: one[key] for key in DECIDING},
    )  # fmt: skip


def chosen(decision: Sequence[Result]) -> str:
    """The candidate of a round that would be added, "" for none: the first one without objections."""
    return next((one["effect"] for one in decision if not judged(one).objections), "")


def scaled(value: Number, factor: float) -> Number:
    """A number of the rules, or several, times a factor."""
    return tuple(factor * v for v in value) if isinstance(value, tuple) else factor * value


@contextmanager
def changed(name: str, factor: float) -> Iterator[None]:
    """Rules with one of their numbers times a factor."""
    value = getattr(candidate, name)
    try:
        setattr(candidate, name, scaled(value, factor))
        yield
    finally:
        setattr(candidate, name, value)


def table(results: Sequence[Result]) -> str:
    """Rounds and machines that decide otherwise, by number and factor."""
    lines = [f"{'number':16s}{'value':>14s}{'times':>8s}{'rounds':>24s}{'machines':>24s}"]
    usual = [[chosen(one) for one in result["decisions"]] for result in results]
    rounds = sum(map(len, usual))
    for name in NUMBERS:
        for factor in FACTORS:
            with changed(name, factor):
                now = [[chosen(one) for one in result["decisions"]] for result in results]
            other = [sum(a != b for a, b in zip(*both, strict=True)) for both in zip(usual, now, strict=True)]
            value = getattr(candidate, name)
            text = " / ".join(f"{v:g}" for v in (value if isinstance(value, tuple) else (value,)))
            machines = sum(count > 0 for count in other)
            lines.append(
                f"{name:16s}{text:>14s}{factor:8g}{rate(sum(other), rounds):>24s}{rate(machines, len(results)):>24s}"
            )
    return "\n".join(lines)


def main() -> None:
    """Print the table of the results of one code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, default=ROOT / ".cache" / "blind.jsonl", metavar="FILE", help="results")
    parser.add_argument("--code", help="results of this code (default: the present code)")
    options = parser.parse_args()
    code = options.code or code_hash()
    results = [one for one in kept(options.json) if one["code"] == code and "decisions" in one]
    print(f"code {code}, {len(results)} machines\n{table(results)}")


if __name__ == "__main__":
    main()
