"""The paper, reproduced: machine files hold its tables, and docs/paper.md shows what the command prints."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pneumo_ros as pn

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
CLOSE = 0.02  # share by which numbers of the page may differ on another machine
WHOLE = 150_000  # bytes of a picture


@pytest.fixture
def paper(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The modules that reproduce the paper."""
    monkeypatch.syspath_prepend(str(ROOT))
    from benchmarks.paper import models, tables

    return models, tables


def test_machine_files_hold_what_the_tables_print(paper: Any) -> None:
    _, tables = paper
    assert not tables.read_rightly(pn.load_model("paper"))
    assert not tables.read_rightly(pn.load_model("axis"))
    worn = pn.load_model("axis").with_parameters({"piston.mass": 5.1})
    assert [one.symbol for one in tables.read_rightly(worn)] == ["M"]


def test_the_map_without_bristles_is_that_of_the_model(paper: Any) -> None:
    """Where the piston slides, friction with bristles and the map alone are the same force."""
    models, _ = paper
    axis = pn.load_model("axis")
    bare = models.without_bristles(axis)
    assert "z" in axis.states
    assert "z" not in bare.states
    speeds = []
    for model in (axis, bare):
        moved = pn.simulate(model, "constant:7", seconds=2.0, position=-0.9)
        speeds.append(moved.velocity[-1])
    assert speeds[0] == pytest.approx(0.1827, abs=5e-5)
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-6)
    free = pn.simulate(models.without_friction(axis), "constant:7", seconds=0.4, position=-0.9)
    assert free.velocity[-1] > 2.0


def test_arrivals_and_distances_of_a_known_motion(paper: Any) -> None:
    _, tables = paper
    one = pn.simulate("axis", "step:7@0.5", seconds=11.5, position=-0.95)
    late = int(np.argmax(one.position > tables.REACHED))
    assert tables.arrival(one) == pytest.approx(one.time[late] - 0.5)
    assert tables.distance(one, one) == 0.0
    assert tables.last_speed(pn.simulate("axis", "constant:7", seconds=4.0)) == pytest.approx(0.1827, abs=1e-4)


def test_pictures_of_the_page_are_small() -> None:
    named = re.findall(r"\((pictures/[^)]*)\)", PAGE)
    assert len(named) == 2
    assert all((ROOT / "docs" / name).stat().st_size < WHOLE for name in named)


@pytest.mark.check
def test_the_page_shows_what_the_command_prints(tmp_path: Path) -> None:
    """Every line of the printed tables is on the page, but for the last digits of its numbers."""
    command = [sys.executable, "-m", "benchmarks.paper", "--pictures", str(tmp_path / "drawn")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    shown = re.findall(r"^```\n(Table 1\n.*?)^```", PAGE, re.DOTALL | re.MULTILINE)[0]
    words, printed = shown.split(), done.stdout.split()
    assert len(words) == len(printed)
    for word, new in zip(words, printed, strict=True):
        assert word == new or value(word) == pytest.approx(value(new), rel=CLOSE), (word, new)
    assert {one.name for one in (tmp_path / "drawn").iterdir()} == {"paper_figure_4.png", "paper_figure_6.png"}
    assert all(20_000 < one.stat().st_size < WHOLE for one in (tmp_path / "drawn").iterdir())


def value(word: str) -> float:
    """The number in a word such as `(4546.7`."""
    return float(word.strip("(),"))
