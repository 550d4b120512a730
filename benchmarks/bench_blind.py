"""Diagnosis of machines with a hidden effect: the independent rig simulator records, the diagnosis has to find it.

Each seed is a machine worn by 5 %, with other excitation and noise. `single` hides one effect of the catalogue, in one
of its shapes, `pair` two, `triple` three; strengths are drawn from a fifth of the usual size to all of it. `outside`
hides an effect that no catalogue has, `healthy` hides nothing; `rough` and `rough_healthy`: the same, but with a
coloured force and a friction texture that no model has. `--excitation` names the kind of recordings
(`rig.excitation.EXCITATIONS`), or `drawn`: each machine its own kind, at random. Tables show rates with 95 % intervals
(Wilson), and the targets.

    python benchmarks/bench_blind.py [--seeds 2] [--kind all] [--excitation usual] [--jobs 2]

Each result is appended to a file as one line of JSON. Cases that it already holds for the same code are not run
again, so that an interrupted run continues. `--seeds 0` prints the tables of the results there are; --code those of
other code.
"""

import argparse
import os
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import blind_figures as figures
import blind_tables as tables
from blind_case import KINDS, PARTNER, code_hash, drawn_excitation, drawn_strength
from resuming import add_options, kept, run_all
from rig.excitation import EXCITATIONS

Job = tuple[str, int, float, str]  # kind, seed, strength, excitation
Key = tuple[str, str, int, float, str]  # code and job
CASE = Path(__file__).with_name("blind_case.py")


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=2, help="how many (default 2)")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--kind", choices=(*KINDS, "all"), default="all")
    parser.add_argument("--strength", type=float, help="share of full strength, for all; else drawn from 0.2 to 1")
    parser.add_argument("--excitation", choices=(*EXCITATIONS, "drawn"), default="usual", help="what is recorded")
    add_options(parser, "blind.jsonl", jobs=2)
    return parser.parse_args()


def wanted(options: argparse.Namespace) -> list[Job]:
    """The requested cases, seed by seed, so that an interrupted run has some of every kind."""
    kinds = KINDS if options.kind == "all" else (options.kind,)
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    same, excitation = options.strength, options.excitation
    return [
        (
            kind,
            seed,
            drawn_strength(kind, seed) if same is None or kind in PARTNER.values() else same,
            drawn_excitation(kind, seed) if excitation == "drawn" else excitation,
        )
        for seed in seeds
        for kind in kinds
    ]


def stored(path: Path) -> dict[Key, dict[str, Any]]:
    """Results in the file."""
    return {
        (one["code"], one["kind"], one["seed"], one["strength"], one.get("excitation", "usual")): one
        for one in kept(path)
    }


def summary(result: dict[str, Any]) -> str:
    """One case in a line."""
    hidden = " + ".join(hidden["shape"] for hidden in result["hidden"]) or "nothing"
    found = " + ".join(added["effect"] for added in result["added"]) or "nothing"
    case = f"{hidden} ({result['strength']:.2f}, {result['excitation']})"
    return f"{case}: {result['verdict']}, {found}; {result['wall']:.0f} s"


def main() -> int:
    """Run the cases that have no result yet, print; 1 if a case failed."""
    options, code = arguments(), code_hash()
    known = stored(options.json)
    broken = run_all(CASE, [job for job in wanted(options) if (code, *job) not in known], options, summary)
    results = [one for key, one in stored(options.json).items() if key[0] == (options.code or code)]
    print(f"code {options.code or code}, {os.cpu_count()} processors, {options.jobs} cases at a time")
    if results:
        counts = Counter(one["kind"] for one in results)
        print(f"{len(results)} cases: {', '.join(f'{kind} {counts[kind]}' for kind in KINDS if counts[kind])}")
        for table in TABLES:
            if len((text := table(results)).splitlines()) > 1:  # more than its head
                print(f"\n{text}")
    if broken:
        print("\nfailed\n  " + "\n  ".join(broken))
    return int(bool(broken))


TABLES = (
    tables.rates_table, tables.excitations_table, tables.empty_table, tables.outside_table, tables.confusion_table,
    tables.failures, figures.parameters_table, figures.held_out_table, figures.cost_table,
)  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
