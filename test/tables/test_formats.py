"""Every format gives the same table, packed or not; what is damaged or not read is named with what to type."""

import json
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from hiding import environment_without
from tables.making import FORMATS, columns, put, text

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.tables.reading import READERS, read_table


@pytest.mark.parametrize("zipped", [False, True])
@pytest.mark.parametrize("file", FORMATS)
def test_every_format_gives_the_same_columns(file: str, zipped: bool, tmp_path: Path) -> None:
    table = read_table(put(tmp_path, file, zipped=zipped))
    for name, values in columns().items():
        found = (
            "data." + name.split(" ")[0] if file == "run.mat" else name.replace(" ", "") if "spaces" in file else name
        )
        np.testing.assert_array_equal(table.columns[table.column(found)], values)
    assert not table.notes
    assert len(table) == 400


def test_every_reader_is_tried() -> None:
    tried = {READERS[Path(file).suffix] for file in FORMATS}
    assert tried == set(READERS.values())


def test_single_values_are_constants(tmp_path: Path) -> None:
    assert read_table(put(tmp_path, "run.mat")).constants == {"gain": 1.5}
    assert read_table(put(tmp_path, "records.json")).constants == {"mass": 0.5}


def test_a_header_may_have_comments_before_and_units_below(tmp_path: Path) -> None:
    rows = "Logger 3.1;;\nDate: today\n\nTime;Pos;p1\ns;mm;bar\n0,00;1,5;6,1\n0,01;1,6;6,2\n0,02;1,7;6,3\n"
    table = read_table(put(tmp_path, "a.csv", rows.encode()))
    assert list(table.columns) == ["Time (s)", "Pos (mm)", "p1 (bar)"]
    assert table.columns["Pos (mm)"].tolist() == [1.5, 1.6, 1.7]


def test_a_table_without_header_has_numbered_columns(tmp_path: Path) -> None:
    table = read_table(put(tmp_path, "a.csv", b"0,1.5\n0.1,1.6\n0.2,1.7\n"))
    assert list(table.columns) == ["column 1", "column 2"]
    assert len(table) == 3


def test_header_and_numbers_may_be_cut_otherwise(tmp_path: Path) -> None:
    table = read_table(put(tmp_path, "a.exp", b"#time(s),Pos(in)\n  0.00 4.1\n  0.02 4.2\n  0.04 -4.3\n"))
    assert list(table.columns) == ["time(s)", "Pos(in)"]
    assert table.columns["Pos(in)"].tolist() == [4.1, 4.2, -4.3]


def test_empty_cells_are_nan_and_texts_are_named(tmp_path: Path) -> None:
    table = read_table(put(tmp_path, "a.csv", b"t,x,state\n0,1.5,on\n0.1,,off\n0.2,NaN,on\n0.3,1.7,on\n"))
    np.testing.assert_array_equal(table.columns["x"], [1.5, np.nan, np.nan, 1.7])
    assert table.texts == ("state",)
    with pytest.raises(UsageError, match="'state' holds text"):
        table.column("state")


def test_dates_are_seconds(tmp_path: Path) -> None:
    table = read_table(
        put(tmp_path, "a.csv", b"t,x\n2021-07-26T10:51:44.25Z,1\n2021-07-26T10:51:44.50Z,2\n2021-07-26T10:51:45Z,4\n")
    )
    np.testing.assert_allclose(np.diff(table.columns["t"]), [0.25, 0.5], atol=1e-6)


def test_a_cut_last_row_is_left_out_and_said(tmp_path: Path) -> None:
    data = text(columns())[:-12].rpartition(b",")[0]
    table = read_table(put(tmp_path, "a.csv", data))
    assert len(table) == 399
    assert "1 of 400 rows" in table.notes[0]


