"""The manual: every command line in it can be typed, its tutorial runs, and it builds without a warning."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from pneumo_ros.command.main import VERBS, _verb, verb_parser

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMAND = re.compile(r"^(?:\\$ )?(pneumo [a-z].*)$")


def blocks(page: Path) -> list[str]:
    """The shell blocks of a page."""
    return re.findall(
        r"^```(?:sh|shell|bash|console)\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )


def command_lines(page: Path) -> list[str]:
    """The lines of `pneumo` in its shell blocks, continued ones joined, without comments and without `...`."""
    joined = "\n".join(blocks(page)).replace("\\\n", " ")
    found = (match[1] for line in joined.splitlines() if (match := COMMAND.match(line.strip())))
    return [line for line in found if "..." not in line and "NAME" not in line]


def words(line: str) -> list[str]:
    """The arguments as a shell gives them; what follows a pipe, a redirection or && belongs to others."""
    lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
    lexer.whitespace_split = True
    given = list(lexer)
    ends = [k for k, word in enumerate(given) if word in ("|", ">", ">>", "&&", "&", ";", "<")]
    return given[: min(ends, default=len(given))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_line_can_be_typed(page: Path) -> None:
    for line in command_lines(page):
        _, verb, *rest = words(line)
        assert verb in VERBS or verb.startswith("-"), line
        if verb in VERBS and not {"-h", "--help"} & set(rest):
            verb_parser(verb, _verb(verb)).parse_strictly(rest)


def test_there_are_command_lines_to_look_at() -> None:
    assert sum(len(command_lines(page)) for page in PAGES) > 60


@pytest.mark.check
def test_the_tutorial_runs_block_by_block_in_an_empty_folder(tmp_path: Path) -> None:
    program = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": program, "PYTHONPATH": str(ROOT)}
    for block in blocks(ROOT / "docs" / "tutorial.md"):
        done = subprocess.run(["bash", "-c", block], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, block + done.stdout + done.stderr
    assert "viscous_friction" in (tmp_path / "better.yaml").read_text()
    assert (tmp_path / "my_cascade.yaml").exists()


@pytest.mark.check
def test_the_manual_builds_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("sphinx")
    pytest.importorskip("furo")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(ROOT / "docs"), str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    effects = (tmp_path / "reference" / "effects.html").read_text(encoding="utf-8")
    assert "No picture" not in re.sub("No picture: effects of .axis. read measured signals", "", effects)
    assert effects.count("<img") > 20
