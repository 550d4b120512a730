"""Statements and code blocks as a reader runs them: in the page's folder, with the installed commands."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

from manual.pages import ROOT, Statement
from manual.unrun import INSIDE, SERVING, first, shortened

BOUND = 300.0  # s, until a statement that serves has to be up
_ASSIGNED = re.compile(r"^\w+=")


def environment() -> dict[str, str]:
    """The commands of this environment first, and the package as it is here."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return os.environ | {"PATH": path, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}


def run(statement: Statement, before: list[Statement], folder: Path) -> None:
    """Run a statement after the variables that earlier ones set; one that serves until it is up."""
    pattern = first(SERVING, statement.text)
    if pattern:
        serve(shortened(statement.text), re.compile(pattern), folder)
        return
    assigned = [one.text for one in before if _ASSIGNED.match(one.text)]
    script = "\n".join([*assigned, shortened(statement.text)])
    done = subprocess.run(
        ["bash", "-c", script], cwd=folder, env=environment(), capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    assert done.returncode in INSIDE, f"{statement.text}\nexit code {done.returncode}\n{done.stdout}{done.stderr}"


def serve(text: str, up: re.Pattern[str], folder: Path) -> None:
    """Start a program that runs until Ctrl-C, wait until it says that it is up, and end it as Ctrl-C does."""
    log = folder / "serving.log"
    with log.open("w") as out:
        program = subprocess.Popen(
            ["bash", "-c", f"exec {text}"], cwd=folder, env=environment(), stdout=out, stderr=out
        )
    try:
        end = time.monotonic() + BOUND
        while not up.search(log.read_text()) and program.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
        said = log.read_text()
        assert up.search(said), f"{text}\n{said}"
        assert program.poll() is None, f"{text}\n{said}"
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
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True)
    assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"
