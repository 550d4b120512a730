"""Files and folders appear whole or not at all."""

import os
import stat
from pathlib import Path

import pytest
import yaml

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.files import check_writable, whole_folder, write_whole, yaml_number


def test_a_file_is_replaced(tmp_path: Path) -> None:
    target = tmp_path / "result.txt"
    write_whole(target, "first")
    write_whole(target, "sécond")
    assert target.read_text(encoding="utf-8") == "sécond"
    assert os.listdir(tmp_path) == ["result.txt"]


def test_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "usual").touch()
    write_whole(tmp_path / "ours", b"1")
    assert stat.S_IMODE((tmp_path / "ours").stat().st_mode) == stat.S_IMODE((tmp_path / "usual").stat().st_mode)


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "result.txt"
    write_whole(target, "old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(DataError, match=r"result.txt: No space left on device; the file there is unchanged"):
        write_whole(target, "new")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["result.txt"]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    write_whole(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "new"


def test_a_device_stays_a_device() -> None:
    write_whole("/dev/null", "nothing")
    assert Path("/dev/null").is_char_device()


def test_what_cannot_be_written_is_refused_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="mkdir -p"):
        check_writable(tmp_path / "missing" / "result.txt")
    with pytest.raises(UsageError, match="is a folder"):
        check_writable(tmp_path)


def test_a_folder_appears_when_it_is_complete(tmp_path: Path) -> None:
    with whole_folder(tmp_path / "bag") as folder:
        assert folder.name == "bag"
        folder.mkdir()
        (folder / "data").write_text("1")
        assert not (tmp_path / "bag").exists()
    assert os.listdir(tmp_path) == ["bag"]
    assert os.listdir(tmp_path / "bag") == ["data"]


def test_an_interrupted_folder_vanishes(tmp_path: Path) -> None:
    def work() -> None:
        with whole_folder(tmp_path / "bag") as folder:
            folder.mkdir()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work()
    assert os.listdir(tmp_path) == []


def test_a_folder_is_never_overwritten(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    with pytest.raises(UsageError, match="exists"), whole_folder(tmp_path / "bag"):
        pass


@pytest.mark.parametrize("value", [0.0, 1.0, -0.1, 1e-5, 4.1e-4, 1e16, -2.5e20, 1.7976931348623157e308, 5e-324])
def test_numbers_stay_numbers_in_yaml(value: float) -> None:
    """YAML 1.1 reads 1e-5 and 1.0e20 as text: it needs a point, and a sign before the exponent."""
    assert yaml.safe_load(yaml_number(value)) == value
    assert isinstance(yaml.safe_load(yaml_number(value)), float)
