"""pneumo export: the files it writes, and what it refuses."""

import json
import subprocess
from pathlib import Path

import pytest
from export.compiling import COMPILER, STRICT, needs_compiler

from pneumo_ros.command.main import main


@needs_compiler
def test_c_file_and_header_are_written_and_compile(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, data = tmp_path / "my axis.c", tmp_path / "told.json"
    assert main(["export", "c", "axis", "--out", str(out), "--json", str(data)]) == 0
    assert capsys.readouterr().out.startswith("axis written to ")
    told = json.loads(data.read_text())
    assert told["files"] == [str(out), str(tmp_path / "my axis.h")]
    assert COMPILER is not None
    done = subprocess.run([COMPILER, *STRICT, "-c", str(out), "-o", str(tmp_path / "axis.o")], capture_output=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["d", "axis", "--out", "axis.c"], 2, "unknown format 'd'"),
        (["c", "axis", "--out", "axis.h"], 2, "this file ends in .c: --out axis.c"),
        (["c", "axis"], 2, "--out"),
        (["c", "axis", "--out", "missing/axis.c"], 2, "type: mkdir -p missing"),
        (["c", "axes", "--out", "axis.c"], 3, "give a YAML file or one of: axis, emps, paper"),
    ],
)
def test_refusals_say_what_to_type_and_leave_no_file(
    words: list[str], code: int, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["export", *words]) == code
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
