"""Maps: every error says what was given and what is allowed; units and signs come back from SI as they were."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tables.making import MAP

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.tables.map_file import load_map, parse_map
from pneumo_ros.tables.mapped import mapped
from pneumo_ros.tables.table import Table
from pneumo_ros.tables.units import UNITS, find_unit
from pneumo_ros.yaml_text import load_yaml

TABLE = Table(
    Path("run.csv"),
    {name: np.array([0.0, 1.0, 2.5]) for name in ("t (ms)", "x (mm)", "p1 (bar)", "p2", "i", "duty", "F", "f")}
    | {"unsigned": np.array([0.0, 65535.0, 65000.0]), "none": np.full(3, np.nan)},
    {"kt": 0.2},
    ("state",),
)


def values(line: str, name: str = "position", more: str = "") -> np.ndarray:
    """The signal `name` that an entry makes of the table, in SI units."""
    return mapped(TABLE, parse_map(load_yaml(f"time: t\n{more}\nsignals: {{{name}: {line}}}"))).signals[name]


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("signals: {presure_a: {column: p1}}", "did you mean pressure_a"),
        ("signal: {}", "did you mean signals"),
        ("signals: {position: {colum: x}}", "did you mean column"),
        ("signals: {position: {unit: mm}}", "either column, or columns"),
        ("signals: {position: 3}", "takes a column and its unit"),
        ("signals: [position]", "takes a line for each name"),
        ("signals: {position: {column: x, unit: mmm}}", "did you mean mm"),
        ("signals: {position: {column: x, unit: bar}}", "a unit of pressure; position is measured in m or rad"),
        ("signals: {position: {column: x, unit: mm, gauge: true}}", "gauge is for pressures"),
        ("signals: {pressure_a: {column: x, unit: psia, gauge: true}}", "leave one of them out"),
        ("signals: {pressure_a: {column: x, unit: bar, gauge: 1}}", "true or false"),
        ("signals: {position: {column: x, sign: -2}}", "type scale: -2"),
        ("signals: {position: {column: x, scale: 0}}", "other than 0"),
        ("signals: {position: {column: x, offset: .nan}}", "finite number"),
        ("signals: {position: {column: x, bits: 7}}", "8, 12, 16"),
        ("signals: {position: {column: 3}}", "put the name of a column in quotes"),
        ("signals: {force: {columns: [i, v], gains: [1.0], unit: N}}", "as many gains as columns"),
        ("signals: {force: {column: i, gains: [1.0], unit: N}}", "type scale"),
        ("others: {description: {column: i}}", "a meaning of its own"),
        ("others: {a b: {column: i}}", "letters, digits and underscores"),
        ("motion: fixed", "free or imposed"),
        ("constants: {atmospheric_pressure: 1013}", "give its unit"),
        ("constants: {atmospheric_pressure: {value: 1013}}", "value: 1013, unit: mbar"),
        ("time: {column: t, rate: 100}", "or for a table without time"),
        ("time: {rate: -1}", "above 0"),
        ("time: {column: t, unit: bar}", "a unit of pressure"),
        ("time: 3", "it takes {column: t, unit: s}"),
    ],
)
def test_errors_name_what_is_allowed(line: str, sentence: str, tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    path.write_text(line if line.startswith("time") else f"time: t\n{line}\n")
    with pytest.raises(UsageError) as error:
        load_map(path)
    assert sentence in str(error.value).replace("time: {column", "{column")
    assert str(path) in str(error.value)


def test_an_absent_map_and_a_map_without_time_say_what_to_type(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--guess --map"):
        load_map(tmp_path / "absent.yaml")
    with pytest.raises(UsageError, match=r"time is None; it takes time: \{column"):
        parse_map({"signals": {}})


@pytest.mark.parametrize(
    ("line", "name", "sentence"),
    [
        ("{column: y}", "position", "the table has: t"),
        ("{column: x (mn)}", "position", r"did you mean x \(mm\)"),
        ("{column: state}", "position", "holds text"),
        ("{column: f, unit: N}", "force", None),
        ("{column: p2}", "pressure_b", "neither map nor heading has a unit"),
        ("{column: x}", "pressure_b", "the unit mm of its heading is none of pressure"),
        ("{columns: [i], gains: [kr], unit: N}", "force", "unknown constant 'kr'"),
        ("{column: i, unit: N, times: dutty}", "force", "did you mean duty"),
    ],
)
def test_a_map_that_does_not_fit_is_named(line: str, name: str, sentence: str | None) -> None:
    if sentence is None:
        assert values(line, name).tolist() == [0.0, 1.0, 2.5]
        return
    with pytest.raises(UsageError, match=sentence):
        values(line, name)


def test_a_column_without_a_number_is_named() -> None:
    with pytest.raises(DataError, match=r"position \(column none\) holds no finite number"):
        values("{column: none, unit: m}")


def test_names_and_units_come_from_the_heading() -> None:
    np.testing.assert_allclose(values("x"), [0.0, 1e-3, 2.5e-3])
    np.testing.assert_allclose(
        mapped(TABLE, parse_map(load_yaml("time: t\nsignals: {position: x}"))).time, [0.0, 1e-3, 2.5e-3]
    )


def test_calculated_columns() -> None:
    np.testing.assert_allclose(values("{columns: [i, duty], gains: [kt, -1e-1], unit: N}", "force"), [0.0, 0.1, 0.25])
    np.testing.assert_allclose(values("{column: i, times: duty, scale: 2, unit: N m}", "force"), [0.0, 2.0, 12.5])
    np.testing.assert_allclose(values("{column: unsigned, bits: 16, unit: N}", "force"), [0.0, -1.0, -536.0])
    np.testing.assert_allclose(values("{column: i, sign: -1, offset: -1, unit: mm}"), [1e-3, 0.0, -1.5e-3])


def test_gauge_pressures_get_the_pressure_of_the_atmosphere() -> None:
    atmosphere = "constants: {atmospheric_pressure: {value: 950, unit: mbar}}"
    np.testing.assert_allclose(values("{column: p1, unit: barg}", "pressure_a", atmosphere), [0.95e5, 1.95e5, 3.45e5])
    np.testing.assert_allclose(values("{column: p1, gauge: true}", "pressure_a"), [101325.0, 201325.0, 351325.0])
    np.testing.assert_allclose(values("{column: p1}", "pressure_a"), [0.0, 1e5, 2.5e5])


KNOWN = {
    "in": 0.0254, "um": 1e-6, "deg": np.pi / 180.0, "psi": 6894.757293168, "mbar": 100.0, "lbf": 4.4482216152605,
    "kgf": 9.80665, "rpm": 2.0 * np.pi / 60.0, "lbf in": 0.1129848290276167, "%": 0.01,
}  # fmt: skip


def test_factors_are_those_of_the_definitions() -> None:
    for name, factor in KNOWN.items():
        assert UNITS[name].factor == pytest.approx(factor, rel=1e-12)
    assert find_unit("PSIG") == UNITS["psig"]
    assert find_unit("Nm") == UNITS["N m"]
    assert find_unit("nm") == UNITS["nm"]
    assert find_unit("µm") == UNITS["um"]
    assert find_unit("lbs") == UNITS["lbf"]
    assert find_unit("furlong") is None


BY_SIGNAL = {
    "position": ("length", "angle"),
    "pressure_a": ("pressure",),
    "force": ("force", "torque"),
    "command": ("voltage", "ratio", "current"),
}


@given(
    data=st.data(),
    signal=st.sampled_from(sorted(BY_SIGNAL)),
    sign=st.sampled_from([1, -1]),
    scale=st.floats(0.01, 100.0),
    offset=st.floats(-100.0, 100.0),
    truth=st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=5),
)
def test_any_unit_sign_scale_and_offset_gives_the_signal_back(
    data: st.DataObject, signal: str, sign: int, scale: float, offset: float, truth: list[float]
) -> None:
    """A column is made from a signal in SI units by the inverse of the map; the map gives the signal."""
    unit = data.draw(st.sampled_from([name for name, one in UNITS.items() if one.dimension in BY_SIGNAL[signal]]))
    known = UNITS[unit]
    rise = 101325.0 if known.gauge else 0.0
    column = (sign * (np.array(truth) - rise) / known.factor - offset) / scale
    table = Table(Path("t.csv"), {"t": np.arange(len(truth)) * 1.0, "c": column}, {})
    line = {"column": "c", "unit": unit, "sign": sign, "scale": scale, "offset": offset}
    found = mapped(table, parse_map({"time": {"column": "t", "unit": "s"}, "signals": {signal: line}})).signals[signal]
    size = np.abs(truth).max() + rise + 100.0 * known.factor
    np.testing.assert_allclose(found, truth, rtol=0.0, atol=1e-12 * size * 10.0)


def test_the_example_map_is_read() -> None:
    assert set(parse_map(load_yaml(MAP)).signals) == {"position", "velocity", "pressure_a", "pressure_b", "command"}
