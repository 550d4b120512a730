"""Statements and code blocks as a reader runs them: in the page's folder, with the installed commands."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from manual.beside import ANSWERS, at_a_terminal, beside
from manual.pages import ROOT, Statement
from manual.unrun import AT_THE_TOP, INSIDE, SERVING, first, shortened

BOUND = 300.0  # s, until a statement that serves has to be up
UP = re.compile("ready|recording")  # what a node says then
_ASSIGNED = re.compile(r"^\w+=")


def environment(folder: Path) -> dict[str, str]:
    """The commands of this environment first, and the package as it is here; a `make` begun here is the first one.

    PAGE is the folder in which the page's statements run.
    """
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    if not shutil.which("ros2"):
        path += f"{os.pathsep}{Path(__file__).parent / 'without_ros'}"
    kept = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    return kept | {"PATH": path, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1", "PAGE": str(folder)}


def run(statement: Statement, before: list[Statement], folder: Path) -> None:
    """Run a statement after the variables that earlier ones set; one that serves until it is up."""
    pattern, answers = first(SERVING, statement.text), first(ANSWERS, statement.text)
    if pattern:
        serve(shortened(statement.text), re.compile(pattern), folder)
        return
    place = ROOT if re.match(AT_THE_TOP, statement.text) else folder
    with beside(shortened(statement.text), folder, lambda text, folder: serving(text, UP, folder)) as text:
        script = "\n".join([*(one.text for one in before if _ASSIGNED.match(one.text)), text])
        done = typed(["bash", "-c", script], answers, cwd=place, env=environment(folder))
    assert done.returncode in INSIDE, f"{statement.text}\nexit code {done.returncode}\n{done.stdout}{done.stderr}"
    assert "Traceback (most recent call last)" not in done.stderr, (
        f"{statement.text}\n{done.stderr}"
    )  # exit code 1, too


def typed(command: list[str], answers: str | None, **where: Any) -> "subprocess.CompletedProcess[str]":
    """A command without a terminal, or at one where something is answered."""
    if answers:
        return at_a_terminal(command, answers, **where)
    return subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, **where)


def serve(text: str, up: re.Pattern[str], folder: Path) -> None:
    """Start a program that runs until Ctrl-C, wait until it says that it is up, and end it as Ctrl-C does."""
    with serving(text, up, folder):
        pass


@contextmanager
def serving(text: str, up: re.Pattern[str], folder: Path) -> Iterator[None]:
    """A program that is up within the block, and then ends as by Ctrl-C."""
    log = folder / "serving.log"
    with log.open("w") as out:
        program = subprocess.Popen(
            ["bash", "-c", f"exec {text}"], cwd=folder, env=environment(folder), stdout=out, stderr=out
        )
    try:
        end = time.monotonic() + BOUND
        while not up.search(log.read_text()) and program.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
        said = log.read_text()
        assert up.search(said), f"{text}\n{said}"
        assert program.poll() is None, f"{text}\n{said}"
        yield
    finally:
        program.send_signal(signal.SIGINT)
        code = program.wait(BOUND)
    assert code in (0, 130, -signal.SIGINT), f"{text}\nexit code {code}\n{log.read_text()}"


def run_python(text: str, folder: Path) -> None:
    """Run a program of a page; effects that it defines stay in `my_effects.py`, as the pages say."""
    if re.search(r"^class \w+\(Effect\)", text, re.MULTILINE):
        (folder / "my_effects.py").write_text(text)
    (folder / "program.py").write_text(text)
    command = [sys.executable, "program.py"]
    done = subprocess.run(command, cwd=folder, env=environment(folder), capture_output=True, text=True)
    assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"
