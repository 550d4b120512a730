"""Messages of make on a machine that lacks something, without installing anything."""

import os
import re
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
    """A folder that is the whole PATH: a shell, uname, and no Python."""
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
    program(machine, "python3", "exit 1")  # exit code of the version check
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
    for target in (
        "demo",
        "test",
        "check",
        "slow",
        "bench",
        "paper",
        "fuzz",
        "chaos",
        "endurance",
        "supply",
        "pythons",
    ):
        assert f"make {target} " in done.stdout


def test_continuous_integration_runs_what_a_developer_runs() -> None:
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    assert "\nmake test\n" in script.read_text()
    assert "\nmake check " in script.read_text()


def tool(name: str, *arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    """A script of tools/."""
    return subprocess.run([ROOT / "tools" / name, *arguments], cwd=ROOT, capture_output=True, text=True)


def test_tests_that_fail_are_an_error(machine: Path) -> None:
    program(machine, "python", 'echo "$@"; exit 3')
    everything = tool("run_tests", machine / "python", "-k", "bags")
    assert everything.returncode == 3
    assert "-m not check" in everything.stdout
    assert "-m check" in tool("run_tests", "--check", machine / "python").stdout
    assert "--ignore=test/ros" in tool("run_tests", "--computing", machine / "python").stdout
    assert tool("run_tests", machine / "python", "test/api").stdout == "-m pytest test/api\n"


def test_a_stage_keeps_its_exit_code(machine: Path) -> None:
    program(machine, "fails", "exit 7")
    done = tool("timed", "types", machine / "fails")
    assert done.returncode == 7
    assert re.fullmatch(r"\[types: \d+ s\]\n", done.stdout)


@pytest.mark.parametrize(
    ("text", "seconds", "code", "said"),
    [
        ("exit 0", [], 0, ""),
        ('[ "$2" != supply ]', [], 1, "make check: failed: supply\n"),
        ('[ "$2" != supply ] || exec sleep 30', ["2"], 0, "no time was left to finish: supply pythons\n"),
        ("exit 0", ["-5"], 0, "no time was left to finish: slow supply pythons\n"),
    ],
)
def test_checks_fail_or_have_no_time(text: str, seconds: list[str], code: int, said: str, machine: Path) -> None:
    program(machine, "make", text)
    done = tool("check", machine / "make", *seconds)
    assert done.returncode == code
    assert (done.stdout + done.stderr).endswith(said)


def test_other_pythons_that_are_not_installed_are_named(tmp_path: Path) -> None:
    done = subprocess.run(
        [str(ROOT / "tools" / "other_pythons"), "make"], cwd=tmp_path, capture_output=True, text=True,
        env={"PATH": str(tmp_path), "PYENV_ROOT": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert all(f"Python {version} is not installed" in done.stdout for version in ("3.10", "3.13"))
