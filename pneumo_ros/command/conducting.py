"""Runs a programme on a live plant: a node in its own process runs it and reports line by line."""

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console
from pneumo_ros.command.processes import ros_arguments
from pneumo_ros.errors import PneumoError

if TYPE_CHECKING:
    from pneumo_ros.experiment.programme import Programme

NODE = "pneumo_ros.ros.experiment"


def conduct(
    programme: "Programme", settings: Mapping[str, object], namespace: str, console: Console
) -> tuple[int, dict[str, Any]]:
    """Run it with the node's `settings` in the plant's namespace; exit code, and the node's summary.

    SIGINT and SIGTERM are passed on: the node closes the valve first. It also does so when this process is killed,
    because its standard input then ends. Raises PneumoError when the node ends without a summary.
    """
    from pneumo_ros.experiment.programme_file import programme_text

    with tempfile.TemporaryDirectory() as temporary:
        file, log = Path(temporary) / "programme.yaml", Path(temporary) / "log"
        file.write_text(programme_text(programme), encoding="utf-8")
        given = {**settings, "programme": str(file), "events": True}
        with log.open("wb") as stream:
            process = subprocess.Popen(
                [sys.executable, "-m", NODE, *ros_arguments(given, namespace)],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stream, text=True, env=dict(os.environ),
            )  # fmt: skip
        with _passing_on(process):
            last = _listen(process, console)
            code = process.wait()
        if last is None:
            words = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
            raise PneumoError(f"the experiment ended with exit code {code}: {words[-1] if words else 'no output'}")
    return code, last


def _listen(process: "subprocess.Popen[str]", console: Console) -> dict[str, Any] | None:
    """Show events as they come; returns the summary that comes last, None without one."""
    assert process.stdout is not None
    for line in process.stdout:
        event = json.loads(line)
        kind, text = event.pop("event"), event.pop("text")
        if kind == "outcome":
            console.say(text)
        elif kind != "end":
            console.note(text)
        else:
            code = event.pop("code")
            if code:
                print(f"pneumo: {text}", file=sys.stderr, flush=True)
            else:
                console.note(text)
            return dict(event)
    return None


@contextmanager
def _passing_on(process: "subprocess.Popen[str]") -> Iterator[None]:
    """Pass SIGINT and SIGTERM on to the process during the block; after it, the process has ended."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.signal(number, lambda got, _: process.send_signal(got)) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if process.poll() is None:
            process.kill()
            process.wait()
