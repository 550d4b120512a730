"""Faults at random, in real processes: simulator, controller, recorder, identification, player and workbench.

Processes are killed, stopped and doubled; messages come at 10 kHz, with NaN, too large or with wrong stamps;
disks are full or read only, parameters change at random. After each fault every node must publish finite
numbers; valves must have closed, recordings must be whole, and `kill -9` may cost one second of a recording.

    python benchmarks/chaos.py [--faults 300] [--minutes 60] [--seed 1] [--only WORD]

The seed repeats the order and the choices, not the moments. The exit code is 1 when anything broke.
"""

import argparse
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", type=int, default=300, help="in all (default 300)")
    parser.add_argument("--minutes", type=float, default=60.0, help="time after which no fault starts (default 60)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="faults whose name has this word in it")
    return parser.parse_args()


def main() -> int:
    """Run the campaign, print; 1 if anything broke."""
    import conftest  # a ROS domain of its own, before anything imports rclpy
    from chaos.campaign import campaign, kinds

    options = arguments()
    print(f"seed {options.seed}, ROS domain {conftest.DOMAIN.number}", file=sys.stderr)
    with tempfile.TemporaryDirectory(prefix="pneumo_ros_chaos_") as folder:
        chosen = [name for name in kinds(Path(folder))[0] if options.only in name]
        outcome = campaign(
            Path(folder), options.faults, options.seed, 60.0 * options.minutes, chosen,
            lambda text: print(text, file=sys.stderr, flush=True),
        )  # fmt: skip
    print(f"seed {options.seed}, {outcome.seconds:.0f} s\n{outcome.text()}")
    return int(bool(outcome.broken))


if __name__ == "__main__":
    sys.exit(main())
