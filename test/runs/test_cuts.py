"""Seconds of a recording that are left out."""

from pathlib import Path

import numpy as np
import pytest
from identify.making import own

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.runs.cuts import parse_cuts, without
from pneumo_ros.shooting.windows import predict


def test_cut_seconds_are_neither_measured_nor_predicted() -> None:
    model, _, run = own("sweep", seconds=5.0)
    left = without(run, [(0.0, 1.0), (3.0, 5.0)])
    assert run.measured.all()
    assert left.time[left.measured][[0, -1]] == pytest.approx([1.001, 2.999])
    starts = predict(model, left, 0.5).start * run.sample_time
    assert len(starts)
    assert np.all((starts > 1.0) & (starts < 2.5))
    assert without(run, []) is run


def test_cuts_are_gathered_by_recording(tmp_path: Path) -> None:
    (tmp_path / "run:1").mkdir()
    found = parse_cuts([f"{tmp_path}/run:1:2.5-4", f"{tmp_path}/../{tmp_path.name}/run:1:10-11"])
    assert found == {(tmp_path / "run:1").resolve(): ((2.5, 4.0), (10.0, 11.0))}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("run", "takes BAG:FROM-TO"),
        ("{}:1", "of another form"),
        ("{}:4-2", "--cut {}:2-4"),
        ("gone:1-2", "no recording gone"),
    ],
)
def test_a_wrong_cut_is_refused(text: str, sentence: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=sentence.format(tmp_path)):
        parse_cuts([text.format(tmp_path)])


def test_a_recording_cannot_be_cut_away() -> None:
    _, _, run = own("sweep", seconds=5.0)
    with pytest.raises(DataError, match="leave 0 samples of 5000; cut less"):
        without(run, [(0.0, 5.0)])
