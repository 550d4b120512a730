"""How `make test` finds a browser, without installing anything."""

import shutil
import stat
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "tools" / "chromium"


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """A folder that is the whole PATH: a shell, and nothing else."""
    found = shutil.which("sh")
    assert found is not None
    (tmp_path / "sh").symlink_to(found)
    return tmp_path


def program(folder: Path, name: str, text: str) -> None:
    """An executable shell script that records its call."""
    path = folder / name
    path.write_text(f'#!/bin/sh\necho "{name} $*" >>"{folder}/calls"\n{text}\n')
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def run(machine: Path) -> tuple[str, list[str]]:
    """The script's output, and its calls."""
    done = subprocess.run([str(SCRIPT)], env={"PATH": str(machine)}, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0  # tests continue without a browser
    calls = machine / "calls"
    return done.stdout + done.stderr, calls.read_text().splitlines() if calls.exists() else []


def test_a_browser_that_is_there_is_enough(machine: Path) -> None:
    program(machine, "chromium", "exit 1")
    assert run(machine) == ("", [])


def test_root_installs_it(machine: Path) -> None:
    program(machine, "id", "echo 0")
    program(machine, "apt-get", "exit 0")
    said, calls = run(machine)
    assert said.startswith("Installing Chromium")
    assert calls[-1] == "apt-get -qq install -y --no-install-recommends chromium"


def test_others_get_the_command(machine: Path) -> None:
    program(machine, "id", "echo 1000")
    program(machine, "apt-get", "exit 0")
    said, calls = run(machine)
    assert "To run them: sudo apt-get install chromium" in said
    assert calls == ["id -u"]


def test_a_machine_without_apt_gets_the_name_of_what_is_missing(machine: Path) -> None:
    assert "no Chromium found" in run(machine)[0]


def test_an_installation_that_fails_is_reported(machine: Path) -> None:
    program(machine, "id", "echo 0")
    program(machine, "apt-get", "exit 100")
    assert "could not be installed" in run(machine)[0]
