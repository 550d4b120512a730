"""The files of an identification on a full disk."""

from pathlib import Path

import pytest

from pneumo_ros.axis.identification import result_file
from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model


def test_each_result_gets_a_number_of_its_own(tmp_path: Path) -> None:
    paths = [result_file.store(load_model("axis"), {"a": 1}, tmp_path) for _ in range(3)]
    assert [path.name for path in paths] == ["axis_1.yaml", "axis_2.yaml", "axis_3.yaml"]


def test_a_full_disk_is_reported_and_not_mistaken_for_a_number_in_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise DataError("cannot write: No space left on device")

    monkeypatch.setattr(result_file, "save_model", full)
    with pytest.raises(DataError, match="No space left"):
        result_file.store(load_model("axis"), {}, tmp_path)
