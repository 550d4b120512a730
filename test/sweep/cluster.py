"""A real Dask cluster for the tests: a scheduler and two workers, processes of their own."""

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

PATIENCE = 240.0  # s: no measure of speed, the machine may be busy
TEST = Path(__file__).parents[1]


def started(stack: ExitStack, log: Path, *words: str) -> "subprocess.Popen[bytes]":
    """A Dask process that ends with `stack`."""
    environment = {"PYTHONPATH": f"{TEST.parent}:{TEST}", "HOME": str(log.parent), "PATH": "/usr/bin:/bin"}
    with log.open("wb") as out:
        process = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]],
            stdout=out, stderr=out, env=environment, cwd=log.parent,
        )  # fmt: skip
    stack.callback(process.wait, PATIENCE)
    stack.callback(process.kill)
    return process


def said(log: Path, pattern: str) -> str:
    """The first group of `pattern` in what a process has said."""
    deadline = time.monotonic() + PATIENCE
    while not (found := re.search(pattern, log.read_text())):
        assert time.monotonic() < deadline, log.read_text()
        time.sleep(0.05)
    return found[1]


@contextmanager
def cluster(folder: Path, workers: int = 2) -> Iterator[str]:
    """Address of the scheduler of a cluster that ends with the block."""
    with ExitStack() as stack:
        log = folder / "scheduler.log"
        started(stack, log, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        address = said(log, r"Scheduler at:\s+(tcp://\S+)")
        logs = [folder / f"worker_{number}.log" for number in range(workers)]
        for one in logs:
            started(stack, one, "worker", address, "--nthreads", "1", "--nworkers", "1", "--no-dashboard")
        for one in logs:
            said(one, r"(Registered to)")
        yield address
