"""Every combination of signals through every verb: it is judged as far as it goes, or told what is missing."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from command.combined import JUDGED, REFUSED, arguments, write_all, write_held

from pneumo_ros.command.main import main

QUICK = ("a", "ab", "vabsl", "e", "eabls", "ca", "cbs", "cab", "cabvsel", "li", "ai", "abi")  # the others: make check
EVERY = [pytest.param(name, marks=() if name in QUICK else pytest.mark.check) for name in JUDGED]
SENSOR = re.compile(r"chamber_[ab]/pressure|valve/command|load_cell|effort|supply/pressure")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All recordings."""
    folder = tmp_path_factory.mktemp("combined")
    write_all(folder)
    return folder


def done(capsys: Any, *line: str) -> tuple[int, str, Any]:
    """Exit code, messages and JSON of a verb, whose numbers must all be numbers."""
    code = main([*line, "--json", "-"])
    said = capsys.readouterr()
    assert "Traceback" not in said.err
    assert "NaN" not in said.out
    return code, said.err, json.loads(said.out) if said.out else None


@pytest.mark.parametrize("name", EVERY)
def test_compare_judges_what_was_measured(name: str, folder: Path, capsys: Any) -> None:
    bags, options = arguments(folder, name)
    page = folder / f"{name}.html"
    code, said, found = done(capsys, "compare", *bags, *options, "--report", str(page))
    assert code == 0, said
    assert set(found["equations"]) == JUDGED[name], said
    (line,) = [one for one in said.splitlines() if one.startswith("Judged: ")]
    for equation in ("momentum", "chamber_a", "chamber_b"):
        words = equation.replace("_", " ")
        judged, _, absent = line.partition("Not judged:")
        assert (words in judged) == (equation in JUDGED[name]), line
        if equation not in JUDGED[name]:
            assert words.split()[0] in absent, line
    assert ("Not judged:" not in line) or SENSOR.search(line.partition("Not judged:")[2])
    assert page.stat().st_size > 10_000


@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.parametrize("verb", ["compare", "identify", "view"])
def test_what_tells_nothing_says_what_is_missing(verb: str, name: str, folder: Path, capsys: Any) -> None:
    code, said, _ = done(capsys, verb, *arguments(folder, name)[0])
    assert code == 3
    assert REFUSED[name] in said
    assert "Needed: joint_states, chamber_a/pressure" in said


@pytest.mark.parametrize("name", EVERY)
def test_view_shows_it(name: str, folder: Path, capsys: Any) -> None:
    bags, options = arguments(folder, name)
    code, said, _ = done(capsys, "view", *bags, *options[:1])
    assert code == 0, said


@pytest.mark.check
@pytest.mark.parametrize("name", JUDGED)
def test_identify_takes_it_or_says_what_is_missing(name: str, folder: Path, capsys: Any) -> None:
    bags, options = arguments(folder, name)
    code, said, _ = done(capsys, "identify", *bags, *options)
    assert code in (0, 1, 3), said
    if code == 3:
        assert SENSOR.search(said) or "measured force" in said or "pneumo experiment" in said, said


@pytest.mark.check
@pytest.mark.parametrize("name", JUDGED)
def test_diagnose_takes_it(name: str, folder: Path, capsys: Any) -> None:
    bags, options = arguments(folder, name)
    held = write_held(folder, name)
    out = folder / f"{name}.yaml"
    code, said, found = done(
        capsys, "diagnose", *bags, "--holdout", *held, *options, "--out", str(out), "--report", f"{out}.html"
    )
    assert code in (0, 1), said
    assert found["verdict"] in ("adequate", "effects_found", "unknown_effect")
    assert any(line.startswith("Judged: ") for line in said.splitlines())
    code, said, _ = done(capsys, "compare", *held, *options[:1], "--model", str(out))
    assert code == 0, said


@pytest.mark.check
@pytest.mark.parametrize("name", JUDGED)
def test_add_takes_it(name: str, folder: Path, capsys: Any) -> None:
    bags, options = arguments(folder, name)
    effect = "viscous_friction" if "momentum" in JUDGED[name] else "dead_volume"
    out = folder / f"{name}_more.yaml"
    code, said, _ = done(capsys, "add", effect, *bags, *options, "--out", str(out), "--report", f"{out}.html")
    assert code in (0, 1), said
