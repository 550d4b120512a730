"""The whole round with real processes, started as the launch file says: an experiment on a rig is recorded, the
identification refits the machine, and a simulator with wrong friction, once corrected, follows the rig.
"""

import json
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from ros.following import follow
from ros.launching import commands
from ros.probe import LATCHED, probe
from ros.processes import Running, running
from std_msgs.msg import String

from pneumo_ros.experiment.programme_file import read_programme
from pneumo_ros.plant import load_model, save_model
from pneumo_ros.records import read_recording

pytestmark = pytest.mark.check  # test_experiment and test_identification hold its two halves

TRUTH = load_model("axis")
FRICTION = {
    "lugre_friction.coulomb_friction": 105.0,
    "lugre_friction.static_friction": 150.0,
    "lugre_friction.stribeck_velocity": 0.02,
    "quadratic_drag.coefficient": 6500.0,
}
GUESS = TRUTH.with_parameters(FRICTION)
TRIALS = ["constant_p0830", "constant_m0830", "constant_p1000", "constant_m1000", "constant_p3000", "constant_m3000"]
SHOWN = "constant_p1000"  # the recording that the twin is to follow
WITHIN = 0.002  # m
LONG = 120.0  # s: the machine may be busy


class Round(NamedTuple):
    """The results: distances [m] of the twin from the rig's recording with the friction found and with that of the
    guess again, results published and exit codes.
    """

    found: np.ndarray
    guessed: np.ndarray
    started_wrong: bool
    result: dict
    codes: dict[str, int]
    folder: Path


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Round:
    """The round."""
    folder = tmp_path_factory.mktemp("round")
    save_model(TRUTH, folder / "rig.yaml")
    save_model(GUESS, folder / "guess.yaml")
    write_programme(folder)
    given = {"rig_params": "rig.yaml", "twin_params": "guess.yaml", "programme": "programme.yaml"}
    with launched(folder, **given, real_time_factor="0.0", timeout="20.0") as nodes, probe("twin") as twin:
        results = twin.hear("/identified/identification/result", String, LATCHED)
        wrong = all(twin.get("simulator", name) == value for name, value in FRICTION.items())
        codes = {"rig/experiment": ended(nodes["rig/experiment"]), "rig/simulator": nodes["rig/simulator"].end()}
        twin.wait(lambda: results and complete(json.loads(results[-1].data)), "all trials on the twin", LONG)
        recording = read_recording(folder / "runs" / SHOWN)
        found = follow(twin, recording)
        assert twin.set("simulator", **{name.replace(".", "__"): v for name, v in FRICTION.items()}) == (True, "")
        guessed = follow(twin, recording)
        codes |= {name: nodes[name].end() for name in ("identified/identification", "twin/simulator")}
    return Round(found, guessed, wrong, json.loads(results[-1].data), codes, folder)


def write_programme(folder: Path) -> None:
    """A short experiment, planned for the guess as by a user."""
    line = "-m pneumo_ros experiment constant-voltage --voltages 0.83 1 3 --seconds 2.5 --model guess.yaml --write"
    with running(*line.split(), "programme.yaml", cwd=folder) as command:
        assert command.end(None) == 0, command.said


@contextmanager
def launched(place: Path, **arguments: object) -> Iterator[dict[str, Running]]:
    """Everything the launch file starts, ended with the block."""
    with ExitStack() as stack:
        yield {
            name: stack.enter_context(running(*command, cwd=place))
            for name, command in commands("identify.launch.py", place, **arguments).items()
        }


def ended(process: Running) -> int:
    """Exit code of a process that ends by itself."""
    deadline = time.monotonic() + LONG
    while process.process.poll() is None:
        assert time.monotonic() < deadline, process.said
        time.sleep(0.05)
    return process.end(None)


def complete(result: dict) -> bool:
    """Whether a result covers all trials, and was set on the twin or refused."""
    return len(result["recordings"]) == len(TRIALS) and result["applied"] is not None


def test_the_rig_was_taken_through_all_trials_slowest_first_and_inside_the_limits(played: Round) -> None:
    summary = json.loads((played.folder / "runs" / "experiment.json").read_text(encoding="utf-8"))
    assert summary["complete"]
    assert [trial["name"] for trial in summary["trials"]] == TRIALS
    programme = read_programme(played.folder / "programme.yaml")
    recordings = [read_recording(played.folder / "runs" / name) for name in TRIALS]
    assert sorted(one.start_ns for one in recordings) == [one.start_ns for one in recordings]
    for one in recordings:
        assert one.warnings == ()
        assert one.velocity is None
        assert np.abs(one.position).max() < programme.end
        assert np.ptp(one.position) > 0.02


def test_every_process_ended_well(played: Round) -> None:
    assert set(played.codes) == {"rig/experiment", "rig/simulator", "identified/identification", "twin/simulator"}
    assert set(played.codes.values()) == {0}


def test_friction_was_found_from_a_wrong_guess(played: Round) -> None:
    assert sorted(played.result["recordings"]) == sorted(TRIALS)
    found = {name: one["value"] for name, one in played.result["parameters"].items()}
    for name, tolerance in (
        ("lugre_friction.coulomb_friction", 0.01),
        ("quadratic_drag.coefficient", 0.01),
        ("lugre_friction.static_friction", 0.05),
    ):
        assert found[name] == pytest.approx(TRUTH[name], rel=tolerance)


def test_the_twin_was_corrected_and_the_machine_file_says_so(played: Round) -> None:
    applied = played.result["applied"]
    assert played.started_wrong
    assert applied["successful"], applied
    assert applied["target"] == "/twin/simulator"
    written = played.folder / played.result["machine_file"]
    assert written.parent == played.folder / "identified"
    machine = load_model(written)
    assert all(machine[name] == value for name, value in applied["parameters"].items())


def test_the_twin_follows_the_rig_with_the_friction_found_and_not_with_the_guess(played: Round) -> None:
    assert played.found.max() < WITHIN
    assert played.guessed.max() > 20.0 * WITHIN
