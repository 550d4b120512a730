"""Nodes as real processes, and their processor time."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

REFERENCE = ("-p", "reference.shape:=sine")
TICKS = os.sysconf("SC_CLK_TCK")


@contextmanager
def nodes(*commands: tuple[str, ...]) -> Iterator[list[int]]:
    """Process numbers of `commands`: module below pneumo_ros.ros, then ROS arguments."""
    environment = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    started = [
        subprocess.Popen(
            [sys.executable, "-m", f"pneumo_ros.ros.{name}", "--ros-args", *args],
            env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        for name, *args in commands
    ]  # fmt: skip
    try:
        yield [process.pid for process in started]
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait(10)


def cpu_seconds(pid: int) -> float:
    """Processor time of a process so far."""
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS
