"""Verbs end with what to type next, and it can be typed."""

import shlex
from pathlib import Path

import pytest

import pneumo_ros as pn
from pneumo_ros.command.main import VERBS, _verb, main, verb_parser

NOISE = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}  # m, Pa


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of a machine with a payload, in `runs`."""
    folder = tmp_path_factory.mktemp("next")
    axis = pn.load_model("axis")
    heavy = axis.with_effects([*axis.effects, "payload_mass"], {"payload_mass.mass_added": 4.0})
    for k, (name, drive) in enumerate({"one": "sine:4,1.3", "two": "sine:3,0.9"}.items()):
        pn.save(pn.simulate(heavy, drive, seconds=4, noise=NOISE, seed=k, name=name), folder / "runs" / name)
    pn.save_model(heavy, folder / "heavy.yaml")
    return folder


@pytest.mark.parametrize(
    ("line", "verb"),
    [
        ("effects", "effects"),
        ("effects viscous_friction", "add"),
        ("parts", "new"),
        ("view runs/one", "compare"),
        ("compare runs", "diagnose"),
        ("compare runs/one", "diagnose"),
        ("compare runs --model heavy.yaml", "tune"),
        ("add payload_mass runs/one --holdout runs/two --out more.yaml --overwrite", "compare"),
    ],
)
def test_the_last_line_says_what_to_type(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], line: str, verb: str
) -> None:
    monkeypatch.chdir(folder)
    assert main(shlex.split(line)) == 0
    last = [said for said in capsys.readouterr().err.splitlines() if "Next: " in said][-1]
    words = shlex.split(last.partition("Next: ")[2].partition("   #")[0])
    name = words[words.index("pneumo_ros") + 1] if "pneumo_ros" in words else words[1]
    assert name == verb
    if not {"NAME", "BAG...", "OTHER_BAG..."} & {*words}:
        assert verb in VERBS
        verb_parser(verb, _verb(verb)).parse_strictly(words[words.index(verb) + 1 :])
