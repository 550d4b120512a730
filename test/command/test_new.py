"""`pneumo new` and `pneumo parts`: a machine file from data sheets, by options or by questions."""

import json
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from pneumo_ros.command.main import main
from pneumo_ros.parts.listing import markdown
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import load_model

DOCS = Path(__file__).parents[2] / "docs" / "parts.md"
PARTS = ["--cylinder", "iso15552-32-250", "--valve", "smc-sy7000"]
USE = ["--supply", "6barg", "--mass", "10", "--mounting", "vertical", "--sensors", "gauge-bar"]


def failed(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The error of a command that ends with exit code 2."""
    assert main(arguments) == 2
    return capsys.readouterr().err


def test_a_machine_of_parts_is_written_with_sources(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "my.yaml"
    assert main(["new", *PARTS, *USE, "--out", str(out), "--json", str(tmp_path / "my.json")]) == 0
    said = capsys.readouterr().out
    assert "bore 32 mm, rod 12 mm, stroke 250 mm" in said
    assert "C 4.1 dm3/(s bar) in, 4.8 dm3/(s bar) out" in said
    assert "--read-as gauge,bar" in said
    text = out.read_text()
    assert "[1] ISO 15552" in text
    assert re.search(r"\[3\] SMC catalogue SY3000/5000/7000, plug-in, p. 15, 16, 220-224, 2021", text)
    assert re.search(r"coulomb_friction: \S+  # \[N\] Coulomb friction force F_c; .*rule friction \[\d+\]", text)
    model = load_model(out)
    assert model["constant_load.load"] == pytest.approx(98.0665)
    result = json.loads((tmp_path / "my.json").read_text())
    coulomb = result["parameters"]["lugre_friction.coulomb_friction"]
    assert coulomb["std"] == model.uncertainty["lugre_friction.coulomb_friction"]
    assert result["signal_v"] == {"extend": 10.0, "retract": -10.0, "closed": 0.0}


def test_the_machine_runs_as_the_verb_says(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "my.yaml"
    assert main(["new", *PARTS, *USE, "--out", str(out), "--predict"]) == 0
    said = capsys.readouterr().out
    assert re.search(r"stroke out +0\.\d+ s, 95 % within 0\.\d+ s to ", said)
    run = tmp_path / "run"
    assert main(["simulate", "--model", str(out), "--input", "constant:10", "--seconds", "1", "--out", str(run)]) == 0
    reached = capsys.readouterr().out
    assert float(re.findall(r"position +\S+ +(\S+)", reached)[0]) == pytest.approx(0.125, abs=1e-3)
    assert main(["compare", str(run), "--model", str(out), "--quiet"]) == 0


def test_sizes_and_flow_replace_parts(tmp_path: Path) -> None:
    out = tmp_path / "own.yaml"
    sizes = ["--bore", "25", "--rod", "10mm", "--stroke", "0.2 m", "--valve-flow", "qn 350 l/min", "--signal", "0,5,10"]
    assert main(["new", *sizes, "--supply", "87 psi", "--mass", "2 kg", "--out", str(out), "--quiet"]) == 0
    model = load_model(out)
    assert model["piston.area_a"] == pytest.approx(4.9087e-4, rel=1e-4)
    assert model["valve_null_offset.offset"] == -5.0
    assert "0 V moves the piston" in re.sub(r"\n# ", " ", out.read_text())


def test_the_largest_servo_valves_have_a_machine(tmp_path: Path) -> None:
    """Their conductance is that at full opening of an arctangent which +-10 V do not reach."""
    out = tmp_path / "large.yaml"
    sizes = ["--bore", "63", "--rod", "20", "--stroke", "300", "--valve-flow", "qn 2000 l/min"]
    assert main(["new", *sizes, "--supply", "6barg", "--mass", "20", "--out", str(out), "--quiet"]) == 0
    assert load_model(out)["choked_flow.conductance_filling"] == pytest.approx(1.603e-7, rel=1e-3)


def test_errors_say_what_to_type(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path / "my.yaml")]
    lacking = failed(["new", "--cylinder", "iso15552-32-250", *out], capsys)
    assert "--valve smc-sy7000" in lacking
    assert "--supply 6barg" in lacking
    assert "--mass 10kg" in lacking
    wrong = ["new", "--cylinder", "iso15552-32-250", "--valve", "smc-sy700", *USE, *out]
    assert "did you mean smc-sy7000" in failed(wrong, capsys)
    assert not (tmp_path / "my.yaml").exists()


def test_a_file_is_never_overwritten_unasked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "my.yaml"
    out.write_text("mine")
    command = ["new", *PARTS, *USE, "--out", str(out), "--quiet"]
    assert "exists; name another file, or add --overwrite" in failed(command, capsys)
    assert out.read_text() == "mine"
    assert main([*command, "--overwrite"]) == 0
    assert load_model(out)["piston.mass"] == 10.0


def test_questions_make_the_same_machine(tmp_path: Path) -> None:
    """In a real terminal; a wrong answer is explained and asked again."""
    answers = [
        "iso15552-32-250",
        "smc-sy700",
        "smc-sy7000",
        "",
        "10",
        "vertical",
        "gauge-bar",
        str(tmp_path / "a.yaml"),
    ]
    master, slave = pty.openpty()
    command = [sys.executable, "-m", "pneumo_ros", "new"]
    with subprocess.Popen(command, stdin=slave, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        os.write(master, ("\n".join(answers) + "\n").encode())
        said = process.communicate(timeout=60)[0]
    os.close(master)
    os.close(slave)
    assert process.returncode == 0, said
    assert "did you mean smc-sy7000" in said
    by_options = tmp_path / "b.yaml"
    assert main(["new", *PARTS, *USE, "--out", str(by_options), "--quiet"]) == 0
    one, other = (yaml.safe_load(path.read_text()) for path in (tmp_path / "a.yaml", by_options))
    assert one == other


def test_without_a_terminal_nothing_is_asked(capsys: pytest.CaptureFixture[str]) -> None:
    assert "pneumo new lacks: --cylinder iso15552-32-250" in failed(["new"], capsys)


def test_parts_are_listed_and_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parts"]) == 0
    listed = capsys.readouterr().out
    assert main(["parts", "list"]) == 0
    assert capsys.readouterr().out == listed
    assert all(name in listed for name in load_shelf().parts)
    assert main(["parts", "show", "smc-sy7000"]) == 0
    shown = capsys.readouterr().out
    assert main(["parts", "smc-sy7000"]) == 0
    assert capsys.readouterr().out == shown
    source = "SMC catalogue SY3000/5000/7000, plug-in, p. 15, 16, 220-224, 2021"
    assert re.search(rf"conductance_exhaust +4.8 dm3/\(s bar\) .*{source}", shown)


def test_parts_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parts", "show", "iso6432-25", "--json", "-"]) == 0
    (part,) = json.loads(capsys.readouterr().out)["parts"]
    assert part["figures"]["bore"]["value"] == 0.025
    assert part["figures"]["bore"]["source"].startswith("ISO 6432")


def test_unknown_parts_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert "did you mean smc-sy7000" in failed(["parts", "show", "smc-sy700"], capsys)
    assert "type: pneumo parts, or pneumo parts show NAME" in failed(["parts", "show"], capsys)
    assert "is no part; type" in failed(["parts", "a", "b"], capsys)


def test_the_documentation_holds_the_tables_of_the_files() -> None:
    """After a change of a part: paste what `pneumo parts --markdown` prints."""
    assert markdown(load_shelf().parts.values()) in DOCS.read_text()
