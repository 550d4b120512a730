"""Inputs of a simulation, and the messages for refused ones."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.command.inputs import parse_drive
from pneumo_ros.errors import DataError, UsageError

TIME = np.arange(0.0, 2.0, 0.25)


def test_constant() -> None:
    assert (parse_drive("constant:-1.1").voltage(TIME) == -1.1).all()


def test_step_begins_with_the_sample_at_its_time() -> None:
    assert parse_drive("step:2.5@0.5").voltage(TIME).tolist() == [0, 0, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5]


def test_sine() -> None:
    np.testing.assert_allclose(
        parse_drive("sine:3,1").voltage(np.array([0.0, 0.25, 0.75])), [0.0, 3.0, -3.0], atol=1e-12
    )


@pytest.mark.parametrize("header", ["", "time,voltage\n", "# by hand\n"])
@pytest.mark.parametrize("separator", [",", ";", ", "])
def test_csv_is_held_from_row_to_row(header: str, separator: str, tmp_path: Path) -> None:
    rows = [(10.0, 0.0), (10.003, 1.5), (10.005, -2.0)]
    path = tmp_path / "drive.csv"
    path.write_text(header + "".join(f"{time}{separator}{volts}\n" for time, volts in rows))
    drive = parse_drive(str(path))
    assert drive.voltage(np.arange(8) * 1e-3).tolist() == [0, 0, 0, 1.5, 1.5, -2, -2, -2]
    assert drive.duration == pytest.approx(0.007)  # the last row lasts as long as the one before


@pytest.mark.parametrize(
    ("content", "line"),
    [("0,1\n1,x\n", "line 2"), ("0,1\n1,2\n1,3\n", "line 3"), ("t,u\n0,1\nnan,2\n", "line 3"), ("0,1\n1\n", "line 2")],
)
def test_a_bad_row_is_named(content: str, line: str, tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(content)
    with pytest.raises(DataError, match=line):
        parse_drive(str(path))


def test_times_beyond_measure_are_refused(tmp_path: Path) -> None:
    (tmp_path / "drive.csv").write_text("0,0\n1e308,0\n")
    with pytest.raises(DataError, match="line 2"):
        parse_drive(str(tmp_path / "drive.csv"))


def test_a_long_bad_row_is_named_in_short(tmp_path: Path) -> None:
    (tmp_path / "drive.csv").write_text(f"0,0\n{5000 * '['}\n")
    with pytest.raises(DataError, match="line 2") as refused:
        parse_drive(str(tmp_path / "drive.csv"))
    assert len(str(refused.value)) < 300 + len(str(tmp_path))


def test_a_csv_with_nothing_in_it_is_refused(tmp_path: Path) -> None:
    (tmp_path / "drive.csv").write_text("time,voltage\n")
    with pytest.raises(DataError, match="0 rows"):
        parse_drive(str(tmp_path / "drive.csv"))


def test_a_missing_csv_is_unreadable_data(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="No such file"):
        parse_drive(str(tmp_path / "none.csv"))


@pytest.mark.parametrize(
    "text", ["constant:", "constant:x", "constant:nan", "step:2", "step:2@x", "sine:3", "sine:3,0", "sine:3,-1"]
)
def test_numbers_that_do_not_fit_get_an_example(text: str) -> None:
    with pytest.raises(UsageError, match="an example is"):
        parse_drive(text)


def test_a_misspelt_form_gets_the_nearest_one() -> None:
    with pytest.raises(UsageError, match="did you mean constant"):
        parse_drive("cnstant:1")


def test_a_path_that_is_not_there_lists_the_forms() -> None:
    with pytest.raises(UsageError, match=r"constant:V, step:V@T, sine:V,HZ, file\.csv"):
        parse_drive("runs/2024:1/bag")
