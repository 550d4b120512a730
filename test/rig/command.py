"""The command line of the rig."""

import argparse
import fnmatch
import time
from collections.abc import Sequence
from pathlib import Path

from .case import Case, runs_for, write_case
from .effects import EFFECTS, OUTSIDE, build, draw, parse
from .excitation import ALL_RUNS

_EPILOG = "effects: " + ", ".join(EFFECTS) + ". Outside any catalogue: " + ", ".join(OUTSIDE) + "."


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "python test/rig",
        description="Record an independent simulation of the axis, with a hidden effect.",
        epilog=_EPILOG,
    )
    parser.add_argument("--out", type=Path, required=True, help="folder to write the recordings to; must not hold any")
    parser.add_argument("--truth", type=Path, help="file for the truth (default: DIR.truth.json beside the folder)")
    parser.add_argument("--seed", type=int, default=0, help="repeats everything, to the byte (default 0)")
    parser.add_argument(
        "--effect",
        action="append",
        default=[],
        metavar="NAME[=SIZE]",
        help="hide this effect, of a drawn size if none is given; give it again for a second effect; "
        "'random' draws one by the seed, 'outside' one that no catalogue has",
    )
    parser.add_argument(
        "--scale", type=float, default=1.0, help="strength of drawn sizes, 1 full (default), 0.2 a fifth"
    )
    parser.add_argument(
        "--wear", type=float, default=0.05, help="share by which base parameters are off (default 0.05)"
    )
    parser.add_argument("--rough", action="store_true", help="add 0.3 N coloured force and 0.5 N friction texture")
    parser.add_argument(
        "--runs",
        nargs="+",
        metavar="PATTERN",
        help=f"runs to make, of {', '.join(ALL_RUNS)}; a * takes runs to the ends only where the effect shows there",
    )
    parser.add_argument("--quiet", action="store_true", help="do not print the hidden effects")
    return parser


def _case(wanted: argparse.Namespace) -> Case:
    scale = (wanted.scale, wanted.scale)
    if wanted.effect == ["outside"]:
        return draw(wanted.seed, 1, scale, True, wanted.wear, wanted.rough)
    if wanted.effect and set(wanted.effect) == {"random"}:
        return draw(wanted.seed, len(wanted.effect), scale, False, wanted.wear, wanted.rough)
    return build(wanted.seed, [parse(text) for text in wanted.effect], wanted.wear, wanted.rough, wanted.scale)


def _runs(case: Case, patterns: Sequence[str] | None) -> list[str]:
    if not patterns:
        return list(runs_for(case))
    fit = [name for name in ALL_RUNS if name in patterns or name in runs_for(case) or not name.endswith("_ends")]
    return [name for name in fit if any(fnmatch.fnmatch(name, pattern) for pattern in patterns)]


def main(arguments: Sequence[str] | None = None) -> int:
    """Write a case folder and its truth; returns 0, or 2 for wrong arguments."""
    parser = _arguments()
    wanted = parser.parse_args(arguments)
    try:
        case = _case(wanted)
    except (KeyError, ValueError) as problem:
        parser.error(str(problem.args[0]))
    names = _runs(case, wanted.runs)
    if not names:
        parser.error(f"no run matches {' '.join(wanted.runs)}; runs: {', '.join(ALL_RUNS)}")
    taken = [name for name in names if (wanted.out / name).exists()]
    if taken:
        parser.error(f"{wanted.out / taken[0]} exists; give another folder")
    _write(case, wanted, names)
    return 0


def _write(case: Case, wanted: argparse.Namespace, names: Sequence[str]) -> None:
    start = time.perf_counter()
    truth = wanted.truth or wanted.out.with_name(wanted.out.name + ".truth.json")
    for run in write_case(case, wanted.out, names, truth):
        reach = f"{run.truth[:, 0].min():+.3f} to {run.truth[:, 0].max():+.3f} m"
        print(f"{run.name:16s} {len(run.stamps) / 1e3:5.1f} s, {reach}", flush=True)
    print(
        f"{len(names)} runs in {wanted.out}, seed {wanted.seed}, {time.perf_counter() - start:.1f} s; truth in {truth}"
    )
    if not wanted.quiet:
        for effect in case.truth["effects"]:
            print(f"hidden: {effect['shape']}, {effect['size']:.4g} {effect['unit']}")
