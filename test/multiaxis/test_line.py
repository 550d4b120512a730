"""The shared supply line, fitted to its measured pressure."""

from pathlib import Path

import numpy as np
import pytest
from multiaxis.machines import record, two

from pneumo_ros.multiaxis.line import DETERMINED, fit_line, measured
from pneumo_ros.multiaxis.supply import Timed
from pneumo_ros.reading.read import ReadOptions, read_run

LINE = {"resistance_supply": 2e7, "time_constant": 0.3}
BEGIN = {"resistance_supply": 5e6, "time_constant": 1.0}


def recorded(folder: Path, seed: int, noise: float | None = 2000.0, seconds: float = 5.0) -> dict[str, Timed]:
    """Both axes of a recording on the line."""
    machine, path = two(LINE), folder / f"run_{seed}"
    record(machine, path, seed, seconds, noise)
    found = {}
    for axis, model in machine.axes.items():
        reading = read_run(str(path), model, ReadOptions(namespace=axis, mechanics=True))
        found[axis] = Timed(1e-9 * reading.recording.start_ns, reading.run, model)
    return found


def test_resistance_and_time_constant_are_found_within_their_intervals(tmp_path: Path) -> None:
    runs = [recorded(tmp_path, seed) for seed in (1, 2)]
    assert all(measured(one) for one in runs)
    found = fit_line(runs, BEGIN)
    for name, true in LINE.items():
        assert found.std[name] < 0.05
        assert abs(np.log(found.values[name] / true)) < 4.0 * found.std[name] + 0.01
    assert found.levels == pytest.approx((7e5, 7e5), abs=300.0)
    assert found.residual == pytest.approx(2000.0 / np.sqrt(2.0), rel=0.1)  # of means of two samples
    assert found.undetermined == ()


def test_axes_at_rest_determine_nothing(tmp_path: Path) -> None:
    found = fit_line([recorded(tmp_path, 1, seconds=0.3)], BEGIN)
    assert found.undetermined == ("resistance_supply", "time_constant")
    assert found.std["time_constant"] > DETERMINED


def test_a_line_without_a_sensor_is_not_measured(tmp_path: Path) -> None:
    assert not measured(recorded(tmp_path, 1, noise=None))
    assert not measured({})