def test_fields_that_a_record_lacks_are_nan(tmp_path: Path) -> None:
    rows = [{"t": 0.0, "a": {"p": 1.0}}, {"t": 0.1}, {"t": 0.2, "a": {"p": 3.0}, "on": True}]
    table = read_table(put(tmp_path, "a.jsonl", "\n".join(map(json.dumps, rows)).encode()))
    np.testing.assert_array_equal(table.columns["a.p"], [1.0, np.nan, 3.0])
    np.testing.assert_array_equal(table.columns["on"], [np.nan, np.nan, 1.0])


@pytest.mark.parametrize(
    ("file", "data", "sentence"),
    [
        ("a.csv", b"", "is empty"),
        ("a.csv", b"# only\n# comments\n", "comments only"),
        ("a.csv", b"just\nwords\nhere\n", "no row of 1 cells with numbers"),
        ("a.csv", b"\x00\x01\x02\x03" * 50, "binary data"),
        ("a.csv", b"t,x\n0,1\n", "1 rows"),
        ("a.csv.gz", b"\x1f\x8b\x08\x00damaged", "cannot be unpacked"),
        ("a.mat", b"MATLAB 7.3 MAT-file, Platform: GLNXA64" + b" " * 200, "-v7"),
        ("a.mat", b"MATLAB 5.0 MAT-file" + b"x" * 300, "as a MAT-file"),
        ("a.npz", b"PK\x03\x04damaged", "as a file of numpy"),
        ("a.npy", b"\x93NUMPYdamaged", "as a file of numpy"),
        ("a.parquet", b"PAR1damaged", "as Parquet"),
        ("a.json", b'{"t": [0, 1', "as JSON"),
        ("a.json", b'"text"', "a single value"),
        ("a.json", b'{"mass": 1}', "no columns"),
        ("a.jsonl", b'{"t": 0}\n{"t": 1}\n[2]\n', "line 3"),
        ("a.jsonl", b'{"t": 0}\nnothing\n', "line 2"),
        ("a.jsonl", b'{"t": "x"}\n{"t": "y"}\n', "no column of numbers"),
    ],
)
def test_what_cannot_be_read_is_named(file: str, data: bytes, sentence: str, tmp_path: Path) -> None:
    path = put(tmp_path, file, data)
    with pytest.raises(DataError, match=sentence) as error:
        read_table(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(("place", "value"), [(233, 239), (1345, 134)])
def test_damaged_mat_files_end_in_words_even_where_their_reader_crashes(place: int, value: int, tmp_path: Path) -> None:
    """Both end scipy's reader by a signal: version 1.17 crashes."""
    spoilt = bytearray(FORMATS["run.mat"](columns(20)))
    assert spoilt[place] != value
    spoilt[place] = value
    with pytest.raises(DataError, match=r"a\.mat"):
        read_table(put(tmp_path, "a.mat", bytes(spoilt)))


def test_any_name_of_a_variable_is_read(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "a.mat", {"file": np.arange(5.0), "arr_0": np.arange(5.0) ** 2})
    assert list(read_table(tmp_path / "a.mat").columns) == ["file", "arr_0"]


def test_pickled_objects_are_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", x=np.array([{"run": "me"}], dtype=object))
    with pytest.raises(DataError, match="pickle"):
        read_table(tmp_path / "a.npz")


def test_absent_files_folders_and_other_formats_say_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="there is no"):
        read_table(tmp_path / "absent.csv")
    with pytest.raises(UsageError, match="is a folder; name the tables"):
        read_table(tmp_path)
    with pytest.raises(UsageError, match="save the sheet as CSV"):
        read_table(tmp_path / "a.xlsx")


def test_parquet_without_its_library_says_what_to_type(tmp_path: Path) -> None:
    import subprocess
    import sys

    path = put(tmp_path, "run.parquet")
    (tmp_path / "map.yaml").write_text("time: t\n")
    call = [sys.executable, "-m", "pneumo_ros", "import", str(path), "--map", str(tmp_path / "m.yaml"), "--guess"]
    done = subprocess.run(call, env=environment_without(tmp_path, "pyarrow"), capture_output=True, text=True)
    assert done.returncode == 2
    assert "pip install pyarrow" in done.stderr
