"""Nodes as processes of their own, in a ROS domain that nobody else on this machine uses."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from types import FrameType

from pneumo_ros.environment import Domain
from pneumo_ros.errors import PneumoError

PATIENCE = 10.0  # s, for a node to end after SIGINT


class Fleet:
    """Processes that start one after another and end together, whatever happens to this one. A context manager.

    Their output goes to files in `logs`, a folder that is made.
    """

    def __init__(self, logs: Path) -> None:
        self.logs = logs
        self._processes: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> "Fleet":
        self.logs.mkdir(parents=True, exist_ok=True)
        self._domain = Domain()
        self._before = signal.signal(signal.SIGTERM, _terminate)
        return self

    def __exit__(self, *failure: object) -> None:
        self.stop()
        signal.signal(signal.SIGTERM, self._before)
        self._domain.close()

    def start(self, name: str, module: str, parameters: Mapping[str, object], namespace: str = "") -> None:
        """Start `python -m module` as node `name` with ROS parameters; numbers keep their kind: 1.0 is a double."""
        command = [sys.executable, "-m", module, *ros_arguments(parameters, namespace)]
        environment = {**os.environ, **self._domain.environment, "ROS_LOG_DIR": str(self.logs.resolve())}
        with self._log(name).open("wb") as log:
            self._processes[name] = subprocess.Popen(
                command, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT
            )

    def wait(self, seconds: float) -> None:
        """Let time pass; PneumoError, with the last line of its log, as soon as a process has ended."""
        end = time.monotonic() + seconds
        self.check()
        while (left := end - time.monotonic()) > 0.0:
            time.sleep(min(left, 0.1))
            self.check()

    def check(self) -> None:
        """PneumoError when a process has ended by itself."""
        for name, process in self._processes.items():
            if process.poll() is not None:
                raise PneumoError(f"the {name} ended with exit code {process.returncode}: {self.last_words(name)}")

    def stop(self) -> dict[str, int]:
        """End all with SIGINT, the last one first; exit codes by name. One that does not end within 10 s is killed."""
        for process in reversed(self._processes.values()):
            _end(process)
        codes = {name: process.returncode for name, process in self._processes.items()}
        self._processes.clear()
        return codes

    def last_words(self, name: str) -> str:
        """The last line a process wrote, and where to read the others."""
        lines = self._log(name).read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return f"{lines[-1] if lines else 'no output'} (its log: {self._log(name)})"

    def _log(self, name: str) -> Path:
        return self.logs / f"{name}.log"


def ros_arguments(parameters: Mapping[str, object], namespace: str = "") -> list[str]:
    """Arguments that give a node parameters and a namespace; numbers keep their kind: 1.0 is a double."""
    given = [part for key, value in parameters.items() for part in ("-p", f"{key}:={_yaml(value)}")]
    return ["--ros-args", *(["-r", f"__ns:=/{namespace}"] if namespace else []), *given]


def _yaml(value: object) -> str:
    """A parameter value as rcl parses it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_yaml, value))}]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _end(process: "subprocess.Popen[bytes]") -> None:
    if process.poll() is not None:
        return
    process.send_signal(signal.SIGINT)
    try:
        process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _terminate(number: int, frame: FrameType | None) -> None:
    """Unwind on SIGTERM, so that no process is left behind."""
    raise SystemExit(128 + number)
