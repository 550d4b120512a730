"""pneumo export: the files it writes, and what it refuses."""

import json
import subprocess
import zipfile
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


@needs_compiler
@pytest.mark.parametrize(("further", "version"), [((), "3.0"), (("--fmi", "2"), "2.0")])
def test_fmu_of_either_version_is_written(further: tuple[str, ...], version: str, tmp_path: Path) -> None:
    out = tmp_path / "axis.fmu"
    assert main(["export", "fmu", "axis", "--out", str(out), *further]) == 0
    with zipfile.ZipFile(out) as archive:
        text = archive.read("modelDescription.xml").decode()
    assert f'fmiVersion="{version}"' in text


def test_the_mjcf_names_the_machine_file_that_its_cylinder_is_made_of(tmp_path: Path) -> None:
    assert main(["export", "mjcf", "axis", "--out", str(tmp_path / "axis.xml")]) == 0
    assert 'load_model("axis")' in (tmp_path / "axis.xml").read_text()


def test_without_a_compiler_an_fmu_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    assert main(["export", "fmu", "axis", "--out", str(tmp_path / "axis.fmu")]) == 2
    assert "sudo apt install gcc" in capsys.readouterr().err
    monkeypatch.setenv("CC", "no_such_compiler")
    assert main(["export", "fmu", "axis", "--out", str(tmp_path / "axis.fmu")]) == 2
    assert "CC is no_such_compiler" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["d", "axis", "--out", "axis.c"], 2, "unknown format 'd'"),
        (["c", "axis", "--out", "axis.h"], 2, "this file ends in .c: --out axis.c"),
        (["c", "axis"], 2, "--out"),
        (["c", "axis", "--out", "missing/axis.c"], 2, "type: mkdir -p missing"),
        (["c", "axis", "--out", "axis.c", "--fmi", "2"], 2, "--fmi goes with fmu"),
        (["fmu", "axis", "--out", "axis.fmu", "--fmi", "1"], 2, "--fmi is 1; it takes 3 or 2"),
        (["fmu", "axis", "--out", "axis.zip"], 2, "this file ends in .fmu: --out axis.fmu"),
        (["mjcf", "axis", "--out", "axis.mjcf"], 2, "this file ends in .xml: --out axis.xml"),
        (["mjcf", "emps", "--out", "axis.xml"], 2, "emps has no chambers"),
        (["c", "axes", "--out", "axis.c"], 3, "give a YAML file or one of: axis, emps, paper, vane"),
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
