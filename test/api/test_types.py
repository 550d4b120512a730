"""Types of the surface, as a strict checker of a user's program sees them."""

import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest

import pneumo_ros as pn

ROOT = Path(__file__).parents[2]
PROGRAM = """
import pneumo_ros as pn

axis = pn.load_model("axis")
run = pn.simulate(axis, "sine:3,0.5", seconds=2)
pn.save(run, "run")
reveal_type(pn.read("run").position)
reveal_type(pn.import_table("run.csv"))
compared = pn.compare([run, "other"], axis, fit="third")
reveal_type(compared.explained)
reveal_type(compared.plot())
reveal_type(pn.identify(run).undetermined)
found = pn.diagnose(run, run, "my.yaml", within=60)
reveal_type(found.verdict)
reveal_type(found.added[0].parameters)
reveal_type(found.rows())
reveal_type(pn.add("viscous_friction", run).model)
reveal_type(pn.parts(kind="valve"))
pn.compare(run, modle=axis)
pn.simulate(axis, seconds="ten")
"""
REVEALED = (
    "numpy.ndarray[", "pneumo_ros.records.recording.Recording", "bool", "matplotlib.figure.Figure", "dict[str, str]",
    "str", "dict[str, pneumo_ros.diagnose.outcome.Value]", "list[dict[str, Any]]", "pneumo_ros.plant.model.Model",
    "dict[str, pneumo_ros.parts.part.Part]",
)  # fmt: skip
DATA = [one for one in (getattr(pn, name) for name in pn.__all__) if is_dataclass(one)]


@pytest.mark.check
def test_a_strict_checker_knows_every_result_and_refuses_wrong_arguments(tmp_path: Path) -> None:
    (tmp_path / "user.py").write_text(PROGRAM)
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "user.py"]
    done = subprocess.run(command, cwd=tmp_path, env={"MYPYPATH": str(ROOT)}, capture_output=True, text=True)
    own = [line for line in done.stdout.splitlines() if line.startswith("user.py:")]
    revealed = [line.partition('Revealed type is "')[2] for line in own if "Revealed" in line]
    assert len(revealed) == len(REVEALED), done.stdout + done.stderr
    for line, expected in zip(revealed, REVEALED, strict=True):
        assert line.startswith(expected), (line, expected)
    errors = [re.sub(r"^user.py:\d+: ", "", line) for line in own if ": error: " in line]
    assert len(errors) == 2, errors
    assert 'Unexpected keyword argument "modle" for "compare"; did you mean "model"?' in errors[0]
    assert '"seconds"' in errors[1]


def test_the_package_says_that_it_is_typed() -> None:
    assert (Path(pn.__file__).parent / "py.typed").exists()


@pytest.mark.parametrize("kind", DATA, ids=lambda kind: kind.__name__)
def test_data_are_frozen_and_every_field_is_explained(kind: Any) -> None:
    """In a docstring, or in a comment at the field that gives unit or meaning."""
    assert kind.__dataclass_params__.frozen
    own = Path(sys.modules[kind.__module__].__file__ or "").read_text(encoding="utf-8")
    words = "\n".join(one.__doc__ or "" for one in kind.__mro__)
    for field in fields(kind):
        at = re.search(rf"^    {field.name}: [^\n#]*(# )?", own, re.MULTILINE)
        assert (at and at[1]) or re.search(rf"\b{field.name}\b", words), f"{kind.__name__}.{field.name}"


def test_there_are_data_to_look_at() -> None:
    assert {"Recording", "Result", "DiagnosisResult"} <= {kind.__name__ for kind in DATA}
