"""A fleet over weeks, made by the independent simulator under test/rig: which machine's leak grows?

One machine's piston seal leaks more from week to week, the other machine stays as it is; both are recorded with other
motions and other noise every week. Then `pneumo fleet` runs, which knows only the default machine.

    python benchmarks/fleet_of_leaks.py [--seed 3] [--weeks 4] [--motions steps sweep slow]

--weeks 1 records the last week alone, and --motions fewer recordings. The exit code is 1 unless the leak is found in
the old machine as soon as it leaks, growing, and nothing in the other one.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]

WEEK = 7 * 24 * 3600 * 10**9  # ns
LEAKS = (0.0, 3e-11, 6e-11, 1.2e-10)  # kg/(s Pa), week by week
MOTIONS = ("steps", "sweep", "slow")  # each recorded twice a week, once to be held out
EFFECT = "cross_piston_leakage"
PARAMETER = f"{EFFECT}.conductance"


def record(folder: Path, seed: int, weeks: range, motions: Sequence[str]) -> None:
    """A folder for each machine, a campaign for each of the weeks, with the motions."""
    from rig import bags, case
    from rig.effects import Wish, build

    for number, (machine, leaks) in enumerate((("old_seal", LEAKS), ("new_seal", (0.0,) * len(LEAKS)))):
        for week in weeks:
            leak = leaks[week]
            worn = build(seed + number, [Wish(EFFECT, leak)] if leak else [])
            this_week = worn._replace(seed=seed + number + 1000 * (week + 1))
            runs = [f"{part}_{motion}" for part in ("train", "holdout") for motion in motions]
            for run in case.make_runs(this_week, runs):
                start = case.epoch(0) + week * WEEK
                bags.write(folder / machine / f"week_{week + 1}" / run.name, run, start)


def main() -> int:
    """Record, run `pneumo fleet`, check its answer."""
    from pneumo_ros.command.main import main as pneumo

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--weeks", type=int, choices=range(1, 1 + len(LEAKS)), default=len(LEAKS), help="the last ones")
    parser.add_argument("--motions", nargs="+", choices=MOTIONS, default=MOTIONS, help="what is recorded")
    options = parser.parse_args()
    weeks = range(len(LEAKS) - options.weeks, len(LEAKS))
    with tempfile.TemporaryDirectory() as name:
        folder, answer = Path(name) / "fleet", Path(name) / "fleet.json"
        record(folder, options.seed, weeks, options.motions)
        print("$ pneumo fleet fleet", flush=True)
        pneumo(["fleet", str(folder), "--json", str(answer), "--quiet"])
        old, new = sorted(json.loads(answer.read_text())["machines"], key=lambda one: one["machine"] != "old_seal")
    values = {point["campaign"]: point["value"] for point in old["parameters"].get(PARAMETER, [])}
    print(f"\n{'week':8s} {'leak':>10s} {'found':>10s}   [kg/(s Pa)]")
    found = [values.get(f"week_{week + 1}", 0.0) for week in weeks]
    for week, value in zip(weeks, found, strict=True):
        print(f"week_{week + 1:<3d} {LEAKS[week]:10.3g} {value:10.3g}")
    good = set(old["effects"]) == {EFFECT} and found == sorted(set(found)) and not new["effects"]
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
