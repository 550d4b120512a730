"""`pneumo compare --series` and `--cut`: arrays for the user's plots, and seconds that are left out."""

import json
from pathlib import Path

import numpy as np
import pytest
from identify.making import own

from pneumo_ros.command.main import main
from pneumo_ros.records import write_recording


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A recording of the default machine."""
    _, _, run = own("steps", seconds=5.0)
    write_recording(tmp_path / "steps", time=run.time, position=run.position, pressure_a=run.pressure_a,
                    pressure_b=run.pressure_b, voltage=np.append(run.held, run.held[-1]))  # fmt: skip
    return tmp_path / "steps"


def test_series_hold_what_the_numbers_are_of(bag: Path, tmp_path: Path) -> None:
    out, data = tmp_path / "all.npz", tmp_path / "all.json"
    assert main(["compare", str(bag), "--series", str(out), "--json", str(data), "--quiet"]) == 0
    (run,) = json.loads(data.read_text())["runs"]
    with np.load(out) as series:
        assert str(series["1/name"]) == "steps"
        error = series["1/error/position_m"]
        assert np.sqrt(np.nanmean(error.astype(float) ** 2)) == pytest.approx(
            run["error"]["position_m"]["rms"], rel=1e-5
        )
        assert series["1/time"].shape == error.shape == series["1/regime/slide"].shape == (run["samples"],)
        assert series["1/residual/momentum/value"].shape == series["1/residual/momentum/time"].shape
    assert 0.5 < run["error"]["position_m"]["typical_ratio_to_noise"] < 1.5


def test_seconds_are_left_out(bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "cut.npz"
    assert main(["compare", str(bag), "--cut", f"{bag}:1-2", "--series", str(out), "--quiet"]) == 0
    with np.load(out) as series:
        time, error = series["1/time"], series["1/error/position_m"]
    assert np.isnan(error[(time >= 1.0) & (time <= 2.0)]).all()
    assert np.isfinite(error).any()
    assert main(["compare", str(bag), "--cut", "steps", "--quiet"]) == 2
    assert "--cut takes BAG:FROM-TO" in capsys.readouterr().err
