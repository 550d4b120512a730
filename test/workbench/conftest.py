"""A workbench in a process of its own over recordings of the independent rig, and a browser that looks at it."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from workbench.leaking import record_leaking
from workbench.tab import Tab


@pytest.fixture(scope="session")
def leaking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two recordings of a machine whose piston leaks, one of them to hold out."""
    folder = tmp_path_factory.mktemp("leaking")
    record_leaking(folder)
    return folder


class Served:
    """A running workbench."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        line = [sys.executable, "-m", "pneumo_ros", "workbench", "--port", "0", *arguments]
        self.process = subprocess.Popen(
            line, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=dict(os.environ)
        )
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().strip()

    @property
    def port(self) -> int:
        """Its address."""
        return int(self.address.split(":")[2].split("/")[0])

    @property
    def token(self) -> str:
        """Its output."""
        return self.address.partition("token=")[2]

    def close(self) -> int:
        """End it as Ctrl-C does; its exit code."""
        self.process.send_signal(2)
        return self.process.wait(30)


@pytest.fixture(scope="module")
def served(leaking: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A workbench with both recordings."""
    running = Served(tmp_path_factory.mktemp("served"), str(leaking))
    yield running
    assert running.close() == 0


@pytest.fixture
def tab(browser: Any, served: Served) -> Iterator[Tab]:
    """A tab of the browser with its own desk, which must have sent requests only to the workbench."""
    opened = Tab(browser, served.address)
    yield opened
    opened.close()
    assert opened.strangers(served.port) == []
    assert opened.complaints == []


@pytest.fixture
def another(browser: Any, served: Served) -> Iterator[Callable[[], Tab]]:
    """Opens more tabs."""
    found: list[Tab] = []

    def more() -> Tab:
        found.append(Tab(browser, served.address))
        return found[-1]

    yield more
    for one in found:
        one.close()
