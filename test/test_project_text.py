"""Texts of the project: the README starts with two commands, figures name their command, nothing is private."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCS = sorted((ROOT / "docs").glob("*.md"))
TEXT = (".py", ".md", ".rst", ".toml", ".cfg", ".xml", ".yaml", ".yml", ".txt", ".sh", ".c", "")
# Paths of one machine, and home folders of other users
MACHINE_PATHS = re.compile(r"(?<![\w.$})<])/(work|tmp|root|home/\w+|opt/pypi)\b")
PRIVATE = re.compile(r"\b(issue #?\d+|pypi[-.]\w+/simple)\b", re.IGNORECASE)


def project_files() -> list[Path]:
    """Text files of the project: those in git, or those of the folder without git."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode == 0 and listed.stdout:
        paths = [ROOT / name for name in listed.stdout.split("\0") if name]
    else:
        paths = [path for path in ROOT.rglob("*") if not any(part.startswith(".") for part in path.parts)]
    return [path for path in paths if path.suffix in TEXT and path.is_file() and path != Path(__file__)]


def private_words(path: Path) -> list[str]:
    """Places where a file names one machine or private things: file, line and word."""
    lines = path.read_text(encoding="utf-8").splitlines()
    found = (
        (k, match[0]) for k, line in enumerate(lines, 1) for p in (MACHINE_PATHS, PRIVATE) for match in p.finditer(line)
    )
    return [f"{path.relative_to(ROOT)}:{k}: {word}" for k, word in found]


def test_text_holds_nothing_of_one_machine() -> None:
    files = project_files()
    assert len(files) > 500
    assert not [found for path in files for found in private_words(path)]


def code_blocks(text: str) -> list[str]:
    """Contents of the fenced blocks of a Markdown text."""
    return re.findall(r"^```\w*\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_readme_begins_with_two_commands() -> None:
    first = code_blocks(README)[0].strip().splitlines()
    assert [line.partition("#")[0].split() for line in first] == [["make", "demo"], ["make", "test"]]


def test_every_table_of_figures_names_the_command_that_prints_it() -> None:
    """A block that shows printed figures starts with its command, `$ command`."""
    for block in code_blocks(README):
        if re.search(r"\d+\.\d+ (us|ns|ms|s|x|MB)\b", block):
            assert block.startswith("$ "), block


def test_the_readme_can_be_read_in_a_minute() -> None:
    assert len(README.encode()) < 12_000


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md", *(f"docs/{p.name}" for p in DOCS)])
def test_files_that_pages_name_exist(page: str) -> None:
    for link in re.findall(r"\]\((?!https?:|#)([^)#]+)", (ROOT / page).read_text(encoding="utf-8")):
        assert (ROOT / page).parent.joinpath(link).exists(), link


def test_every_page_is_reached_from_the_readme() -> None:
    seen, left = set(), ["README.md"]
    while left:
        page = left.pop()
        links = re.findall(r"\]\((?!https?:|#)([^)#]+\.md)", (ROOT / page).read_text(encoding="utf-8"))
        new = {str((ROOT / page).parent.joinpath(link).resolve().relative_to(ROOT)) for link in links} - seen
        seen |= new
        left += sorted(new)
    assert {f"docs/{p.name}" for p in DOCS} <= seen


def test_verbs_the_readme_shows_exist() -> None:
    from pneumo_ros.command.main import VERBS

    shown = set(re.findall(r"^(?:\$ )?pneumo (\w+)", "\n".join(code_blocks(README)), re.MULTILINE))
    assert shown <= set(VERBS)
    assert set(VERBS) <= set(re.findall(r"pneumo (\w+)", README)), "the README leaves a verb out"
