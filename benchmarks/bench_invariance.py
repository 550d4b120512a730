"""Questions that change the recordings but must not change the answer of a diagnosis.

Each seed is a machine of the independent rig, worn by 5 %, with an effect of random strength; every fifth hides
nothing. The kind of recordings is drawn. Every machine is diagnosed as recorded, and once for each change; the answer
is the same if verdict and added effects are, where an effect may stand for one that it is not distinguished from.
Sizes agree if they differ by no more than their joint 95 % interval. Rates have 95 % intervals (Wilson).

    python benchmarks/bench_invariance.py [--machines 10] [--change "250 Hz"] [--change mirrored]

`benchmarks/invariance_changes.py` says what the changes are. A machine whose friction warms up is not cut into pieces:
it warms from the start of a recording. Each result is appended to a file as one line of JSON. What it already holds for
the same code is not run again, so that an interrupted run continues. `--machines 0` prints the table of the results
there are; --code those of other code.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

from invariance_case import applies, code_hash
from invariance_changes import AS_RECORDED, CHANGES
from invariance_tables import said, table
from resuming import add_options, kept, run_all

Job = tuple[int, str]  # seed and change
CASE = Path(__file__).with_name("invariance_case.py")


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machines", type=int, default=10, help="how many (default 10)")
    parser.add_argument("--first-seed", type=int, default=5000)
    parser.add_argument(
        "--change", action="append", choices=CHANGES, metavar="NAME", help=f"of {', '.join(CHANGES)}; default: all"
    )
    add_options(parser, "invariance.jsonl", jobs=1)
    return parser.parse_args()


def wanted(options: argparse.Namespace) -> list[Job]:
    """Each machine as recorded and after each change, machine by machine, so that an interrupted run has pairs."""
    seeds = range(options.first_seed, options.first_seed + options.machines)
    changes = (AS_RECORDED, *(options.change or CHANGES))
    return [(seed, change) for seed in seeds for change in changes if applies(seed, change)]


def summary(result: dict[str, Any]) -> str:
    """One case in a line."""
    hidden = " + ".join(result["hidden"]) or "nothing"
    return f"{hidden} ({result['strength']:.2f}, {result['excitation']}): {said(result)}; {result['wall']:.0f} s"


def main() -> int:
    """Run the cases that have no result yet, print; 1 if a case failed."""
    options, code = arguments(), code_hash()
    known = {(one["seed"], one["change"]) for one in kept(options.json) if one["code"] == code}
    broken = run_all(CASE, [job for job in wanted(options) if job not in known], options, summary)
    print(f"code {options.code or code}")
    stored = {(o["seed"], o["change"]): o for o in kept(options.json) if o["code"] == (options.code or code)}
    print(table([*stored.values()]) if stored else "no results")
    if broken:
        print("\nfailed\n  " + "\n  ".join(broken))
    return int(bool(broken))


if __name__ == "__main__":
    sys.exit(main())
