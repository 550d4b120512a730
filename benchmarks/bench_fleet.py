"""The cost of a fleet: campaigns identified on one process and on several, and diagnosed; 10,000 machines in a night.

Recordings are of the default machine, 6 s at 250 Hz, one constant voltage each; a campaign is one recording, so that
the curve is the cost over recordings. The measured time includes the start of workers: Python, libraries, kernels.
The diagnosis uses recordings of a rig, healthy and with a leak, if $PNEUMO_RIG names their folder.

    python benchmarks/bench_fleet.py [--most 64] [--processes 2] [--no-diagnosis]
"""

import argparse
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]

NIGHT, MACHINES = 8 * 3600.0, 10_000  # s; machines of one campaign each


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=64, help="recordings of the last row (default 64)")
    parser.add_argument("--processes", type=int, default=2, help="number compared with one (default 2)")
    parser.add_argument("--no-diagnosis", action="store_true", help="only identify")
    return parser.parse_args()


def recorded(folder: Path) -> list[str]:
    """Eight recordings of constant voltages."""
    from ros.campaign_bags import record_campaign

    from pneumo_ros.plant import load_model

    paths = record_campaign(folder, load_model("axis"), (0.83, 0.95, 1.5, 3.0), 6.0)
    return [str(path) for path in paths]


def swept(paths: list[str], count: int, executor: str) -> tuple[float, float, dict[str, object]]:
    """Seconds of the wall and of processors for `count` recordings, and the results."""
    from pneumo_ros.fleet.examine import examine
    from pneumo_ros.sweep import open_pool, sweep

    jobs = {str(k): ([paths[k % len(paths)]], "axis", [], False) for k in range(count)}
    wall, spent = time.perf_counter(), processor()
    with open_pool(executor) as pool:
        results = {done.key: (done.result, done.problem) for done in sweep(examine, jobs, pool)}
        wall = time.perf_counter() - wall
        pool.executor.shutdown(wait=True)  # children count once they have ended
    return wall, processor() - spent, results


def processor() -> float:
    """Processor time of this process and its ended children [s]."""
    kinds = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(use.ru_utime + use.ru_stime for use in map(resource.getrusage, kinds))


def curve(options: argparse.Namespace, paths: list[str], say: Callable[[str], None]) -> float:
    """The table; returns processor seconds of one more recording."""
    many = f"processes={options.processes}"
    say(f"recordings  {'one: s':>8s} {'CPU s':>8s}  {many + ': s':>14s} {'CPU s':>8s} {'faster':>7s}  same results")
    count, rows = 1, []
    while count <= options.most:
        (one, spent, results), (several, more, others) = (swept(paths, count, name) for name in ("one", many))
        rows.append((count, spent))
        same = "to the bit" if results == others else "NO"
        say(f"{count:10d}  {one:8.2f} {spent:8.2f}  {several:14.2f} {more:8.2f} {one / several:6.2f}x  {same}")
        count *= 2
    (first, cost), (last, most) = rows[0], rows[-1]
    return (most - cost) / max(last - first, 1)


def diagnosed(folder: Path, rig: Path) -> float:
    """Processor seconds of a campaign with a diagnosis; prints what `pneumo fleet` reports about the rig."""
    from pneumo_ros.command.main import main as pneumo

    for date, case in (("1_as_delivered", "healthy"), ("2_after_a_year", "case_2")):
        place = folder / "rig" / date
        place.mkdir(parents=True)
        for path in [*rig.joinpath(case).glob("train_s*"), *rig.joinpath(case).glob("holdout_s*"),
                     *rig.joinpath(case).glob("constant_?1100")]:  # fmt: skip
            (place / path.name).symlink_to(path)
    begun = processor()
    print("\n$ pneumo fleet rigs --executor one")
    pneumo(["fleet", str(folder), "--executor", "one", "--quiet"])
    return 0.5 * (processor() - begun)


def night(name: str, seconds: float) -> str:
    """A sentence: the time that MACHINES machines need, and the processors for one night."""
    hours = MACHINES * seconds / 3600.0
    return (
        f"{name}: {seconds:.2f} s of a processor each; {MACHINES:,} machines: {hours:.1f} h of one, "
        f"{3600.0 * hours / NIGHT:.1f} processors for a night of {NIGHT / 3600.0:.0f} h"
    )


def main() -> int:
    """Measure and print."""
    options = arguments()
    with tempfile.TemporaryDirectory() as folder:
        paths = recorded(Path(folder))
        swept(paths, 1, "one")  # compiles the kernels that are missing
        print(f"{os.cpu_count()} processors")
        each = curve(options, paths, lambda text: print(text, flush=True))
        lines = [night("a recording identified", each)]
        rig = os.environ.get("PNEUMO_RIG")
        if rig and not options.no_diagnosis:
            cost = diagnosed(Path(folder) / "rigs", Path(rig))
            lines.append(night("a campaign of 8 recordings of 20 s identified and diagnosed", cost))
        print("\non paper, from these figures\n" + "\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
