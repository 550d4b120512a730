"""Recordings on disk as runs: names, refusals, cuts and notes."""

import shutil
from pathlib import Path

import pytest
from ros.campaign_bags import record_campaign

from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model
from pneumo_ros.reading.read import ReadOptions, read_run, read_runs

AXIS = load_model("axis")


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One run at a constant voltage."""
    return record_campaign(tmp_path_factory.mktemp("bags"), AXIS, (3.0,), 3.0)[0]


def test_runs_of_one_name_are_called_by_their_paths_and_refusals_have_reasons(bag: Path, tmp_path: Path) -> None:
    paths = [str(shutil.copytree(bag, tmp_path / folder / "run")) for folder in "ab"]
    absent = str(tmp_path / "absent")
    shares, refused = list[float](), list[tuple[str, str]]()
    found = read_runs(
        [paths[0], absent, paths[1]], AXIS, progress=shares.append, refuse=lambda *one: refused.append(one)
    )
    assert [run.name for run in found.runs] == paths
    assert list(found.refused) == [absent]
    assert refused == list(found.refused.items())
    assert shares == [0.0, 1 / 3, 2 / 3]
    with pytest.raises(DataError, match="absent"):
        read_runs([*paths, absent], AXIS, required=[absent])
    with pytest.raises(DataError, match=r"none of 1 recordings can be used; the last: .*absent"):
        read_runs([absent], AXIS)


def test_cuts_and_corrections_reach_the_run(bag: Path) -> None:
    found = read_runs([str(bag)], AXIS, cuts={bag.resolve(): ((0.2, 0.4),)})
    (run,) = found.runs
    assert not run.measured[(run.time > 0.2) & (run.time < 0.4)].any()
    with pytest.raises(DataError, match="seem to be exchanged"):
        read_run(bag, AXIS, ReadOptions(words=("swapped-chambers",)))
