"""Recordings converted to the right units and signs, and mistakes that their numbers alone show."""

from dataclasses import replace

import numpy as np
import pytest
from identify.making import recording

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import Recording
from pneumo_ros.records.checks import gaps, outside_gaps, pauses
from pneumo_ros.records.clocks import after_turns, jumps
from pneumo_ros.records.corrections import (
    FORCE_UNITS,
    LEFT_OUT,
    POSITION_UNITS,
    PRESSURE_UNITS,
    WORDS,
    corrected,
    parse_words,
)
from pneumo_ros.records.series import Series
from pneumo_ros.records.unfit import check_pressures, check_use

N = 2000
TIME = np.arange(N) * 1e-3
NOISE = 300.0 * np.random.default_rng(0).normal(size=(2, N))
SWING = np.sin(2.0 * np.pi * TIME)
ATMOSPHERE = 1e5


def axis(**changes: object) -> Recording:
    """Pressures of a running axis: 1.06 to 6.4 bar."""
    signals = {
        "time": TIME, "position": 0.1 * SWING, "velocity": 0.6 * SWING, "voltage": SWING, "command_time": TIME,
        "command": SWING, "pressure_a": 3.73e5 + 2.67e5 * SWING + NOISE[0], "supply_pressure": np.full(N, 7e5),
        "pressure_b": 3.73e5 - 2.67e5 * SWING + NOISE[1], "effort": 50.0 * SWING, "load_cell": 20.0 * SWING,
        "command_b_time": TIME, "command_b": -0.5 * SWING,
    }  # fmt: skip
    return recording(**(signals | changes))


@pytest.mark.parametrize("words", [(word,) for word in WORDS] + [("bar", "gauge", "mm", "swapped-chambers")])
def test_what_was_recorded_otherwise_is_put_right(words: tuple[str, ...]) -> None:
    """A correct recording, changed as `words` say, written and read back."""
    right = axis()
    unit = next((PRESSURE_UNITS[word] for word in words if word in PRESSURE_UNITS), 1.0)
    below = ATMOSPHERE if "gauge" in words else 0.0
    a, b, supply = ((p - below) / unit for p in (right.pressure_a, right.pressure_b, right.supply_pressure))
    length = next((1.0 / POSITION_UNITS[word] for word in words if word in POSITION_UNITS), 1.0) * (
        -1.0 if "reversed-position" in words else 1.0
    )
    sign = -1.0 if "reversed-voltage" in words else 1.0
    force = next((1.0 / FORCE_UNITS[word] for word in words if word in FORCE_UNITS), 1.0)
    force *= -1.0 if "reversed-force" in words else 1.0
    wrong = replace(
        right,
        position=right.position * length,
        velocity=right.velocity * length,
        voltage=sign * right.voltage,
        command=sign * right.command,
        command_b=sign * right.command_b,
        pressure_a=b if "swapped-chambers" in words else a,
        pressure_b=a if "swapped-chambers" in words else b,
        supply_pressure=supply - (ATMOSPHERE if "gauge-supply" in words else 0.0),
        effort=right.effort * force,
        load_cell=right.load_cell * force,
    )
    mended = corrected(wrong, words, ATMOSPHERE)
    left_out = [name for word in words for name in LEFT_OUT.get(word, ())]
    for name in left_out:
        assert getattr(mended, name) is None
    for name in {*right.signals, "command", "command_b"} - {*left_out}:
        np.testing.assert_allclose(getattr(mended, name), getattr(right, name), rtol=1e-12, atol=1e-9, err_msg=name)


def test_units_are_those_of_the_standards() -> None:
    """A psi is a pound-force, 0.45359237 kg times 9.80665 m/s2, on a square inch of 0.0254 m."""
    assert PRESSURE_UNITS["psi"] == pytest.approx(0.45359237 * 9.80665 / 0.0254**2, rel=1e-12)
    assert {name: PRESSURE_UNITS[name] for name in ("hPa", "kPa", "bar", "MPa")} == {
        "hPa": 100.0, "kPa": 1000.0, "bar": 100_000.0, "MPa": 1_000_000.0,
    }  # fmt: skip


