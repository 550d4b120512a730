"""A fleet over weeks, made by the independent simulator under test/rig: which machine's leak grows?

One machine's piston seal leaks more from week to week, the other machine stays as it is; both are recorded with other
motions and other noise every week. Then `pneumo fleet` runs, which knows only the default machine.

    python benchmarks/fleet_of_leaks.py [--seed 3]

The exit code is 1 unless the leak is found in the old machine from its second week on, growing, and nothing in the
other one.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]

WEEK = 7 * 24 * 3600 * 10**9  # ns
LEAKS = (0.0, 3e-11, 6e-11, 1.2e-10)  # kg/(s Pa), week by week
RUNS = ("train_steps", "train_sweep", "train_slow", "holdout_steps", "holdout_sweep", "holdout_slow")
EFFECT = "cross_piston_leakage"
PARAMETER = f"{EFFECT}.conductance"


def record(folder: Path, seed: int) -> None:
    """A folder for each machine, a campaign for each week."""
    from rig import bags, case
    from rig.effects import Wish, build

    for number, (machine, leaks) in enumerate((("old_seal", LEAKS), ("new_seal", (0.0,) * len(LEAKS)))):
        for week, leak in enumerate(leaks):
            worn = build(seed + number, [Wish(EFFECT, leak)] if leak else [])
            this_week = worn._replace(seed=seed + number + 1000 * (week + 1))
            for run in case.make_runs(this_week, RUNS):
                start = case.epoch(0) + week * WEEK
                bags.write(folder / machine / f"week_{week + 1}" / run.name, run, start)


def main() -> int:
    """Record, run `pneumo fleet`, check its answer."""
    from pneumo_ros.command.main import main as pneumo

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=3)
    seed = parser.parse_args().seed
    with tempfile.TemporaryDirectory() as name:
        folder, answer = Path(name) / "fleet", Path(name) / "fleet.json"
        record(folder, seed)
        print("$ pneumo fleet fleet", flush=True)
        pneumo(["fleet", str(folder), "--json", str(answer), "--quiet"])
        old, new = sorted(json.loads(answer.read_text())["machines"], key=lambda one: one["machine"] != "old_seal")
    values = {point["campaign"]: point["value"] for point in old["parameters"].get(PARAMETER, [])}
    print(f"\n{'week':8s} {'leak':>10s} {'found':>10s}   [kg/(s Pa)]")
    for week, leak in enumerate(LEAKS, 1):
        print(f"week_{week:<3d} {leak:10.3g} {values.get(f'week_{week}', 0.0):10.3g}")
    found = [values.get(f"week_{week}", 0.0) for week in range(1, len(LEAKS) + 1)]
    good = set(old["effects"]) == {EFFECT} and found == sorted(set(found)) and not new["effects"]
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
