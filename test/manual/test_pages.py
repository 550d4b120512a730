"""The manual: what it gives to type can be typed, its links lead somewhere, its files are read, and it builds."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from manual.beside import ANSWERS, BESIDE
from manual.pages import PAGES, ROOT, blocks, heading_names, inline, links, statements, worded_links, words
from manual.unrun import ELSEWHERE, MORE, SERVING, UNRUN_CODE

from pneumo_ros.command.main import VERBS, _verb, verb_parser

PLACEHOLDER = re.compile(r"\.\.\.|\b[A-Z]{2,}\b|KIND|\|")


def check_verb(line: str) -> None:
    """A command line of `pneumo` is one that the parser takes."""
    _, verb, *rest = words(line)
    assert verb in VERBS or verb.startswith("-"), line
    if verb in VERBS and rest and not {"-h", "--help"} & set(rest):
        verb_parser(verb, _verb(verb)).parse_strictly(rest)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_line_can_be_typed(page: Path) -> None:
    for one in statements(page):
        if one.text.startswith("pneumo "):
            check_verb(one.text)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_inside_sentences_exist(page: Path) -> None:
    """Verbs with options that the parser knows, targets of make, and programs of Python."""
    targets = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for line in inline(page):
        program, what, *_ = line.split()
        if program == "make":
            assert what in targets, line
        elif program == "python" and not what.startswith("-"):
            assert (ROOT / what).exists(), line
        elif program == "pneumo":
            assert what in VERBS, line
            known = verb_parser(what, _verb(what)).format_help()
            assert all(option in known for option in re.findall(r"(?<= )--[a-z-]+", line)), line


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    for link in links(page):
        if link.startswith(("http:", "https:")):
            continue
        path, _, heading = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not heading or heading in heading_names(target), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_text_of_a_link_says_where_it_leads(page: Path) -> None:
    """Read alone, as a list of links is: more than a word such as "here", and one text for one place."""
    places = dict[str, str]()
    for text, target in worded_links(page):
        assert len(text.strip("`")) > 3, text
        assert text.lower() not in ("here", "this", "this page", "more", "page", "figures", "docs", "link"), text
        assert places.setdefault(text.lower(), target) == target, text


def test_there_is_much_to_follow() -> None:
    """The reading of pages finds what they hold: an error in it would follow nothing and pass."""
    typed = [one.text for page in PAGES for one in statements(page)]
    assert len(typed) > 90
    assert sum(len(links(page)) for page in PAGES) > 70
    assert sum(len(inline(page)) for page in PAGES) > 60
    assert any("\nimport pneumo_ros" in one for one in typed), "a statement of several lines"


@pytest.mark.parametrize("table", [ELSEWHERE, MORE, SERVING, BESIDE, ANSWERS])
def test_exceptions_are_those_of_a_statement_that_exists(table: dict[str, str]) -> None:
    typed = [one.text for page in PAGES for one in statements(page)]
    assert not [pattern for pattern in table if not any(re.match(pattern, one) for one in typed)]


def test_reasons_name_tests_that_exist() -> None:
    named = re.findall(r"test/[\w/.]+\w", " ".join(ELSEWHERE.values()))
    assert len(named) >= 3
    assert not [name for name in named if not (ROOT / name).exists()]


def test_blocks_of_code_are_followed() -> None:
    """A language without a test of its own is listed with the reason."""
    followed = {"import.md": {"yaml"}, "parts.md": {"yaml"}, "export.md": {"c", "modelica"}, "recordings.md": {"yaml"}}
    for page in PAGES:
        for block in blocks(page):
            known = {"python", *followed.get(page.name, ()), *UNRUN_CODE.get(page.name, ())}
            assert block.shell or block.language in ("", "{toctree}") or block.language in known, block.page


def code(page: str, language: str) -> str:
    """The first block of a language on a page of docs/."""
    return next(one.text for one in blocks(ROOT / "docs" / page) if one.language == language)


def test_the_map_of_the_page_is_read() -> None:
    from pneumo_ros.tables.map_file import parse_map

    plan = parse_map(yaml.safe_load(code("import.md", "yaml")))
    assert {"position", "force", "pressure_a"} <= set(plan.signals)


def test_the_rig_of_the_page_is_read(tmp_path: Path) -> None:
    from pneumo_ros.command.rig_file import read_rig

    (tmp_path / "rig.yaml").write_text(code("recordings.md", "yaml"))
    rig = read_rig(str(tmp_path / "rig.yaml"))
    assert rig.machine.endswith("my.yaml")
    assert rig.namespace == "cylinder_1"
    assert rig.topics["chamber_b/pressure"] == "/plc/values:data[1]"


def test_the_part_of_the_page_is_read(tmp_path: Path) -> None:
    from pneumo_ros.command.main import main

    (tmp_path / "my-valve.yaml").write_text(code("parts.md", "yaml"))
    assert main(["parts", "show", "my-valve", "--parts", str(tmp_path)]) == 0


def test_the_machine_file_of_the_page_has_the_names_of_one() -> None:
    from pneumo_ros.plant import load_model

    shown = yaml.safe_load(code("machine_files.md", "yaml"))["/**"]["ros__parameters"]
    axis = load_model("axis")
    assert tuple(shown.pop("effects")) == axis.effects
    assert {f"{section}.{key}": value for section, one in shown.items() for key, value in one.items()}.items() <= dict(
        axis.parameters
    ).items()


def test_the_c_of_the_page_compiles(tmp_path: Path) -> None:
    from export.compiling import COMPILER, STRICT

    from pneumo_ros.command.main import main

    if COMPILER is None:
        pytest.skip("no C compiler; type: sudo apt install gcc")
    assert main(["export", "c", "axis", "--out", str(tmp_path / "axis.c"), "--quiet"]) == 0
    text = f'#include "axis.h"\nint main(void)\n{{\n{code("export.md", "c")}    return o.effort > 0.0 ? 0 : 1;\n}}\n'
    (tmp_path / "page.c").write_text(text)
    command = [COMPILER, *STRICT, "page.c", "axis.c", "-lm", "-o", "page"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert subprocess.run([tmp_path / "page"]).returncode == 0


def test_one_command_counts_what_is_followed() -> None:
    done = subprocess.run([sys.executable, ROOT / "test" / "manual"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert re.search(r"\d+ links lead to files and headings", done.stdout)
    assert re.search(r"\d+ of \d+ command lines are run", done.stdout)


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


def test_the_modelica_of_the_export_moves_the_machine(tmp_path: Path) -> None:
    from pneumo_ros.command.main import main

    rumoca = pytest.importorskip("rumoca", reason="a Modelica compiler; it comes with the extra 'dev'")
    (tmp_path / "my_axis.yaml").write_text((ROOT / "config" / "axis.yaml").read_text())
    machine = tmp_path / "axis.mo"
    assert main(["export", "modelica", str(tmp_path / "my_axis.yaml"), "--out", str(machine), "--quiet"]) == 0
    (tmp_path / "trial").mkdir()
    whole = tmp_path / "trial" / "trial.mo"
    whole.write_text(machine.read_text() + code("export.md", "modelica"))
    found = rumoca.Session().load(str(whole), model="Trial").simulate(t=(0.0, 1.5), dt=0.1)
    assert list(found["m.y"])[-1] > 0.01
