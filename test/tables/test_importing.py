"""Tables as recordings: equal numbers come back, clocks are mended, and what cannot be used is named."""

import json
from pathlib import Path

import numpy as np
import pytest
from tables.making import FORMATS, MAP, RATE, columns, put

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import read_recording, read_topics
from pneumo_ros.records.unfit import check_use
from pneumo_ros.tables.importing import Imported, imported, write_bag
from pneumo_ros.tables.map_file import parse_map
from pneumo_ros.tables.reading import read_table
from pneumo_ros.tables.table import Table
from pneumo_ros.yaml_text import load_yaml

DRIVEN = "time: {column: t, unit: s}\nsignals: {position: {column: x, unit: m}, force: {column: f, unit: N}}"


def make(rows: dict[str, np.ndarray], plan: str = DRIVEN, rate: float | None = None) -> Imported:
    """The recording of columns."""
    return imported(Table(Path("run.csv"), rows, {}), parse_map(load_yaml(plan)), rate)


def driven(time: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of a force-driven axis at `time` [s]."""
    return {"t": time, "x": 0.1 * np.sin(3.0 * time), "f": np.cos(3.0 * time)}


@pytest.mark.parametrize("file", ["run.csv", "run.mat", "run.parquet", "records.json"])
def test_a_recording_holds_the_numbers_of_the_table(file: str, tmp_path: Path) -> None:
    plan = MAP.replace("column: ", "column: data.") if file == "run.mat" else MAP
    found = imported(read_table(put(tmp_path, file)), parse_map(load_yaml(plan)))
    write_bag(found, tmp_path / "bag")
    recording, truth = read_recording(tmp_path / "bag"), columns()
    np.testing.assert_allclose(recording.time, 1e-3 * truth["t (ms)"], atol=1e-9)
    np.testing.assert_array_equal(recording.position, truth["x (mm)"] * 1e-3)
    np.testing.assert_array_equal(recording.velocity, truth["v (m/s)"])
    np.testing.assert_array_equal(recording.pressure_a, truth["p1 (bar)"] * 1e5 + 101325.0)
    np.testing.assert_array_equal(recording.pressure_b, truth["p2 (bar)"] * 1e5 + 101325.0)
    np.testing.assert_array_equal(recording.voltage, truth["u (V)"])
    assert len(recording.command) == 2
    assert recording.warnings == ()
    assert not recording.imposed
    check_use(recording, force_driven=False)


def test_the_recording_explains_itself(tmp_path: Path) -> None:
    path = put(tmp_path, "run.csv")
    write_bag(imported(read_table(path), parse_map(load_yaml(MAP))), tmp_path / "bag")
    told = read_recording(tmp_path / "bag").description
    assert told["map"] == load_yaml(MAP)
    assert told["table"]["file"] == "run.csv"
    assert len(told["table"]["sha256"]) == 64
    assert "model" not in told
    assert parse_map(told["map"]).signals == parse_map(load_yaml(MAP)).signals


def test_every_signal_has_its_topic(tmp_path: Path) -> None:
    table = read_table(put(tmp_path, "run.csv"))
    plan = """
    time: t
    motion: imposed
    signals:
      position: x
      load_cell: {column: u, unit: kN}
      supply_pressure: {column: p1, gauge: true}
      pressure_a: {column: p2, gauge: true}
      reference: {column: x, scale: 2}
    others: {oil: {column: p1, unit: bar}}
    """
    write_bag(imported(table, parse_map(load_yaml(plan))), tmp_path / "bag")
    topics, truth = read_topics(tmp_path / "bag"), columns()
    assert {name: data.type for name, data in topics.items()} == {
        "/description": "std_msgs/msg/String", "/joint_states": "sensor_msgs/msg/JointState",
        "/load_cell": "sensor_msgs/msg/JointState", "/chamber_a/pressure": "sensor_msgs/msg/FluidPressure",
        "/supply/pressure": "sensor_msgs/msg/FluidPressure", "/position/reference": "std_msgs/msg/Float64",
        "/measured/oil": "std_msgs/msg/Float64",
    }  # fmt: skip
    np.testing.assert_array_equal(topics["/load_cell"]["effort"][:, 0], 1e3 * truth["u (V)"])
    np.testing.assert_array_equal(topics["/measured/oil"]["data"], 1e5 * truth["p1 (bar)"])
    np.testing.assert_allclose(topics["/position/reference"]["data"], 2e-3 * truth["x (mm)"])
    recording = read_recording(tmp_path / "bag")
    np.testing.assert_array_equal(recording.load_cell, 1e3 * truth["u (V)"])
    assert recording.imposed
    assert recording.pressure_b is None
    with pytest.raises(DataError, match="its motion is imposed"):
        check_use(recording, force_driven=False)


def test_a_free_motion_without_its_cause_is_still_refused(tmp_path: Path) -> None:
    table = read_table(put(tmp_path, "run.csv"))
    with pytest.raises(DataError, match="a position, and nothing that moves it"):
        imported(table, parse_map(load_yaml("time: t\nsignals: {position: x, supply_pressure: p1}")))
    write_bag(
        imported(table, parse_map(load_yaml("time: t\nsignals: {position: x, pressure_a: p1}"))), tmp_path / "bag"
    )
    assert read_recording(tmp_path / "bag").pressures_drive


def test_an_uneven_clock_becomes_even() -> None:
    rng = np.random.default_rng(3)
    time = np.cumsum(rng.uniform(4e-3, 6e-3, 2000))
    found = make(driven(time))
    steps = np.diff(found.time)
    assert np.ptp(steps) < 1e-9
    assert found.rate == pytest.approx(200.0, rel=0.02)
    assert not found.clock.even
    np.testing.assert_allclose(
        found.signals["position"], 0.1 * np.sin(3.0 * found.time), atol=0.1 * 9.0 * 6e-3**2 / 8.0
    )
    words = found.clock.words()
    assert words.startswith("median 4.99 ms")
    assert "90 % within 0.902 ms" in words
    assert "longest gap 6 ms" in words


def test_a_clock_of_few_digits_keeps_its_rate() -> None:
    found = make(driven(np.round(np.arange(3000) / 300.0, 3)))
    assert found.rate == pytest.approx(300.0, rel=1e-3)


def test_a_lower_rate_is_free_of_aliases() -> None:
    """At 100 Hz, a sine of 3 Hz stays, and one of 190 Hz would look like one of 10 Hz."""
    time = np.arange(4000) / 1000.0
    rows = driven(time) | {"f": np.sin(2 * np.pi * 3.0 * time) + np.sin(2 * np.pi * 190.0 * time)}
    found = make(rows, rate=100.0)
    inner = slice(20, -20)
    np.testing.assert_allclose(found.signals["force"][inner], np.sin(2 * np.pi * 3.0 * found.time)[inner], atol=0.01)
    assert found.rate == pytest.approx(100.0)
    bare = np.interp(found.time, time, rows["f"])
    assert np.abs(bare - np.sin(2 * np.pi * 3.0 * found.time)).max() > 0.9


def test_a_higher_rate_is_said_to_be_interpolated() -> None:
    found = make(driven(np.arange(500) / 100.0), rate=1000.0)
    assert len(found.time) == 4991
    assert "interpolated" in found.notes[0]


@pytest.mark.parametrize("rate", [19.0, 20001.0, 0.0, -1.0])
def test_rates_outside_of_20_hz_to_20_khz_are_refused(rate: float) -> None:
    from pneumo_ros.tables.even import check_rate

    with pytest.raises(UsageError, match="20 to 20000 Hz"):
        check_rate(rate)


@pytest.mark.parametrize("rate", [20.0, 20000.0])
def test_rates_at_both_ends_are_accepted(rate: float) -> None:
    assert make(driven(np.arange(200) / rate)).rate == pytest.approx(rate)


def test_rows_out_of_order_and_without_time_are_left_out() -> None:
    time = np.arange(1000) / 500.0
    time[100], time[300], time[500], time[700] = np.nan, time[299], time[499] - 0.01, 50.0
    found = make(driven(time))
    told = " ".join(found.notes)
    assert "1 of 1000 rows have no time" in told
    assert "far from those around" in told
    assert "2 of 998 rows have a time that is not later" in told
    assert "(1 repeat it)" in told
    assert found.rate == pytest.approx(500.0)


def test_a_clock_that_was_set_back_leaves_its_longest_part() -> None:
    first, second = np.arange(300) / 500.0, np.arange(700) / 500.0
    found = make(driven(np.concatenate([first + 100.0, second])))
    assert len(found.time) == 700
    assert "jumps by -100.598 s at row 301" in found.notes[0]


def test_a_gap_stays_a_gap() -> None:
    time = np.arange(1000) / 500.0
    time[500:] += 0.2
    found = make(driven(time))
    assert np.diff(found.time).max() == pytest.approx(0.202)
    uneven = make(driven(time + np.random.default_rng(1).uniform(0.0, 2e-4, 1000)))
    assert np.diff(uneven.time).max() == pytest.approx(0.202, abs=5e-3)
    assert "s are left out, in gaps" in uneven.notes[-1]


def test_samples_that_are_no_numbers_are_counted() -> None:
    rows = driven(np.arange(1000) / 500.0)
    rows["f"][[10, 11, 500]] = np.nan
    rows["x"][700:800] = np.inf
    found = make(rows)
    told = " ".join(found.notes)
    assert "3 of 1000 samples of force" in told
    assert "100 of 1000 samples of position" in told
    assert len(found.time) == 900
    assert all(np.isfinite(values).all() for values in found.signals.values())


def test_signals_of_another_rate_are_interpolated() -> None:
    rows = driven(np.arange(1000) / 500.0)
    rows["f"][np.arange(1000) % 10 != 0] = np.nan
    found = make(rows)
    assert len(found.time) == 991
    np.testing.assert_allclose(found.signals["force"], np.cos(3.0 * found.time), atol=9.0 * 0.02**2 / 8.0)


def test_a_table_without_time_has_the_rate_of_its_map() -> None:
    rows = driven(np.arange(100) / 50.0)
    found = make({"x": rows["x"], "f": rows["f"]}, DRIVEN.replace("{column: t, unit: s}", "{rate: 250}"))
    assert found.rate == pytest.approx(250.0)


def test_time_before_zero_is_moved() -> None:
    found = make(driven(np.arange(100) / 100.0 - 0.5))
    assert found.time[0] == 0.0
    assert "begins at -0.5 s" in found.notes[0]


def test_commands_act_at_their_own_times() -> None:
    rng = np.random.default_rng(1)
    time = np.cumsum(rng.uniform(1e-3, 3e-3, 2000))
    rows = driven(time) | {"u": np.where(time < 1.0, 0.0, 2.0)}
    found = make(rows, DRIVEN[:-1] + ", command: {column: u, unit: V}}")
    when, volts = found.command
    assert volts.tolist() == [0.0, 2.0]
    assert when[1] == time[time >= 1.0][0]


TIME = np.arange(100) / 100.0


@pytest.mark.parametrize(
    ("rows", "plan", "kind", "sentence"),
    [
        (
            driven(TIME),
            DRIVEN.replace("position: {column: x, unit: m}, ", ""),
            DataError,
            "no column is mapped to position",
        ),
        (driven(TIME), DRIVEN.replace(", force: {column: f, unit: N}", ""), DataError, "nothing that moves it"),
        (driven(TIME) | {"t": np.full(100, 3.0)}, DRIVEN, DataError, "3 s in all 100 rows"),
        (driven(TIME) | {"t": np.full(100, np.nan)}, DRIVEN, DataError, "0 rows with a time"),
        (driven(TIME) | {"x": np.full(100, np.nan)}, DRIVEN, DataError, "holds no finite number"),
        (driven(TIME[:1]), DRIVEN, DataError, "has 1 row"),
        (driven(TIME * 100.0), DRIVEN, DataError, "1 Hz; 20 Hz to 20000 Hz are read"),
        (driven(TIME * 1e-4), DRIVEN, DataError, "Hz are read"),
        (driven(TIME) | {"t": TIME + 1e12}, DRIVEN, UsageError, "give its unit: ms, us or ns"),
        (driven(np.repeat(TIME, 10)), DRIVEN, DataError, "type time: {rate: "),
    ],
)
def test_what_cannot_be_used_is_named(
    rows: dict[str, np.ndarray], plan: str, kind: type[Exception], sentence: str
) -> None:
    with pytest.raises(kind, match=sentence.replace("{", r"\{")) as error:
        make(rows, plan)
    assert "run.csv" in str(error.value)


def test_pressures_below_zero_are_gauge() -> None:
    rows = driven(TIME) | {"p": np.linspace(-0.2, 3.0, 100)}
    plan = DRIVEN[:-1] + ", pressure_a: {column: p, unit: bar}}"
    with pytest.raises(DataError, match="type gauge: true"):
        make(rows, plan)
    low = make(rows, plan.replace("unit: bar", "unit: bar, gauge: true")).signals["pressure_a"].min()
    assert low == pytest.approx(81325.0)


def test_signals_that_never_overlap_are_named() -> None:
    rows = driven(TIME)
    rows["x"][60:], rows["f"][:40] = np.nan, np.nan
    assert len(make(rows).time) == 20
    rows["x"][30:] = np.nan
    with pytest.raises(DataError, match=r"do not overlap in time; position 0\.000 to 0\.290 s, force 0\.400"):
        make(rows)


def test_a_constant_signal_is_said() -> None:
    assert "nothing moves" in make(driven(TIME) | {"x": np.zeros(100)}).notes[0]


def test_the_description_is_plain_json(tmp_path: Path) -> None:
    from pneumo_ros.tables.importing import description

    path = put(tmp_path, "run.csv", FORMATS["run.csv"](columns()))
    found = imported(read_table(path), parse_map(load_yaml("time: t\nsource: 2021-07-26\n" + MAP.partition("\n")[2])))
    told = json.loads(json.dumps(description(found)))
    assert told["map"]["source"] == "2021-07-26"
    assert found.rate == pytest.approx(RATE)


def test_a_pressure_that_counts_the_wrong_way_is_named() -> None:
    time = np.arange(200) * 0.01
    rows, oil = driven(time), 2e7 * np.sin(3.0 * time) ** 2 - 1e4
    plan = DRIVEN + "\nothers: {oil: {column: oil, unit: psi, gauge: true}}"
    notes = {sign: make({**rows, "oil": sign * oil / 6894.757}, plan).notes for sign in (1.0, -1.0)}
    assert not any("wrong way" in note for note in notes[1.0])  # some kPa below the atmosphere's are noise
    assert any("oil (column oil) falls to" in note and "type sign: -1" in note for note in notes[-1.0])
    sealed = plan.replace("others: {oil", "signals: {position: {column: x, unit: m}, pressure_a").replace(DRIVEN, "")
    with pytest.raises(DataError, match=r"pressure_a .* counts the wrong way.*type sign: -1"):
        make({**rows, "oil": -(2e5 + 1e5 * np.sin(time)) / 100.0}, "time: {column: t, unit: s}" + sealed)
