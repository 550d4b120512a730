"""Cases of a benchmark in processes of their own; results are kept, so that an interrupted run continues."""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from blind_case import ROOT

from pneumo_ros.sweep import Pool, open_pool, sweep

Result = dict[str, Any]


def add_options(parser: argparse.ArgumentParser, file: str, jobs: int) -> None:
    """Options of a benchmark whose results are kept in `file`, with `jobs` cases side by side by default."""
    parser.add_argument("--jobs", type=int, default=jobs, help=f"cases side by side (default {jobs})")
    parser.add_argument("--executor", metavar="NAME", help="such as dask=tcp://HOST:PORT, in place of --jobs")
    parser.add_argument("--json", type=Path, default=ROOT / ".cache" / file, metavar="FILE", help="results")
    parser.add_argument("--code", help="print results of this code (default: the present code)")


def kept(path: Path) -> Iterator[Result]:
    """Results in the file; an incomplete last line is skipped."""
    for line in path.read_text().splitlines() if path.exists() else ():
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            continue


def run_case(*command: object) -> tuple[str, str]:
    """Output and error output of one case, a script and its arguments, in a process of its own."""
    paths = [str(ROOT), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths)), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, env=environment)
    return done.stdout, "" if done.returncode == 0 else done.stderr or f"ended by signal {-done.returncode}"


def make_pool(options: argparse.Namespace) -> Pool:
    """Threads, because each case has its own process anyway; or the executor of --executor."""
    if options.executor:
        return open_pool(options.executor)
    return Pool(lambda: ThreadPoolExecutor(options.jobs), options.jobs)


def run_all(
    script: Path, jobs: Sequence[tuple[object, ...]], options: argparse.Namespace, summary: Callable[[Result], str]
) -> list[str]:
    """Run `script` with each job's arguments, append what it prints to the file; returns what failed."""
    broken, begun = list[str](), time.monotonic()
    options.json.parent.mkdir(parents=True, exist_ok=True)
    names = {" ".join(map(str, job)): (script, *job) for job in jobs}
    with options.json.open("a") as file, make_pool(options) as pool:
        try:
            for count, done in enumerate(sweep(run_case, names, pool), 1):
                out, problem = done.result
                if problem:
                    broken.append(f"{done.key}: {problem.strip().splitlines()[-1]}")
                file.write("" if problem else out)
                file.flush()
                left = (time.monotonic() - begun) * (len(jobs) / count - 1.0) / 60.0
                text = "failed" if problem else summary(json.loads(out))
                print(f"{count}/{len(jobs)}, {left:.0f} min left: {done.key}: {text}", file=sys.stderr, flush=True)
        except KeyboardInterrupt:
            print("interrupted; the same command goes on from here", file=sys.stderr)
    return broken
