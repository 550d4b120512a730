"""The maps of benchmarks/real fit the published tables; PNEUMO_REAL names their folder."""

import importlib.util
import os
from pathlib import Path

import numpy as np
import pytest
import yaml

from pneumo_ros.plant import load_model
from pneumo_ros.records import read_recording, read_topics
from pneumo_ros.tables.map_file import load_map

ROOT = Path(__file__).parents[1]
REAL = Path(os.environ.get("PNEUMO_REAL", ""))
needs_tables = pytest.mark.skipif("PNEUMO_REAL" not in os.environ, reason="PNEUMO_REAL names no folder of real tables")
PSI, INCH = 6894.757293168, 0.0254


@pytest.mark.parametrize("path", sorted((ROOT / "benchmarks" / "real").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_map_is_read(path: Path) -> None:
    assert "position" in load_map(path).signals


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Every real table as a recording, by the command that is shipped."""
    found = importlib.util.spec_from_file_location("import_all", ROOT / "benchmarks" / "real" / "import_all.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    out = tmp_path_factory.mktemp("real")
    assert module.import_all(REAL, out) == 0
    return out


@needs_tables
def test_gas_spring(bags: Path) -> None:
    """Its force over both pressures gives the areas of bore and rod; positive extends the rod."""
    for path in sorted((bags / "mbari").iterdir()):
        recording = read_recording(path)
        assert recording.imposed
        assert recording.sample_time == pytest.approx(0.02)
        stroke = 2.03
        assert np.abs(recording.position).max() < stroke / 2.0
        assert np.corrcoef(np.gradient(recording.position, recording.time), recording.velocity)[0, 1] > 0.999
        assert np.corrcoef(recording.position, recording.pressure_a)[0, 1] < -0.9
        assert np.corrcoef(recording.position, recording.pressure_b)[0, 1] > 0.9
        oil = read_topics(path)
        lower, upper = (oil[f"/measured/{side}_hydraulic_pressure"]["data"] for side in ("lower", "upper"))
        slip = np.sign(recording.velocity) * (np.abs(recording.velocity) > 0.01)
        terms = np.stack([recording.pressure_a, -recording.pressure_b, lower, upper, slip, np.ones(len(slip))], axis=1)
        area_a, area_b = np.linalg.lstsq(terms, -recording.load_cell, rcond=None)[0][:2]
        assert area_a == pytest.approx(np.pi / 4.0 * (5.0 * INCH) ** 2, rel=0.05)
        assert area_b == pytest.approx(np.pi / 4.0 * (5.0**2 - 1.5**2) * INCH**2, rel=0.25)


@needs_tables
def test_servo(bags: Path) -> None:
    """Uneven clocks became even ones; the duty of its motor has both signs again."""
    for path in sorted((bags / "xl330").iterdir()):
        recording, topics = read_recording(path), read_topics(path)
        assert recording.force_driven
        assert np.ptp(np.diff(recording.time)) < 1e-8
        assert np.abs(topics["/measured/duty"]["data"]).max() <= 1.001
        assert np.abs(recording.effort).max() < 1.0
        assert np.corrcoef(np.gradient(recording.position, recording.time), recording.velocity)[0, 1] > 0.7
        assert 4.0 < topics["/measured/driver_voltage"]["data"].mean() < 9.0
        assert len(topics["/position/reference"]) == len(recording)
        gain, error = recording.signals["loop_gain"], recording.signals["reference"] - recording.position
        asked, duty = np.clip(gain * error, -1.0, 1.0), topics["/measured/duty"]["data"]
        assert np.abs(asked - duty).mean() < 0.03  # the servo's own law


def test_every_case_of_the_table_has_a_machine_file() -> None:
    folder = ROOT / "benchmarks" / "real"
    cases = yaml.safe_load((folder / "table" / "cases.yaml").read_text())
    for name, case in cases.items():
        own = folder / "machines" / f"{name}.yaml"
        assert load_model(str(own) if own.exists() else name).parameters
        assert set(case) - {"recordings", "segment"} == {"fit", "judge", "horizon", "published"}
    assert {path.stem for path in (folder / "machines").glob("*.yaml")} <= set(cases)
