"""`pneumo import`: maps are guessed, tables become recordings, nothing is overwritten."""

import json
from pathlib import Path

import numpy as np
import pytest
from tables.making import MAP, columns, put, text

from pneumo_ros.command.main import main
from pneumo_ros.records import read_recording


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, with a table and its map."""
    monkeypatch.chdir(tmp_path)
    put(tmp_path, "run.csv")
    (tmp_path / "map.yaml").write_text(MAP)
    return tmp_path


def test_a_guessed_map_imports_its_table(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["import", "run.csv", "--guess", "--map", "new.yaml", "--json", "guess.json"]) == 0
    out, err = capsys.readouterr()
    assert "run.csv: 400 rows, 6 columns" in out
    assert "import run.csv --map new.yaml --out bag\n" in err
    told = json.loads((place / "guess.json").read_text())["guess"]
    assert told["signals"]["position"]["column"] == "x (mm)"
    assert main(["import", "run.csv", "--map", "new.yaml", "--out", "bag", "--json", "import.json"]) == 0
    (told,) = json.loads((place / "import.json").read_text())["imported"]
    assert (told["samples"], told["rate_hz"]) == (400, pytest.approx(500.0))
    assert told["signals"]["position"]["high"] == pytest.approx(0.04, rel=1e-3)
    assert told["clock"]["even"]
    assert len(read_recording("bag")) == 400
    assert "even clock: median 2 ms, 90 % within 0 ms, longest gap 2 ms" in capsys.readouterr().out
    assert main(["view", "bag"]) == 0


def test_several_tables_become_recordings_of_their_names(place: Path) -> None:
    put(place, "run.v2.csv", text(columns(300)), zipped=True)
    assert main(["import", "run.csv", "run.v2.csv.gz", "--map", "map.yaml", "--out", "bags"]) == 0
    assert [len(read_recording(place / "bags" / name)) for name in ("run", "run.v2")] == [400, 300]
    put(place, "third.csv", text(columns(200)))
    assert main(["import", "third.csv", "--map", "map.yaml", "--out", "bags"]) == 0
    assert len(read_recording(place / "bags" / "third")) == 200


def test_the_rate_is_chosen(place: Path) -> None:
    assert main(["import", "run.csv", "--map", "map.yaml", "--out", "bag", "--rate", "100"]) == 0
    recording = read_recording("bag")
    assert recording.sample_time == pytest.approx(0.01)
    np.testing.assert_allclose(recording.position[5:-5], 0.04 * np.sin(5.0 * recording.time)[5:-5], atol=4e-5)


def test_nothing_is_overwritten(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["import", "run.csv", "--map", "map.yaml", "--out", "bag"]
    assert main(call) == 0
    before = (place / "bag" / "metadata.yaml").read_bytes()
    assert main(call) == 2
    assert "exists" in capsys.readouterr().err
    assert (place / "bag" / "metadata.yaml").read_bytes() == before
    assert main(["import", "run.csv", "--guess", "--map", "map.yaml"]) == 2
    assert (place / "map.yaml").read_text() == MAP
    (place / "bags" / "run").mkdir(parents=True)
    assert main(["import", "run.csv", "--map", "map.yaml", "--out", "bags"]) == 2


def test_a_table_that_cannot_be_used_is_passed_over(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (place / "bad.csv").write_bytes(b"nothing")
    assert main(["import", "bad.csv", "run.csv", "--map", "map.yaml", "--out", "bags", "--json", "told.json"]) == 1
    assert "Passed over: cannot read bad.csv" in capsys.readouterr().err
    assert list(json.loads((place / "told.json").read_text())["passed_over"]) == ["bad.csv"]
    assert [path.name for path in (place / "bags").iterdir()] == ["run"]
    assert main(["import", "bad.csv", "--map", "map.yaml", "--out", "other"]) == 3
    assert not (place / "other").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["run.csv", "--map", "map.yaml"], 2, "--out is missing"),
        (["run.csv", "--map", "absent.yaml", "--out", "bag"], 2, "--guess --map absent.yaml"),
        (["run.csv", "--map", "map.yaml", "--out", "bag", "--rate", "5"], 2, "20 to 20000 Hz"),
        (["run.csv", "--map", "map.yaml", "--out", "no/such/bag"], 2, "mkdir -p no/such"),
        (["run.csv", "--map", "new.yaml", "--guess", "--out", "bag"], 2, "writes the map only"),
        (["run.csv", "run.csv.gz", "--map", "map.yaml", "--out", "bags"], 2, "would both become"),
        (["absent.csv", "--map", "map.yaml", "--out", "bag"], 3, "there is no absent.csv"),
        ([".", "--map", "map.yaml", "--out", "bag"], 2, "is a folder; name the tables in it"),
    ],
)
def test_wrong_usage_says_what_to_type(
    arguments: list[str], code: int, sentence: str, place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["import", *arguments]) == code
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1
    assert sorted(path.name for path in place.iterdir()) == ["map.yaml", "run.csv"]


def test_an_open_guess_is_not_complete(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = "\n".join(f"{np.sin(k):.4f},{np.cos(1.7 * k):.4f}" for k in range(100))
    put(place, "a.csv", f"a,b\n{rows}\n".encode())
    assert main(["import", "a.csv", "--guess", "--map", "new.yaml"]) == 1
    out = capsys.readouterr().out
    assert "not decided: no column is a time" in out
    assert "complete it" in out
