"""Faulty recordings as a user meets them: a sentence with the fault and the remedy, and the exit code."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command.unfit_bags import LENGTH, write_all

from pneumo_ros.command.main import main
from pneumo_ros.records import read_recording

# recording -> words of the sentence on stderr: the problem, numbers and the remedy
UNFIT = {
    "swapped": ("chamber_a/pressure and chamber_b/pressure seem to be exchanged", "N (momentum)", "swapped-chambers"),
    "bar": ("chamber_a/pressure is 1.0", "as it would be in bar;", "type --read-as bar, or multiply bar by 100000"),
    "kpa": ("chamber_a/pressure is 10", "as it would be in kPa;", "type --read-as kPa, or multiply kPa by 1000"),
    "psi": ("as it would be in psi;", "type --read-as psi, or multiply psi by 6894.76"),
    "bar_gauge": ("as it would be in bar gauge;", "type --read-as bar,gauge,", "add the atmosphere's 1e5 Pa"),
    "one_in_bar": ("chamber_b/pressure is", "as it would be in bar", "multiply bar by 100000 where it is published\n"),
    "gauge": ("falls to", "a vented chamber has the atmosphere's 1e5 Pa: these are gauge", "type --read-as gauge"),
    "drops_out": ("chamber_a/pressure is 0 Pa at 0.077 s", "in 3 of 8000 samples: its sensor drops out", "plug"),
    "dead": ("chamber_b/pressure stays at 101325 Pa, within 0 Pa of noise", "the piston travels", "look at its plug"),
    "noise_alone": ("chamber_b/pressure stays at 3000", "the piston travels", "dead or not connected"),
    "unplugged": ("chamber_b/pressure is -1", "its sensor gives no signal; look at its plug"),
    "no_number": ("none of the 8000 pressures of chamber_a/pressure is a finite number",),
    "no_position": ("joint_states gives 0 finite positions of 'piston' in 8000 messages",),
    "millimetres": ("outside the stroke of axis, -1 to 1 m; if it is in mm, type --read-as mm",),
    "reversed": ("the position seems to count the wrong way", "Type --read-as reversed-position"),
    "wrong_sign": ("valve/command seems to have the wrong sign", "Type --read-as reversed-voltage"),
    "renamed": ("If it is /rod_side, start what publishes it with --ros-args -r /rod_side:=/chamber_b/pressure",),
}
# recording -> words of the notes on stderr; the recording is still used
NOTED = {
    "truncated": ("breaks off after", "Everything up to the break is read"),
    "gaps": ("joint_states: 1 gap of more than 5 sample times (5 ms), the longest 1.5 s at 1.999 s", "is not used"),
    "pressure_gap": ("/chamber_a/pressure: 1 gap", "the longest 1.5 s at 1.999 s", "is not used"),
    "set_back": ("stamps and recorded times jump by -3599.999 s together", "5000 messages, 4.999 s", "Set clocks"),
    "set_forward": ("nothing is recorded for 7200.001 s (recording paused, or clock set forward)", "5000 messages"),
    "stamps_jump": ("stamps jump by +3600.001 s while recorded times go on by 0.001 s", "let NTP or chrony slew them"),
    "stuck": ("the piston does not move for 5.", "s from 2.0", "it is stuck or held by something"),
    "always_stuck": ("the piston does not move: its position stays at", "for 8 s", "friction cannot be judged"),
    "hanging": ("the position repeats", "without any noise for 5.6 s from 2.00", "driver hung"),
    "hanging_pressure": ("chamber_a/pressure repeats", "without any noise for 5.6 s from 2.00"),
    "dead_command": ("valve/command does not change at all, held at 1.5 V, while the piston travels",),
    "no_pressure": ("chamber b (chamber_b/pressure would add it)", "Judged: chamber a, driven by the position."),
    "some_nan": ("4 of 8000 values of position are not finite (first at 0.005 s); these messages are left out",),
}
CORRECTED = {
    "swapped": "swapped-chambers", "bar": "bar", "kpa": "kpa", "psi": "psi", "bar_gauge": "bar,gauge",
    "gauge": "gauge", "millimetres": "mm", "reversed": "reversed-position", "wrong_sign": "reversed-voltage",
}  # fmt: skip
Done = subprocess.CompletedProcess[str]


def pneumo(folder: Path, *arguments: str) -> Done:
    """The command as a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-m", "pneumo_ros", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All recordings; kernels are compiled first, so that their messages are not in the checked text."""
    folder = tmp_path_factory.mktemp("unfit")
    write_all(folder)
    for name in ("good", "no_pressure"):
        assert pneumo(folder, "compare", name).returncode == 0
    return folder


