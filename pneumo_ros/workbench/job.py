"""A job: verbs that run one after another, each in its own process; it reports progress and can be cancelled."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

State = Literal["running", "done", "failed", "cancelled"]
# format of `command.console.Progress` without a terminal
_PROGRESS = re.compile(r"(?P<title>[^:]+): (?P<percent>\d+) %(?:, about [^:]+ left)?(?:: (?P<doing>.*))?")
_PATIENCE = 5.0  # s, for a verb to end after SIGTERM
_LONGEST = 120  # letters of a message
_GUESS = 2.0  # s of work before the rest is estimated


@dataclass(frozen=True)
class Line:
    """One verb with its arguments, and its share of the job's time."""

    arguments: tuple[str, ...]
    weight: float = 1.0


@dataclass(frozen=True)
class Status:
    """The state of a job to show: `share` is 0 to 1, `left` [s] is None until it can be estimated."""

    title: str
    state: State
    share: float
    doing: str
    left: float | None
    message: str


class Job:
    """Verbs in `folder`, one after another.

    `done` is called in the job's own thread when all have succeeded, `ended` after the end in every case.
    """

    def __init__(
        self, title: str, lines: Sequence[Line], folder: Path, done: Callable[[], None], ended: Callable[[], None]
    ) -> None:
        self.title, self.lines, self.folder = title, lines, folder
        self._done, self._ended, self._lock = done, ended, threading.Lock()
        self._state: State = "running"
        self._share, self._doing, self._message = 0.0, "starting", ""
        self._start, self._end = time.monotonic(), 0.0
        self._process: subprocess.Popen[str] | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def status(self) -> Status:
        """The present state."""
        with self._lock:
            passed = (self._end or time.monotonic()) - self._start
            known = self._state == "running" and passed > _GUESS and 0.03 < self._share < 1.0
            left = passed * (1.0 - self._share) / self._share if known else None
            return Status(self.title, self._state, self._share, self._doing, left, self._message)

    @property
    def running(self) -> bool:
        """Whether it still runs."""
        return self._state == "running"

    def cancel(self) -> None:
        """End the running verb, and start no other; earlier results stay as they were."""
        with self._lock:
            if self._state == "running":
                self._finish("cancelled", "Cancelled; nothing was changed.")
            process = self._process
        if process is not None and process.poll() is None:
            _signal(process, signal.SIGTERM)
            threading.Thread(target=_insist, args=(process,), daemon=True).start()

    def wait(self, seconds: float | None = None) -> None:
        """Until it has ended, or `seconds` have passed."""
        self._thread.join(seconds)

    def _run(self) -> None:
        total, passed = sum(line.weight for line in self.lines), 0.0
        for line in self.lines:
            if not self._verb(line, passed / total, line.weight / total):
                return
            passed += line.weight
        try:
            self._done()
        except Exception as error:  # the page shows it; a thread would lose it
            with self._lock:
                self._finish("failed", f"{type(error).__name__}: {error}")
            raise
        with self._lock:
            if self._state == "running":
                self._finish("done", "")

    def _verb(self, line: Line, begin: float, part: float) -> bool:
        """Run one verb; returns whether the job continues."""
        with self._lock:
            if self._state != "running":
                return False
            self._process = process = _start(line.arguments, self.folder)
        said: list[str] = []
        assert process.stderr is not None
        with process.stderr as lines:
            for text in lines:
                said.append(text.strip())
                self._hear(text.strip(), begin, part)
        code = process.wait()
        with self._lock:
            if self._state == "running" and code not in (0, 1):
                self._finish("failed", _last_error(said) or f"pneumo {line.arguments[0]} ended with exit code {code}")
            return self._state == "running"

    def _hear(self, text: str, begin: float, part: float) -> None:
        line = _PROGRESS.fullmatch(text)
        with self._lock:
            if line:
                self._share = max(self._share, begin + part * int(line["percent"]) / 100.0)
                self._doing = line["doing"] or line["title"].lower()
            elif text:
                self._doing = text[:_LONGEST]

    def _finish(self, state: State, message: str) -> None:
        self._state, self._message, self._end = state, message, time.monotonic()
        self._share = 1.0 if state == "done" else self._share
        self._ended()


def _start(arguments: Sequence[str], folder: Path) -> "subprocess.Popen[str]":
    """`pneumo ARGUMENTS` in a process group of its own, so that all of it can be ended."""
    log = (folder / f"{arguments[0]}.log").open("wb")
    with log:
        return subprocess.Popen(
            [sys.executable, "-m", "pneumo_ros", *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=log,
            stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
        )  # fmt: skip


def _last_error(said: Sequence[str]) -> str:
    errors = [text.removeprefix("pneumo: error: ") for text in said if text.startswith("pneumo: error: ")]
    return errors[-1] if errors else " ".join(said[-1:])


def _signal(process: "subprocess.Popen[str]", number: int) -> None:
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        return


def _insist(process: "subprocess.Popen[str]") -> None:
    try:
        process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        _signal(process, signal.SIGKILL)