def test_what_is_not_recorded_stays_so() -> None:
    pushed = recording(time=TIME, position=SWING, effort=SWING)
    mended = corrected(pushed, ("bar", "gauge", "reversed-position"), ATMOSPHERE)
    assert mended.pressure_a is mended.velocity is mended.voltage is None
    np.testing.assert_array_equal(mended.position, -SWING)


@pytest.mark.parametrize(("steps", "warned"), [(4, False), (5, False), (6, True)])
def test_a_gap_is_longer_than_five_sample_times(steps: int, warned: bool) -> None:
    stamp = 1_000_000 * np.delete(np.arange(200), np.arange(100, 99 + steps))
    series = Series("joint_states", stamp, stamp, {})
    assert bool(gaps(series)) == warned
    inside = Series("chamber_a/pressure", 1_000_000 * np.arange(200), 1_000_000 * np.arange(200), {})
    assert len(outside_gaps(inside, [series])) == 200 - (steps - 1) * warned


@pytest.mark.parametrize(
    ("text", "words"), [("", ()), ("bar", ("bar",)), ("KPA, gauge,gauge", ("kPa", "gauge")), ("mm,", ("mm",))]
)
def test_words_are_understood(text: str, words: tuple[str, ...]) -> None:
    assert parse_words(text) == words


