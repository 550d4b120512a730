"""Processes of a demo end together, whatever happens."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pneumo_ros.command.processes import Fleet
from pneumo_ros.errors import PneumoError


def started(fleet: Fleet, name: str) -> bool:
    """Whether a node has started: it has written its ROS log or printed something."""
    return any(fleet.logs.glob("python_*.log")) or (fleet.logs / f"{name}.log").stat().st_size > 0


def wait_for(fleet: Fleet, name: str) -> None:
    """Wait until a node has started, at most 90 s."""
    for _ in range(900):
        fleet.wait(0.1)
        if started(fleet, name):
            return
    pytest.fail("the node did not start within 90 s")


def test_a_node_runs_and_ends_with_zero(tmp_path: Path) -> None:
    with Fleet(tmp_path / "logs") as fleet:
        fleet.start("recorder", "pneumo_ros.ros.recorder", {"output": str(tmp_path / "bag")}, "one")
        wait_for(fleet, "recorder")
        assert fleet.stop() == {"recorder": 0}
    assert (tmp_path / "bag" / "metadata.yaml").exists()


def test_a_node_that_fails_is_reported_with_its_last_words(tmp_path: Path) -> None:
    (tmp_path / "bag").touch()  # not a folder for a recording
    with Fleet(tmp_path / "logs") as fleet:
        fleet.start("recorder", "pneumo_ros.ros.recorder", {"output": str(tmp_path / "bag")})
        with pytest.raises(PneumoError, match=r"the recorder ended with exit code \d: .*bag"):
            fleet.wait(90.0)


def test_nothing_is_left_behind_when_the_block_fails(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), Fleet(tmp_path / "logs") as fleet:  # noqa: PT012  # what fails is the block
        fleet.start("recorder", "pneumo_ros.ros.recorder", {"output": str(tmp_path / "bag")})
        wait_for(fleet, "recorder")
        (process,) = fleet._processes.values()
        raise ZeroDivisionError
    assert process.returncode == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_nothing_is_left_behind_when_the_demo_is_ended(number: signal.Signals, tmp_path: Path) -> None:
    arguments = ["demo", "--out", str(tmp_path / "demo"), "--seconds", "60"]
    with subprocess.Popen([sys.executable, "-m", "pneumo_ros", *arguments], stderr=subprocess.PIPE, text=True) as demo:
        children: list[int] = []
        for _ in range(900):
            time.sleep(0.1)
            listed = Path(f"/proc/{demo.pid}/task/{demo.pid}/children").read_text()
            children = [int(child) for child in listed.split()]
            if len(children) == 3 and (tmp_path / "demo" / "bag").exists():
                break
        assert len(children) == 3
        demo.send_signal(number)
        _, error = demo.communicate(timeout=200)
    assert demo.returncode == 128 + number
    assert "Traceback" not in error
    for child in children:
        with pytest.raises(ProcessLookupError):
            os.kill(child, 0)
