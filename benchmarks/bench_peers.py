"""Who names the hidden effect: our diagnosis, PySINDy's weak form, or a simulation fit of every effect ranked by BIC.

The machines are those of the independent rig, `single` of bench_blind with drawn excitation: each hides one effect.
`healthy` ones are the first of them with nothing hidden. All methods get the same recordings and machine file.

    python benchmarks/bench_peers.py [--machines 12] [--healthy 3] [--method all]

Results are appended to a file, one line of JSON for each machine and method; those that it already holds for the same
code are not computed again. `--machines 0` prints the table of the results there are.

PySINDy is optional, `pip install '.[peers]'`; its library is in peer_terms.py, what it is given in peer_sindy.py.
"""

import argparse
import importlib.util
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import peer_tables
from blind_case import ROOT
from peer_case import OWN_FILES, judged, method_code

INSTALL = "pysindy is not installed, so its column is left out; to add it: pip install '.[peers]'"
SEGMENTS = 12


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machines", type=int, default=12, help="with a hidden effect (default 12); 0: only print")
    parser.add_argument("--healthy", type=int, default=3, help="with nothing hidden (default 3)")
    parser.add_argument("--first-seed", type=int, default=2407)
    parser.add_argument("--method", choices=(*OWN_FILES, "all"), default="all")
    parser.add_argument(
        "--segments", type=int, default=SEGMENTS, help=f"of the fits by simulation (default {SEGMENTS})"
    )
    parser.add_argument("--json", type=Path, default=ROOT / ".cache" / "peers.jsonl", metavar="FILE", help="results")
    return parser.parse_args()


def methods(options: argparse.Namespace) -> list[str]:
    """The requested methods that can run."""
    wanted = list(OWN_FILES) if options.method == "all" else [options.method]
    if importlib.util.find_spec("pysindy"):
        return wanted
    print(INSTALL)
    return [method for method in wanted if method != "pysindy"]


def machines(options: argparse.Namespace) -> Iterator[tuple[str, int]]:
    """Kind and seed of each machine."""
    if options.machines:
        yield from (("single", options.first_seed + k) for k in range(options.machines))
        yield from (("healthy", options.first_seed + k) for k in range(options.healthy))


def stored(options: argparse.Namespace) -> list[peer_tables.Result]:
    """Results in the file that are of the present code and options."""
    lines = options.json.read_text().splitlines() if options.json.exists() else []
    codes = {method: method_code(method, options.segments) for method in OWN_FILES}
    return [one for one in map(json.loads, lines) if one["code"] == codes.get(one["method"])]


def run(options: argparse.Namespace, wanted: list[str]) -> None:
    """Run what has no result yet."""
    known = {(one["kind"], one["seed"], one["method"]) for one in stored(options)}
    options.json.parent.mkdir(parents=True, exist_ok=True)
    for kind, seed in machines(options):
        left = [method for method in wanted if (kind, seed, method) not in known]
        for result in judged(kind, seed, left, options.segments) if left else ():
            with options.json.open("a") as file:
                file.write(json.dumps(result) + "\n")
            print(peer_tables.line(result), file=sys.stderr, flush=True)


def main() -> None:
    """Run, and print the table."""
    options = arguments()
    wanted = methods(options)
    run(options, wanted)
    print(f"{os.cpu_count()} processors, {options.segments} segments per fit by simulation")
    results = [one for one in stored(options) if one["method"] in wanted]
    shown = [method for method in wanted if any(one["method"] == method for one in results)]
    print(peer_tables.table(results, shown) if results else "no results yet")


if __name__ == "__main__":
    main()
