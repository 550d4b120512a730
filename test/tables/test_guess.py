"""Guessed maps: the right columns from names, units, ranges and rates; open questions are said, never passed over."""

from pathlib import Path

import numpy as np
import pytest
from tables.making import columns

from pneumo_ros.tables.guess import Guesses, guess
from pneumo_ros.tables.guess_text import map_text
from pneumo_ros.tables.heading import heading
from pneumo_ros.tables.importing import imported
from pneumo_ros.tables.map_file import parse_map
from pneumo_ros.tables.table import Table
from pneumo_ros.yaml_text import load_yaml

TIME = np.arange(1000) / 500.0
X, V = 0.1 * np.sin(3.0 * TIME), 0.3 * np.cos(3.0 * TIME)


def guessed(rows: dict[str, np.ndarray]) -> Guesses:
    """The guess for columns; its map is read, and imports them where it is complete."""
    table = Table(Path("run.csv"), rows, {})
    found = guess(table)
    if found.complete:
        made = imported(table, parse_map(load_yaml(map_text(found, "run.csv"))))
        assert set(found.signals) == set(made.signals) | ({"command"} if made.command else set())
    return found


def taken(found: Guesses) -> dict[str, str]:
    """The column of each signal."""
    return {name: one.column for name, one in found.signals.items()}


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("Pos(in)", "Pos", "in"), ("p1 [bar]", "p1", "bar"), ("t/ms", "t", "ms"), ("pressure_bar", "pressure", "bar"),
        ("F {kN}", "F", "kN"), ("p_A", "p_A", None), ("x_m", "x", "m"), ("weird (xyz)", "weird (xyz)", None),
        ("Weg <µm>", "Weg", "µm"), ("P_1 (bar(g))", "P_1 (bar(g))", None), ("(bar)", "(bar)", None),
        ("position", "position", None),
    ],
)  # fmt: skip
def test_units_in_headings(text: str, name: str, unit: str | None) -> None:
    assert heading(text) == (name, unit)


def test_units_in_headings_decide() -> None:
    found = guessed(columns())
    assert taken(found) == {
        "position": "x (mm)", "velocity": "v (m/s)", "pressure_a": "p1 (bar)", "pressure_b": "p2 (bar)",
        "command": "u (V)",
    }  # fmt: skip
    assert found.time.column == "t (ms)"
    assert (found.signals["position"].unit, found.signals["position"].low) == ("mm", pytest.approx(-30.009, abs=1e-3))
    assert not found.imposed


def test_names_of_a_test_machine() -> None:
    found = guessed(
        {
            "#time(s)": TIME, "Pos(in)": 10.0 * X + 30.0, "Spd(in/s)": 10.0 * V, "LowerHydPress(psig)": 900.0 * X,
            "UpperSpringPressure(psia)": 60.0 - 100.0 * X, "LowerSpringPressure(psia)": 160.0 + 100.0 * X,
            "TestMachineForce(lbs)": 3000.0 + V, "TargetWindingCurrent(A)": V, "Retract": 0.0 * X,
        }
    )  # fmt: skip
    assert taken(found) == {
        "position": "Pos(in)", "velocity": "Spd(in/s)", "load_cell": "TestMachineForce(lbs)",
        "pressure_a": "LowerSpringPressure(psia)", "pressure_b": "UpperSpringPressure(psia)",
    }  # fmt: skip
    assert found.imposed
    assert any("type sign: -1" in sentence for sentence in found.open)
    assert "Retract" in found.unused


def test_columns_without_names_are_known_by_their_rates() -> None:
    found = guessed({"column 1": TIME, "column 2": V, "column 3": X, "force": V + X})
    assert taken(found) == {"position": "column 3", "velocity": "column 2", "force": "force"}
    assert found.signals["velocity"].unit == "m/s"
    assert any("position has no unit" in sentence for sentence in found.open)


def test_the_unit_of_a_velocity_follows_from_the_position() -> None:
    found = guessed({"t": TIME, "pos_mm": 1e3 * X, "speed": V, "torque_Nm": V})
    assert found.signals["velocity"].unit == "m/s"
    found = guessed({"t": TIME, "pos_mm": 1e3 * X, "speed": 1e3 * V, "torque_Nm": V})
    assert found.signals["velocity"].unit == "mm/s"


