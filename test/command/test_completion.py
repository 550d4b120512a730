"""Tab in a shell: bash with the script that the verb prints, and the names that each place may have."""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pneumo_ros.command.main import VERBS, _verb, main, verb_parser


def completions(line: str, folder: Path) -> list[str]:
    """What bash offers for `line`, asked as the printed script does."""
    pneumo = folder / "pneumo"
    pneumo.write_text(f'#!/bin/sh\nexec {sys.executable} -m pneumo_ros "$@"\n')
    pneumo.chmod(0o755)
    script = subprocess.run([pneumo, "completion", "bash"], capture_output=True, text=True, check=True).stdout
    words = shlex.split(line) + ([""] if line.endswith(" ") else [])
    asked = f"""
{script}
COMP_LINE={shlex.quote(line)} COMP_POINT={len(line)} COMP_TYPE=9 COMP_KEY=9
COMP_WORDS=({" ".join(map(shlex.quote, words))}) COMP_CWORD={len(words) - 1}
_python_argcomplete pneumo
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", asked], cwd=folder, capture_output=True, text=True, env={**os.environ, "PATH": path}
    )
    return [one.strip() for one in done.stdout.split()]


@pytest.mark.parametrize(
    ("line", "some", "never"),
    [
        ("pneumo di", {"diagnose"}, "compare"),
        ("pneumo effects lug", {"lugre_friction"}, "dead_zone"),
        ("pneumo add visc", {"viscous_friction"}, "lugre_friction"),
        ("pneumo compare --hor", {"--horizon"}, "--model"),
        ("pneumo compare --model ax", {"axis"}, "paper"),
        ("pneumo tune --law sl", {"sliding_mode"}, "pid"),
        ("pneumo view bags/r", {"bags/run_1/"}, "diagnose"),
    ],
)
def test_tab_offers_what_may_stand_there(line: str, some: set[str], never: str, tmp_path: Path) -> None:
    (tmp_path / "bags" / "run_1").mkdir(parents=True)
    found = completions(line, tmp_path)
    assert some <= set(found)
    assert never not in found


@pytest.mark.skipif(shutil.which("fish") is None, reason="no fish; type: sudo apt install fish")
@pytest.mark.parametrize(("line", "offered"), [("pneumo dia", "diagnose"), ("pneumo effects lug", "lugre_friction")])
def test_tab_in_fish(line: str, offered: str, tmp_path: Path) -> None:
    bin_folder = Path(sys.executable).parent
    asked = f"{shlex.quote(str(bin_folder / 'pneumo'))} completion fish | source; complete -C {shlex.quote(line)}"
    path = f"{bin_folder}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["fish", "-c", asked], capture_output=True, text=True, env={**os.environ, "PATH": path, "HOME": str(tmp_path)}
    )
    assert done.stdout.split() == [offered], done.stderr


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_for_each_shell(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    assert "pneumo" in capsys.readouterr().out


def test_another_shell_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "fsh"]) == 2
    assert "did you mean fish" in capsys.readouterr().err


@pytest.mark.parametrize("verb", VERBS)
def test_the_examples_of_a_verb_can_be_typed(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    module = _verb(verb)
    assert len(module.EXAMPLES) > 1
    for line in module.EXAMPLES:
        program, name, *words = shlex.split(line, comments=True)
        assert (program, name) == ("pneumo", verb)
        verb_parser(verb, module).parse_strictly(words[: words.index(">")] if ">" in words else words)
    with pytest.raises(SystemExit):
        main([verb, "--help"])
    assert all(f"  {line}" in capsys.readouterr().out for line in module.EXAMPLES[:1])
