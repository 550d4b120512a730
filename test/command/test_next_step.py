"""Verbs end with what to type next, it can be typed, and it reads the recordings as they were read."""

import json
import shlex
from pathlib import Path

import pytest

import pneumo_ros as pn
from pneumo_ros.command.main import VERBS, _verb, main, verb_parser

NOISE = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}  # m, Pa
LINES = (
    ("effects", "effects"),
    ("effects viscous_friction", "add"),
    ("parts", "new"),
    ("new --bore 25 --rod 10 --stroke 200 --valve-flow 700l/min --supply 6barg --mass 2 --out new.yaml", "simulate"),
    ("simulate --input sine:3,0.9 --seconds 2 --out moved", "compare"),
    ("import run.csv --guess --map guessed.yaml", "import"),
    ("import run.csv --map map.yaml --out imported", "view"),
    ("view runs/one", "compare"),
    ("compare runs", "diagnose"),
    ("compare runs/one", "diagnose"),
    ("compare runs --model heavy.yaml", "tune"),
    ("add payload_mass runs/one --holdout runs/two --out more.yaml --overwrite", "compare"),
    ("diagnose runs/one --holdout runs/two --within 1 --out found.yaml", "compare"),
    ("diagnose runs/one --holdout runs/two --within 1", "diagnose"),
    ("identify constants --out mine.yaml", "compare"),
    ("identify constants", "identify"),
    ("rig check runs/one --model heavy.yaml --out rig.yaml", "compare"),
    ("export c heavy.yaml --out heavy.c", "simulate"),
)  # fmt: skip
ELSEWHERE = {  # verb -> where its last words are looked at, or why it has none
    "tune": "names the node that takes the gains: test/command/test_tune.py",
    "experiment": "test/command/test_experiment.py, with a live plant",
    "commission": "test/command/test_commission.py, with a live plant",
    "demo": "test/command/test_demo.py: it tells a whole story, and ends with the commands for a rig of one's own",
    "fleet": "test/fleet/test_fleet.py",
    "workbench": "prints the address to open",
    "completion": "its output is a script, which shells read at every start",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of a machine with a payload, in `runs`, constant voltages, and a table."""
    folder = tmp_path_factory.mktemp("next")
    axis = pn.load_model("axis")
    heavy = axis.with_effects([*axis.effects, "payload_mass"], {"payload_mass.mass_added": 4.0})
    for k, (name, drive) in enumerate({"one": "sine:4,1.3", "two": "sine:3,0.9"}.items()):
        pn.save(pn.simulate(heavy, drive, seconds=4, noise=NOISE, seed=k, name=name), folder / "runs" / name)
    for k, volts in enumerate((1.2, -1.2, 2.0, -2.0, 5.0, -5.0)):
        start = -0.3 if volts > 0 else 0.3
        one = pn.simulate(axis, f"step:{volts}@0.5", seconds=3, position=start, noise=NOISE, seed=k)
        pn.save(one, folder / "constants" / f"run_{k}")
    pn.save_model(heavy, folder / "heavy.yaml")
    one = pn.read(folder / "runs" / "one")
    one.to_dataframe().to_csv(folder / "run.csv")
    (folder / "map.yaml").write_text(
        "time: {column: time, unit: s}\nsignals:\n  position: {column: position, unit: m}\n"
        "  pressure_a: {column: pressure_a, unit: Pa}\n  pressure_b: {column: pressure_b, unit: Pa}\n"
        "  command: {column: voltage, unit: V}\n"
    )
    return folder


def last_words(said: str) -> list[str]:
    """The words of the last line that says what to type."""
    last = [line for line in said.splitlines() if "Next: " in line][-1]
    words = shlex.split(last.partition("Next: ")[2].partition("   #")[0])
    return words[words.index("pneumo_ros") + 1 :] if "pneumo_ros" in words else words[1:]


@pytest.mark.parametrize(("line", "verb"), LINES)
def test_the_last_line_says_what_to_type(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], line: str, verb: str
) -> None:
    monkeypatch.chdir(folder)
    assert main(shlex.split(line)) in (0, 1)
    words = last_words(capsys.readouterr().err)
    assert words[0] == verb
    if not {"NAME", "BAG...", "OTHER_BAG..."} & {*words}:
        verb_parser(verb, _verb(verb)).parse_strictly(words[1:])


def test_every_verb_has_a_next_step_or_a_reason() -> None:
    assert {shlex.split(line)[0] for line, _ in LINES} | set(ELSEWHERE) == set(VERBS)


def test_quiet_says_nothing_of_it_and_json_stays_json(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    assert main(shlex.split("compare runs/one --quiet --json -")) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert json.loads(said.out)["schema_version"] == 1
    assert main(shlex.split("simulate --input constant:1 --seconds 0.5 --out still --quiet")) == 0
    assert "Next" not in "".join(capsys.readouterr())


def test_recordings_are_read_again_as_they_were(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Options for units and zero, and the rig file, are part of what comes next; the held-out ones are by name."""
    monkeypatch.chdir(folder)
    one = pn.simulate("axis", "sine:4,1.3", seconds=3, noise=NOISE, name="hold_1")
    shifted = one.position + 1.0
    from dataclasses import replace

    for name in ("hold_1", "run_1", "run_2"):
        pn.save(replace(one, position=shifted, name=name), folder / "wired" / name)
    assert main(["compare", "wired/run_1", "--model", "heavy.yaml"]) == 3
    assert "if it is zero at an end, type --read-as zero=1000mm; pneumo rig check finds" in capsys.readouterr().err
    assert main(["compare", "wired", "--model", "heavy.yaml", "--read-as", "zero=1000mm"]) == 0
    words = last_words(capsys.readouterr().err)
    fitted, held = ["wired/run_1", "wired/run_2"], ["--holdout", "wired/hold_1"]
    assert words == ["diagnose", *fitted, *held, "--model", "heavy.yaml", "--read-as", "zero=1000mm"]
    (folder / "shifted.yaml").write_text("rig: {machine: heavy.yaml, read_as: zero=1000mm}\n")
    assert main(["compare", "wired", "--rig", "shifted.yaml"]) == 0
    assert last_words(capsys.readouterr().err) == ["diagnose", *fitted, *held, "--rig", "shifted.yaml"]
    (folder / "lighter.yaml").write_text((folder / "heavy.yaml").read_text())
    assert main(["compare", "wired", "--rig", "shifted.yaml", "--model", "lighter.yaml"]) == 0
    said = capsys.readouterr().err
    assert "Machine: lighter.yaml, in place of heavy.yaml, which shifted.yaml names" in said
    assert last_words(said) == ["diagnose", *fitted, *held, "--rig", "shifted.yaml", "--model", "lighter.yaml"]
