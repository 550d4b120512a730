"""Pressures of sealed chambers that were recorded after the position are taken at their own times, and it is said."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.late import lateness
from pneumo_ros.reading.read import read_run
from pneumo_ros.records import read_recording, write_recording
from pneumo_ros.runs.run import run_for

SPRING = """/**:
  ros__parameters:
    effects: [imposed_motion, heat_exchange]
    piston: {mass: 250.0, area_a: 0.0127, area_b: 0.0115, stroke: 2.0}
    air: {supply_pressure: 101325.0, atmospheric_pressure: 101325.0, gas_constant: 296.8, temperature: 293.0,
      heat_capacity_ratio: 1.4}
    chambers: {volume_a: 0.06, volume_b: 0.03}
    heat_exchange: {rate: RATE, share: 0.0, film: 0.0}
"""
DT, N = 0.02, 6000
IMPOSED = {"map": {"motion": "imposed"}}


def recorded(folder: Path, late: float, rate: float) -> tuple[Path, Model]:
    """A gas spring in irregular motion, whose pressures were recorded `late` [s], and its machine file."""
    (folder / "spring.yaml").write_text(SPRING.replace("RATE", str(rate)))
    model, time, random = load_model(folder / "spring.yaml"), DT * np.arange(N), np.random.default_rng(2)
    y = 0.35 * np.sin(0.9 * time) + 0.3 * np.sin(1.7 * time + 1.0)
    held = np.column_stack([np.zeros(N - 1), np.diff(y) / DT])
    begin = model.state(y=y[0], p_a=1e6, p_b=5e5)
    states = np.vstack([begin, model.simulate(held, begin, sample_time=DT)])
    p_a, p_b = (np.interp(time - late, time, states[:, k]) + random.normal(0.0, 300.0, N) for k in (2, 3))
    position = y + random.normal(0.0, 1e-4, N)
    write_recording(folder / "run", time=time, position=position, pressure_a=p_a, pressure_b=p_b, description=IMPOSED)
    return folder / "run", model


@pytest.mark.parametrize("rate", [0.02, 0.5])
@pytest.mark.parametrize("late", [0.3, 0.0, -0.2])
def test_a_delay_is_found_whatever_the_heat(late: float, rate: float, tmp_path: Path) -> None:
    path, model = recorded(tmp_path, late, rate)
    found = lateness(model, run_for(read_recording(path), model))
    assert found == pytest.approx(late, abs=0.03)


def test_it_is_taken_back_and_said(tmp_path: Path) -> None:
    path, model = recorded(tmp_path, 0.3, 0.1)
    reading = read_run(path, model)
    assert any("the pressures were recorded 0.3 s after the position" in note for note in reading.notes)
    assert abs(lateness(model, reading.run)) < 0.03
    assert np.corrcoef(reading.recording.pressure_a, reading.run.pressure_a)[0, 1] < 0.999