@pytest.mark.parametrize("heading", ["u [V]", "valve [V]", "u (V)", "spool voltage [V]"])
def test_a_voltage_is_a_valve_command_and_no_motor_voltage_by_its_unit_alone(heading: str) -> None:
    found = guessed({"t": TIME, "x [mm]": 1e3 * X, "p_a [bar]": 3.0 + V, "p_b [bar]": 3.0 - V, heading: 5.0 + V})
    assert taken(found) == {"position": "x [mm]", "pressure_a": "p_a [bar]", "pressure_b": "p_b [bar]",
                            "command": heading}  # fmt: skip
    assert taken(guessed({"t": TIME, "x [mm]": X, "f [N]": V, "supply voltage [V]": 12.0 + V}))["supply_voltage"]


@pytest.mark.parametrize(
    ("factor", "offset", "unit", "gauge"),
    [
        (1.0, 1e5, "Pa", False), (1e-5, 1.0, "bar", False), (1e-5, 0.0, "bar", True), (1e-6, 0.1, "MPa", False),
        (1e-3, 100.0, "kPa", False),
    ],
)  # fmt: skip
def test_pressures_without_unit_are_known_by_their_range(factor: float, offset: float, unit: str, gauge: bool) -> None:
    pressure = 6e5 * factor * (0.5 + 0.5 * np.sin(TIME * 4.0)) + offset
    found = guessed({"t": TIME, "x": X, "pA": pressure, "pB": pressure[::-1], "u": V})
    assert taken(found)["pressure_a"] == "pA"
    assert (found.signals["pressure_a"].unit, found.signals["pressure_a"].gauge) == (unit, gauge)


def test_unsigned_integers_are_seen() -> None:
    duty = np.rint(300.0 * V / 0.3)
    found = guessed(
        {
            "timestamp": TIME,
            "position": X,
            "load": np.where(duty < 0, duty + 65536, duty),
            "goal_position": X + 0.01 * V,
        }
    )
    assert found.signals["force"].bits == 16
    assert found.signals["force"].low == -300.0
    assert taken(found)["reference"] == "goal_position"


@pytest.mark.parametrize(("factor", "unit"), [(1.0, "s"), (1e3, "ms"), (1e6, "us"), (1e9, "ns")])
def test_the_unit_of_time_is_that_of_a_usual_rate(factor: float, unit: str) -> None:
    assert guessed({"time": TIME * factor, "x": X, "force": V}).time.unit == unit


def test_what_is_missing_is_said_with_what_to_type() -> None:
    found = guessed({"a": np.sin(TIME * 40.0), "b": np.sin(TIME * 70.0)})
    assert not found.complete
    told = " ".join(found.open)
    for words in ("type time: {rate: HZ}", "position: {column: NAME, unit: mm}", "force: {column: NAME, unit: N}"):
        assert words in told
        assert words in map_text(found, "run.csv")


def test_a_second_candidate_is_named() -> None:
    found = guessed({"t": TIME, "pos 1 (mm)": X, "pos 2 (mm)": 2.0 * X, "force (N)": V})
    assert any("may also be" in sentence and "pos" in sentence for sentence in found.open)


def test_a_pressure_that_goes_with_the_speed_is_no_velocity() -> None:
    """By its name, and without one as it is not 0 where nothing moves; a true velocity without a name is found."""
    pressure = 3.0e5 + 1.0e5 * V
    pair = {"t": TIME, "y": X, "pA": pressure, "pB": 6.0e5 - pressure, "u": np.sign(V)}
    assert taken(guessed(pair)) == {"position": "y", "pressure_a": "pA", "pressure_b": "pB", "command": "u"}
    named = guessed({"t": TIME, "y": X, "signal 7": pressure, "u": np.sign(V)})
    assert "velocity" not in named.signals
    assert taken(guessed({"t": TIME, "y": X, "signal 7": V, "u": np.sign(V)}))["velocity"] == "signal 7"


def test_a_friction_force_is_measured_and_drives_nothing() -> None:
    rows = {
        "t [s]": TIME,
        "Displacement [mm]": 1e3 * X,
        "Friction force [N]": 40.0 * np.tanh(20.0 * V),
        "p [bar]": 3.0 + X,
    }
    found = guessed(rows)
    assert taken(found)["load_cell"] == "Friction force [N]"
    assert found.imposed


def test_the_current_of_a_motor_makes_a_force_by_its_constant() -> None:
    found = guessed({"t [s]": TIME, "angle [deg]": 57.0 * X, "motor_current_A": V, "coolant [degC]": X})
    assert not found.complete
    assert 'force: {columns: ["motor_current_A"], gains: [K], unit: N m}' in " ".join(found.open)
    found = guessed({"t [s]": TIME, "angle [deg]": 57.0 * X, "coolant [degC]": X})
    assert "gains" not in " ".join(found.open)
