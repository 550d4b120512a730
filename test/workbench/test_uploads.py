"""Names of dropped files, made harmless."""

from pathlib import Path

import pytest
from flask import Flask

from pneumo_ros.errors import UsageError
from pneumo_ros.workbench import uploads
from pneumo_ros.workbench.uploads import accept_uploads, place


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


def test_the_files_of_a_desk_have_a_limit_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(uploads, "_MOST", 100)
    server = Flask("uploads")
    accept_uploads(server, lambda desk: tmp_path)
    browser = server.test_client()
    assert browser.put("/upload/1/a.mcap", data=b"x" * 60).status_code == 204
    refused = browser.put("/upload/1/b.mcap", data=b"x" * 60)
    assert (refused.status_code, refused.text.partition(";")[0]) == (400, "there is no room for more recordings")
    assert browser.put("/upload/1/c.mcap", data=b"x" * 30).status_code == 204
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mcap", "c.mcap"]