@pytest.mark.parametrize(("text", "said"), [("swaped", "swapped-chambers"), ("bar,MPa", "not in bar and MPa")])
def test_words_that_are_refused(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        parse_words(text)


@pytest.mark.parametrize("unit", PRESSURE_UNITS)
@pytest.mark.parametrize("gauge", [False, True])
@pytest.mark.parametrize("size", [0.3, 1.0, 1.3])
def test_units_are_recognised_by_their_numbers(unit: str, gauge: bool, size: float) -> None:
    """For supplies of 2.6 to 9 bar; the message names the option that helps."""
    right = axis()
    a, b = (1e5 + size * (p - 1e5) for p in (right.pressure_a, right.pressure_b))
    wrong = replace(
        right, pressure_a=(a - gauge * 1e5) / PRESSURE_UNITS[unit], pressure_b=(b - gauge * 1e5) / PRESSURE_UNITS[unit]
    )
    with pytest.raises(DataError, match="absolute pressures in Pa are needed") as caught:
        check_use(wrong, False)
    word = f"{unit},gauge" if gauge else unit
    assert f"type --read-as {word}, or multiply" in str(caught.value)
    check_use(corrected(wrong, parse_words(word), ATMOSPHERE), False)


def test_a_unit_that_is_given_without_need() -> None:
    with pytest.raises(DataError, match=r"more than a pneumatic axis has.*--read-as"):
        check_use(corrected(axis(), ("bar",), ATMOSPHERE), False)


def test_oil_is_not_taken_for_gas() -> None:
    """70 bar: no machine file has such a supply of air; in sealed chambers, which no valve fills, it may be gas."""
    right = axis()
    oil = replace(right, pressure_a=10.0 * right.pressure_a, pressure_b=10.0 * right.pressure_b)
    assert 5.5e6 < oil.pressure_a.max() < 1e7
    with pytest.raises(DataError, match=r"more than a pneumatic axis has.*oil moves.*--read-as no-command"):
        check_use(oil, False)
    check_pressures(oil, oil=True)
    check_pressures(replace(oil, voltage=None))


@pytest.mark.parametrize("offset", [-2e4, 2e4])
def test_an_offset_of_a_sensor_is_no_gauge_pressure(offset: float) -> None:
    right = axis()
    check_use(replace(right, pressure_a=right.pressure_a + offset), False)


def ticks(*steps: float) -> np.ndarray:
    """Times [ns] with these steps [s]."""
    return np.cumsum([0, *steps]) * 1e9


USUAL = [1e-3] * 20


@pytest.mark.parametrize(
    ("stamps", "recorded", "found"),
    [
        ([], [], []),
        ([-3.0], [1e-3], [21]),
        ([5.0], [1e-3], [21]),
        ([5.0], [5.0], []),  # a gap, which is bridged
        ([60.0], [60.0], [21]),
        ([-0.05], [1e-3], []),  # out of order
        ([1e-3], [60.0], []),  # simulated time stood still
        ([1e-3], [-2.0], [21]),
    ],
)
def test_jumps(stamps: list[float], recorded: list[float], found: list[int]) -> None:
    stamp, log = (ticks(*USUAL, *steps, *USUAL).astype(np.int64) for steps in (stamps, recorded))
    assert [jump.first for jump in jumps(stamp, log)] == found


def test_slow_simulated_time_does_not_jump() -> None:
    """A gap of 2 s in stamps is one of 20 s by the recorder, at a tenth of real time."""
    stamp = ticks(*USUAL, 2.0, *USUAL)
    assert jumps(stamp.astype(np.int64), (10 * stamp).astype(np.int64)) == []
    assert len(jumps(stamp.astype(np.int64), stamp.astype(np.int64) // 10)) == 0


def test_commands_after_the_clock_was_set_back() -> None:
    log = ticks(1.0, 1.0, -5.0, 1.0).astype(np.int64)
    assert [x.tolist() for x in after_turns(log, 0, 0)] == [[0, 1, 2], log[:3].tolist()]
    assert [x.tolist() for x in after_turns(log, 1, -7)] == [[2, 3, 4], [-7, *log[3:].tolist()]]
    assert [x.tolist() for x in after_turns(log, 2, -7)] == [[4], [-7]]  # none came since


# --- an overloaded PC -------------------------------------------------------------------------------------------------


def streams(late: float) -> tuple[Series, Series]:
    """Commands at 1 kHz with a pause from 0.8 s to 1.1 s, and joint states that come `late` [s] in that time."""
    stamp = np.arange(2000) * 1_000_000
    sent = stamp[(stamp < 800_000_000) | (stamp > 1_100_000_000)]
    arrived = stamp + np.where((stamp > 8e8) & (stamp < 1.1e9), round(late * 1e9), 0)
    joints = Series("joint_states", stamp, arrived, {"position": np.zeros(len(stamp))})
    return Series("valve/command", sent, sent, {"data": np.arange(len(sent), dtype=float)}), joints


def test_a_pause_of_commands_while_joint_states_come_late_is_an_overloaded_pc() -> None:
    (said,) = pauses(*streams(late=0.2))
    assert "valve/command: 1 pauses of more than 0.05 s in a stream of 1000 Hz, the longest 0.3 s at 0.799 s" in said
    assert "joint states came up to 0.2 s late: the PC was overloaded" in said
    assert "--cut BAG:0.8-1.6" in said


def test_commands_that_are_sent_on_change_may_rest() -> None:
    assert pauses(*streams(late=0.0)) == []
    few = Series("valve/command", np.arange(5) * 10**9, np.arange(5) * 10**9, {"data": np.arange(5.0)})
    assert pauses(few, streams(late=0.0)[1]) == []


# --- zero and closed signal -------------------------------------------------------------------------------------------


def test_zero_and_closed_signal_are_numbers_with_units() -> None:
    right = axis()
    read = replace(
        right, position=1e3 * right.position + 125.0, voltage=right.voltage + 5.0, command=right.command + 5.0
    )
    mended = corrected(read, parse_words("mm, zero=125mm, closed=5V"), ATMOSPHERE)
    np.testing.assert_allclose(mended.position, right.position, atol=1e-12)
    np.testing.assert_allclose(mended.voltage, right.voltage, atol=1e-12)
    np.testing.assert_allclose(mended.command, right.command, atol=1e-12)
    turned = corrected(replace(read, position=-read.position), ("mm", "zero=-0.125", "reversed-position"), ATMOSPHERE)
    np.testing.assert_allclose(turned.position, right.position, atol=1e-12)


@pytest.mark.parametrize("word", ["zero=5kg", "closed=V", "clsed=5V", "zero=1e999"])
def test_a_number_that_is_none_is_named(word: str) -> None:
    with pytest.raises(UsageError, match=f"unknown word '{word}'"):
        parse_words(word)
