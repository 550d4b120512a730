"""What a statement needs beside it: a plant that it moves, a node that it calls, a cluster, answers at a terminal."""

import os
import pty
import subprocess
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

from manual.unrun import first
from sweep.cluster import cluster

RIG = "simulator --ros-args --params-file sheet.yaml -r __ns:=/rig -p wired_as:=bar,gauge"
BESIDE = {  # pattern of a statement -> the program that runs meanwhile
    r"pneumo commission --model my.yaml --closed 0V --out": "simulator --ros-args --params-file my.yaml",
    r"pneumo commission --model my.yaml --closed 0V --sensors": "simulator --ros-args --params-file my.yaml "
    "-p wired_as:=bar,gauge",
    r"pneumo commission --model sheet.yaml --sensors gauge-bar --namespace rig": RIG,
    r"pneumo experiment constant-voltage --namespace rig --out": "simulator --ros-args -r __ns:=/rig",
    r"ros2 service call /rig/commission/start": "commission --ros-args -r __ns:=/rig -p model:=my.yaml "
    "-p closed_signal:=5V -p sensors:=gauge-bar -p output:=called.yaml",
    r"ros2 param set /simulator seal_leak": "simulator --effects my_effects.py --ros-args --params-file found.yaml",
}
ANSWERS = {  # pattern of a statement -> what is typed, a line for each question
    r"pneumo new$": "iso15552-32-250\nsmc-sy7000\n6barg\n10\nhorizontal\ngauge-bar\nasked.yaml\n",
}
CLUSTER = "tcp://host:8786"  # an address in a statement, in whose place a cluster of this machine stands


@contextmanager
def beside(text: str, folder: Path, serving: Callable[[str, Path], AbstractContextManager[None]]) -> Iterator[str]:
    """Run what the statement needs; yield the statement, with the address of the cluster that runs here."""
    program = first(BESIDE, text)
    if program:
        with serving(program, folder):
            yield text
    elif CLUSTER in text:
        with cluster(folder) as address:
            yield text.replace(CLUSTER, address)
    else:
        yield text


def at_a_terminal(command: list[str], answers: str, **where: Any) -> "subprocess.CompletedProcess[str]":
    """A command with a terminal at which the answers are typed."""
    master, slave = pty.openpty()
    try:
        os.write(master, answers.encode())
        return subprocess.run(command, stdin=slave, capture_output=True, text=True, **where)
    finally:
        os.close(master)
        os.close(slave)
