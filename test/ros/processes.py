"""Nodes of this package, and other programs, as real processes."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

from pneumo_ros.errors import DataError
from pneumo_ros.records import Bag

ROOT = Path(__file__).parents[2]
PATIENCE = 90.0  # s


class Running:
    """A process and its output so far, line by line with the time of arrival."""

    def __init__(self, *command: str, cwd: Path, **variables: str) -> None:
        """`variables` go into its environment."""
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        environment = {**os.environ, "PYTHONPATH": path, **variables}
        self.process = subprocess.Popen(
            [sys.executable, *command],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            cwd=cwd,
            env=environment,
        )
        self.lines: list[tuple[float, str]] = []
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append((time.monotonic(), line.rstrip()))

    @property
    def said(self) -> str:
        """The output so far."""
        return "\n".join(line for _, line in self.lines)

    def wait_for(self, words: str) -> None:
        """Wait until the process prints `words`."""
        deadline = time.monotonic() + PATIENCE
        while words not in self.said:
            assert time.monotonic() < deadline, f"never said {words!r}: {self.said}"
            assert self.process.poll() is None or words in self.said, f"ended before it said {words!r}: {self.said}"
            time.sleep(0.01)

    def end(self, number: int | None = signal.SIGINT, patience: float = PATIENCE) -> int:
        """Exit code after signal `number`, or after its own end when None; `patience` [s] bounds the wait."""
        if number is not None and self.process.poll() is None:
            self.process.send_signal(number)
        code = self.process.wait(patience)
        self._reader.join(PATIENCE)
        return code


@contextmanager
def running(*command: str, cwd: Path, **variables: str) -> Iterator[Running]:
    """A Python process with `command`, which ends with the block at the latest."""
    process = Running(*command, cwd=cwd, **variables)
    try:
        yield process
    finally:
        if process.process.poll() is None:
            process.process.kill()
        process.end(None)


def node(name: str, *ros_args: str, **parameters: object) -> list[str]:
    """Command of a node with ROS parameters. Without a machine file, the plants of tests close their valve at 0 V."""
    if name in ("controller", "experiment") and "--params-file" not in ros_args:
        parameters = {"closed_signal": "0V", **parameters}
    given = [part for key, value in parameters.items() for part in ("-p", f"{key}:={_yaml(value)}")]
    return ["-m", f"pneumo_ros.ros.{name}", "--ros-args", *ros_args, *given]


def recorded(path: Path, topic: str) -> int:
    """How many messages of `topic` are on the disk so far."""
    try:
        return Bag(path).overview().counts.get(topic, 0)
    except DataError:  # no file yet, or no message in it
        return 0


def wait_recorded(path: Path, topic: str, count: int) -> None:
    """Wait until `count` messages of `topic` are on the disk."""
    deadline = time.monotonic() + PATIENCE
    while recorded(path, topic) < count:
        assert time.monotonic() < deadline, f"never {count} messages on {topic}"
        time.sleep(0.1)


def publisher(count: int, *more: str) -> list[str]:
    """Command of the program that publishes numbered messages."""
    return [str(Path(__file__).parent / "publishes.py"), "--count", str(count), *more]


def _yaml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_yaml, value))}]"
    return f'"{value}"' if isinstance(value, str | Path) else str(value)
