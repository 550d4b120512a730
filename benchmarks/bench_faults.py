"""Which faults the tests notice: each is made alone in a copy of a checkout, and the test that fails is named.

The faults are those of benchmarks/faults.yaml. For each the tests that mirror its place run first, then wider ones, up
to the first that fails; a failure counts when the same test passes without the fault. Results are kept in a file by
commit and fault: the next call continues one that ran out of time. Give the options with which `make test` calls
pytest, if it leaves tests out.

    python benchmarks/bench_faults.py [--tree .] [--minutes 20] [--only WORDS] [--pytest "-m 'not check'"]
"""

import argparse
import json
import shlex
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml
from faulty_copy import NOTHING_CHOSEN, PASSED, TIME_IS_UP, FaultyCopy

HERE = Path(__file__).parent
STAGES = (("tests", 150.0), ("wider", 300.0))  # s for each, at most
TRIES = 3  # tests of one stage that fail without the fault, too, before the stage is given up

Fault = dict[str, Any]
Result = dict[str, Any]


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=Path, default=HERE.parent, help="checkout to test, as committed (default: this)")
    parser.add_argument("--results", type=Path, default=HERE.parent / ".cache" / "faults.json", help="JSON to continue")
    parser.add_argument("--minutes", type=float, default=20.0, help="time after which no fault is started (default 20)")
    parser.add_argument("--only", default="", help="faults with these words in their name, or in a pattern of tests")
    parser.add_argument("--again", action="store_true", help="repeat those that were not noticed")
    parser.add_argument("--pytest", type=shlex.split, default=[], help="further options of pytest")
    return parser.parse_args()


def tried(copy: FaultyCopy, fault: Fault) -> Result:
    """Whether, by which test and in which stage a fault is noticed; `noticed` is None when the time was up first."""
    forms = dict(zip(_listed(fault["find"]), _listed(fault["replace"]), strict=True))
    try:
        path, text = copy.place_of(tuple(forms))
    except LookupError as error:
        return {"noticed": None, "by": f"no such code: {error}", "stage": "", "seconds": 0.0}
    spent, late = 0.0, False
    for stage, most in STAGES:
        tests = copy.existing(fault.get(stage, ()))
        noticed, by, seconds = _stage(copy, path, text, forms[text], tests, most) if tests else (False, "", 0.0)
        spent += seconds
        if noticed:
            return {"noticed": True, "by": by, "stage": stage, "seconds": round(spent, 1)}
        late |= noticed is None
    return {"noticed": None if late else False, "by": "", "stage": "", "seconds": round(spent, 1)}


def _listed(entry: str | list[str]) -> list[str]:
    return entry if isinstance(entry, list) else [entry]


def _stage(
    copy: FaultyCopy, path: Path, text: str, instead: str, tests: Sequence[str], most: float
) -> tuple[bool | None, str, float]:
    """Noticed, by which test, seconds; None when the time was up."""
    spent, left_out = 0.0, list[str]()
    for _ in range(TRIES):
        skipped = [f"--deselect={test}" for test in left_out]
        ran = copy.faulty(path, text, instead, [*tests, *skipped], most)
        spent += ran.seconds
        if ran.code in (PASSED, NOTHING_CHOSEN):
            return False, "", spent
        if ran.code == TIME_IS_UP:
            return None, "", spent
        if copy.sound(ran.failed, most):
            return True, ran.failed, spent
        left_out.append(ran.failed)
    return None, "", spent


def table(faults: Sequence[Fault], results: dict[str, Result], commit: str) -> str:
    """A line for each fault that was tried, and the totals."""
    done = [(fault["name"], results[key]) for fault in faults if (key := f"{commit} {fault['name']}") in results]
    words = {True: "noticed", False: "MISSED", None: "no answer"}
    lines = [f"{'fault':58s} {'':9s} {'s':>6s}  by"]
    lines += [f"{name:58s} {words[one['noticed']]:9s} {one['seconds']:6.1f}  {one['by']}" for name, one in done]
    counts = {word: sum(one["noticed"] is value for _, one in done) for value, word in words.items()}
    near = sum(one["stage"] == "tests" for _, one in done)
    lines.append(
        f"{len(done)} of {len(faults)} faults at {commit[:10]}: {counts['noticed']} noticed, {near} of them by the "
        f"mirrored tests; {counts['MISSED']} missed; {counts['no answer']} without an answer in time"
    )
    return "\n".join(lines)


def main() -> int:
    """Try the faults that have no result yet, as long as there is time; print all results of this commit."""
    options, begin = arguments(), time.monotonic()
    faults: list[Fault] = yaml.safe_load((HERE / "faults.yaml").read_text(encoding="utf-8"))
    wanted = [f for f in faults if options.only in f["name"] or any(options.only in t for t in f["tests"])]
    results = json.loads(options.results.read_text()) if options.results.exists() else {}
    options.results.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="pneumo_faults_") as place:
        copy = FaultyCopy(options.tree.resolve(), Path(place), options.pytest)
        for fault in wanted:
            key = f"{copy.commit} {fault['name']}"
            known = key in results and (results[key]["noticed"] or not options.again)
            if known or time.monotonic() - begin > 60.0 * options.minutes:
                continue
            results[key] = tried(copy, fault)
            options.results.write_text(json.dumps(results, indent=1))
            print(f"{fault['name']}: {results[key]}", file=sys.stderr, flush=True)
    print(table(wanted, results, copy.commit))
    return 0


if __name__ == "__main__":
    sys.exit(main())
