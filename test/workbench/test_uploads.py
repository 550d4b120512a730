"""Names of dropped files, made harmless."""

from pathlib import Path

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.uploads import place


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("run.mcap", "run.mcap"),
        ("run/metadata.yaml", "run/metadata.yaml"),
        ("all my runs/run 1/run_0.mcap", "run 1/run_0.mcap"),
        ("C:\\data\\run\\run.db3", "run/run.db3"),
    ],
)
def test_a_recording_keeps_its_folder(given: str, kept: str, tmp_path: Path) -> None:
    assert place(tmp_path, given) == tmp_path / kept


@pytest.mark.parametrize(
    "given", ["", "..", "../run.mcap", "run/..", ".mcap", "run/.mcap", "x\0.mcap", "x.mcap/..", "-o.mcap", "a" * 200]
)
def test_a_name_that_is_not_plain_is_refused(given: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no plain file name"):
        place(tmp_path, given)


def test_a_link_leads_nowhere(tmp_path: Path) -> None:
    (tmp_path / "uploads").mkdir()
    (tmp_path / "uploads" / "out").symlink_to(tmp_path)
    with pytest.raises(UsageError, match="outside the folder"):
        place(tmp_path / "uploads", "out/run.mcap")


def test_other_kinds_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"x\.py is no part of a recording; these are: \.mcap, \.db3, \.yaml"):
        place(tmp_path, "x.py")