@pytest.mark.parametrize("name", UNFIT)
def test_what_cannot_be_used_is_named_and_nothing_is_written(
    name: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written = [str(folder / f"{name}.{kind}") for kind in ("json", "html")]
    code = main(["compare", str(folder / name), "--json", written[0], "--report", written[1]])
    said = capsys.readouterr()
    assert code == 3, said.err
    assert [words for words in UNFIT[name] if words not in said.err] == [], said.err
    assert said.err.startswith("pneumo: error: ")
    assert said.err.count("\n") == 1
    assert said.out == ""
    assert list(folder.glob(f"{name}.*")) == []


def test_a_process_says_the_same_and_ends_with_that_code(folder: Path) -> None:
    found = pneumo(folder, "compare", "swapped", "--json", "-")
    assert found.returncode == 3
    assert found.stdout == ""
    assert [words for words in UNFIT["swapped"] if words not in found.stderr] == []


def compared(folder: Path, name: str) -> dict[str, Any]:
    """The JSON of `pneumo compare` for the only run."""
    target = folder / f"{name}.json"
    assert main(["compare", str(folder / name), "--json", str(target)]) == 0
    return dict(json.loads(target.read_text())["runs"][0])


@pytest.mark.parametrize("name", NOTED)
def test_what_can_be_used_all_the_same_is_noted(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compared(folder, name)
    said = capsys.readouterr().err
    assert [words for words in NOTED[name] if words not in said] == [], said
    assert all(line.startswith(f"{name}: ") for line in notes(said))


def notes(said: str) -> list[str]:
    """The messages but for what every comparison ends with: what is judged, and what to type next."""
    return [line for line in said.splitlines() if not line.startswith(("Judged: ", "Next: "))]


def test_a_good_recording_is_read_without_a_word(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compared(folder, "good")
    assert notes(capsys.readouterr().err) == []


def test_what_is_left_of_a_broken_recording_is_used(folder: Path) -> None:
    """In a process of its own."""
    found = pneumo(folder, "compare", "truncated", "--json", "-")
    assert found.returncode == 0, found.stderr
    whole, part = read_recording(folder / "good"), read_recording(folder / "truncated")
    assert 0.3 * LENGTH < json.loads(found.stdout)["runs"][0]["samples"] <= len(part) < LENGTH
    np.testing.assert_array_equal(part.position, whole.position[: len(part)])
    np.testing.assert_array_equal(part.pressure_b, whole.pressure_b[: len(part)])


@pytest.mark.parametrize("name", ["gaps", "pressure_gap"])
def test_nothing_in_a_gap_is_judged(name: str, folder: Path) -> None:
    """Of seven adjacent windows of 1 s, those that overlap the missing 1.5 s are left out."""
    good, other = compared(folder, "good"), compared(folder, name)
    assert other["windows"] <= good["windows"] - 2
    for signal, error in good["error"].items():
        assert other["error"][signal]["rms"] < 2.0 * error["rms"]


@pytest.mark.parametrize("name", CORRECTED)
def test_the_advice_helps(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With the option from the sentence, the recording is as good as the good one."""
    assert main(["simulate", "--input", str(folder / name), "--read-as", CORRECTED[name], "--seconds", "0.1",
                 "--out", str(folder / f"{name}_again")]) == 0  # fmt: skip
    assert "error" not in capsys.readouterr().err
    good, again = read_recording(folder / "good"), read_recording(folder / f"{name}_again")
    np.testing.assert_allclose(again.position[0], good.position[0], atol=3e-5)
    np.testing.assert_allclose(again.pressure_a[0], good.pressure_a[0], atol=1500.0)
    np.testing.assert_array_equal(again.voltage, good.voltage[: len(again)])


@pytest.mark.parametrize("name", UNFIT)
def test_identify_refuses_the_same(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", str(folder / name), "--out", str(folder / "found.yaml")]) == 3
    said = capsys.readouterr().err
    assert [words for words in UNFIT[name] if words not in said] == [], said
    assert not (folder / "found.yaml").exists()


LONG = ("dead_command", "some_nan")  # of which identification takes long


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.check if name in LONG else ()) for name in NOTED]
)
def test_identify_notes_the_same(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Some of the random steps last long enough for identification."""
    assert main(["identify", str(folder / name)]) in (0, 1, 3)
    said = capsys.readouterr().err
    assert [words for words in NOTED[name] if words not in said] == [], said


@pytest.mark.parametrize("verb", [["compare"], ["identify"], ["simulate", "--out", "x", "--input"]])
@pytest.mark.parametrize(
    ("option", "code", "words"),
    [
        (["--namespace", "left"], 3, "unknown namespace 'left'"),
        (["--joint", "pistn"], 3, "unknown joint 'pistn'; did you mean piston?"),
        (["--read-as", "bra"], 2, "--read-as: unknown word 'bra'; did you mean bar?"),
        (["--read-as", "bar,psi"], 2, "pressures are in one unit, not in bar and psi"),
    ],
)
def test_every_verb_takes_the_same_options(
    verb: list[str], option: list[str], code: int, words: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*verb, str(folder / "good"), *option]) == code
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
