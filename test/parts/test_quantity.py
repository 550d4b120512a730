"""Quantities as people write them, against values worked out by hand."""

import math

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.parts import wishes
from pneumo_ros.parts.quantity import parse, pressure


@pytest.mark.parametrize(
    ("text", "pascals"),
    [
        ("6barg", 7e5), ("6 bar", 7e5), ("6 bar(g)", 7e5), ("7bara", 7e5), ("7 bar abs", 7e5), ("0.6 MPa", 7e5),
        ("600kPa", 7e5), ("87 psi", 1e5 + 87 * 6894.757293168), ("101.5 psia", 101.5 * 6894.757293168), ("6e5 Pa", 7e5),
    ],
)  # fmt: skip
def test_pressures_are_gauge_unless_they_say_absolute(text: str, pascals: float) -> None:
    assert pressure(text, "the supply", 1e5) == pytest.approx(pascals, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("250", "length", 0.25), ("250 mm", "length", 0.25), ("0.25m", "length", 0.25), ("10in", "length", 0.254),
        ("1e2 mm", "length", 0.1),
    ],
)  # fmt: skip
def test_lengths_are_millimetres_unless_they_say_otherwise(text: str, dimension: str, value: float) -> None:
    assert parse(text, dimension, "the stroke", plain="mm") == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("6 bananas", r"the supply is '6 bananas': unknown unit 'bananas'.*such as 6barg"),
        ("6", r"without a unit; known are Pa.*such as 6barg"),
        ("6 mpa", r"unknown unit 'mpa'; did you mean .*MPa"),
        ("bar", r"the supply is 'bar'; it takes a number with its unit"),
        ("nan bar", r"it takes a number with its unit"),
        ("1e999 bar", r"it takes a number with its unit"),
        ("9" * 200, r"it takes a number with its unit"),
    ],
)
def test_what_is_no_pressure_is_refused_with_an_example(text: str, error: str) -> None:
    with pytest.raises(UsageError, match=error):
        pressure(text, "the supply", 1e5)


def test_mountings_are_names_or_angles() -> None:
    assert wishes.tilt("vertical") == pytest.approx(math.pi / 2)
    assert wishes.tilt("vertical-down") == pytest.approx(-math.pi / 2)
    assert wishes.tilt("30deg") == wishes.tilt("30") == pytest.approx(math.pi / 6)
    with pytest.raises(UsageError, match="unknown mounting 'vertikal'; did you mean vertical"):
        wishes.tilt("vertikal")


def test_sensors_become_words_of_read_as() -> None:
    assert wishes.read_as("gauge-bar") == "gauge,bar"
    assert wishes.read_as("absolute-kPa") == "kPa"
    assert wishes.read_as("absolute-Pa") == ""
    with pytest.raises(UsageError, match="unknown sensors 'gauge-bars'; did you mean gauge-bar"):
        wishes.read_as("gauge-bars")


def test_flows_are_named_figures() -> None:
    found = wishes.flow("C 2.8, b 0.3")
    assert found["conductance_filling"].value == pytest.approx(2.8e-8)
    assert found["critical_ratio_filling"].value == 0.3
    assert wishes.flow("700 l/min")["nominal_flow"].value == pytest.approx(0.7 / 60)
    assert wishes.flow("qn=700")["nominal_flow"].value == pytest.approx(0.7 / 60)
    assert wishes.flow("Kv 0.4")["kv"].value == 0.4


@pytest.mark.parametrize("text", ["", "fast", "b 0.3", "C 2, Kv 3", "C -1", "C 2, b 1.2", "C 2 furlongs"])
def test_what_is_no_flow_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="the flow of the valve is"):
        wishes.flow(text)


def test_a_signal_in_milliamperes_is_that_over_500_ohm() -> None:
    found = wishes.signal("4,12,20mA")
    assert [found[f"signal_{name}"].value for name in ("low", "closed", "high")] == pytest.approx([2.0, 6.0, 10.0])
    assert wishes.signal("0,5,10 V") == wishes.signal("0,5,10")


@pytest.mark.parametrize("text", ["0,5", "5,0,10", "a,b,c", "0,5,10,15"])
def test_what_is_no_signal_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="the signal is"):
        wishes.signal(text)
