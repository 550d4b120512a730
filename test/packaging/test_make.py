"""What make says when this machine lacks something, without installing anything."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "tools" / "make_venv"


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """A folder of programs to be all that a path holds: a shell, uname, and no Python."""
    for name in ("sh", "uname"):
        found = shutil.which(name)
        assert found is not None
        (tmp_path / name).symlink_to(found)
    return tmp_path


def make_venv(machine: Path, *arguments: str) -> str:
    """Error message of the script that sets up the environment, which must fail."""
    command = [str(SCRIPT), str(machine / "venv"), *arguments]
    done = subprocess.run(command, env={"PATH": str(machine)}, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert not (machine / "venv").exists()
    assert done.stderr.startswith("pneumo_ros: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


def program(folder: Path, name: str, text: str) -> None:
    """An executable shell script."""
    path = folder / name
    path.unlink(missing_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def test_no_python(machine: Path) -> None:
    assert "no Python 3.10 to 3.13 found" in make_venv(machine)


def test_a_python_that_is_too_old_is_passed_over(machine: Path) -> None:
    program(machine, "python3", "exit 1")  # what the check of the version ends with
    assert "no Python 3.10 to 3.13 found" in make_venv(machine)


def test_the_python_asked_for_is_named(machine: Path) -> None:
    assert "PYTHON=python3.9 is not a Python 3.10 to 3.13" in make_venv(machine, "python3.9")


def test_a_python_without_venv(machine: Path) -> None:
    program(machine, "python3", f'case "$*" in *ensurepip*) exit 1;; esac; exec "{sys.executable}" "$@"')
    version = ".".join(map(str, sys.version_info[:2]))
    assert f"sudo apt install python{version}-venv" in make_venv(machine)


def test_a_machine_without_wheels(machine: Path) -> None:
    program(machine, "uname", "echo Linux aarch64")
    message = make_venv(machine)
    assert "this is Linux aarch64" in message
    assert "colcon build" in message


def test_make_alone_says_what_there_is() -> None:
    make = shutil.which("make")
    assert make is not None, "continuous integration calls make"
    done = subprocess.run(
        [make, "--no-print-directory"], cwd=ROOT, capture_output=True, text=True, env=dict(os.environ)
    )
    assert done.returncode == 0
    for target in ("make demo", "make test", "make bench", "make fuzz", "make chaos", "make endurance", "make supply"):
        assert target in done.stdout


def test_continuous_integration_runs_what_a_developer_runs() -> None:
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    assert "\nmake test\n" in script.read_text()


def test_other_pythons_are_told_of_where_there_are_none(tmp_path: Path) -> None:
    done = subprocess.run(
        [str(ROOT / "tools" / "other_pythons"), "make"], cwd=tmp_path, capture_output=True, text=True,
        env={"PATH": str(tmp_path), "PYENV_ROOT": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert all(f"Python {version} is not installed" in done.stdout for version in ("3.10", "3.13"))
