"""The conductor on small plants: which voltage, which trial, which end, and when it aborts."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.trial_result import AbortedError
from pneumo_ros.experiment.voltages import Constant, Ramps, Steps

SAMPLE = 0.01  # s
SLOW = Trial("slow", Constant(0.5), 2.0, patience=3.0, travel=0.5)
BACK = Trial("back", Constant(-0.5), 2.0, patience=3.0, travel=0.5)
PROGRAMME = Programme("test", "cart", -0.9, 0.9, 0.99, 1.0, 1.0, (SLOW, BACK))

Speed = Callable[[float, float], float]  # of voltage and position


def cart(volts: float, position: float) -> float:
    """Moves at the given speed, beyond 0.1 V."""
    return 0.2 * volts if abs(volts) > 0.1 else 0.0


class Ride:
    """A programme on a plant with a speed for every voltage: the sent and measured values at each sample."""

    def __init__(
        self, programme: Programme, speed: Speed = cart, position: float = 0.0, longest: float = 400.0
    ) -> None:
        self.conductor = Conductor(programme, self._told)
        self.said: list[str] = []
        self.rows: list[tuple[float, float, float, str | None]] = []  # time, position, voltage, recording
        time = 7.0  # clocks start anywhere
        while not self.conductor.done and time < longest:
            volts = self.conductor.step(time, position)
            self.rows.append((time, position, volts, self.conductor.recording))
            time, position = time + SAMPLE, position + SAMPLE * speed(volts, position)
        self.outcomes = {one.name: one for one in self.conductor.outcomes}

    def _told(self, text: str) -> None:
        self.said.append(text)

    def of(self, name: str) -> list[tuple[float, float, float]]:
        """Time, position and voltage while a trial is recorded."""
        return [row[:3] for row in self.rows if row[3] == name]


def aborts(programme: Programme, speed: Speed, position: float = 0.0) -> str:
    """The reason why the ride is aborted."""
    with pytest.raises(AbortedError) as stopped:
        Ride(programme, speed, position)
    return str(stopped.value)


def test_every_trial_is_recorded_from_rest_at_its_voltage() -> None:
    ride = Ride(PROGRAMME)
    assert list(ride.outcomes) == ["slow", "back"]
    for trial in PROGRAMME.trials:
        rows = ride.of(trial.name)
        closed = [time for time, _, volts in rows if volts == 0.0]
        assert closed[-1] - closed[0] == pytest.approx(PROGRAMME.rest, abs=2 * SAMPLE)
        assert {volts for _, _, volts in rows[len(closed) :]} == {trial.voltage.at(0.0)}
        assert len({position for _, position, volts in rows[: len(closed)]}) == 1
    assert ride.rows[-1][2] == 0.0


def test_the_first_trial_begins_near_the_end_it_moves_away_from() -> None:
    ride = Ride(PROGRAMME)
    assert ride.of("slow")[0][1] < -0.8
    far = replace(PROGRAMME, trials=(BACK, SLOW))
    assert Ride(far).of("back")[0][1] > 0.8


def test_a_trial_begins_where_it_is_when_there_is_room() -> None:
    ride = Ride(replace(PROGRAMME, trials=(SLOW, BACK, replace(SLOW, name="again", travel=1.7))))
    assert ride.of("back")[0][1] == pytest.approx(ride.of("slow")[-1][1], abs=0.05) or ride.of("back")[0][1] > 0.8
    assert ride.of("again")[0][1] < -0.7


@pytest.mark.parametrize(
    ("change", "ended"),
    [
        ({"seconds": 2.0}, "time"),
        ({"seconds": 60.0, "travel": 0.3}, "travel"),
        ({"seconds": 60.0, "travel": 5.0}, "limit"),
        ({"voltage": Constant(0.05)}, "still"),
    ],
)
def test_why_a_trial_ends(change: dict, ended: str) -> None:
    outcome = Ride(replace(PROGRAMME, trials=(replace(SLOW, **change),))).outcomes["slow"]
    assert outcome.ended == ended
    assert outcome.text.startswith("slow: ")
    assert outcome.speed == pytest.approx(0.0 if ended == "still" else 0.1, rel=0.01)


def test_patience_counts_until_it_moves_and_seconds_from_then_on() -> None:
    stuck = Ride(replace(PROGRAMME, trials=(replace(SLOW, voltage=Constant(0.05)),)))
    assert stuck.outcomes["slow"].seconds == pytest.approx(SLOW.patience, abs=2 * SAMPLE)
    opened: list[int] = []

    def late(volts: float, position: float) -> float:
        """Breaks away 1.5 s after the valve opened to 0.5 V."""
        opened.append(1 if volts == 0.5 else 0)
        return 0.0 if volts == 0.5 and sum(opened) < 150 else cart(volts, position)

    outcome = Ride(replace(PROGRAMME, trials=(SLOW,)), late).outcomes["slow"]
    assert outcome.seconds == pytest.approx(1.5 + SLOW.seconds, abs=0.05)


def test_it_stays_between_the_limits() -> None:
    wide = tuple(replace(one, seconds=60.0, travel=5.0) for one in PROGRAMME.trials)
    positions = [position for _, position, _, _ in Ride(replace(PROGRAMME, trials=wide)).rows]
    assert -0.91 < min(positions) < -0.8
    assert 0.8 < max(positions) < 0.91


def test_voltages_of_both_signs_are_turned_inwards_at_the_limits() -> None:
    outwards = Trial("steps", Steps(((30.0, 2.0),)), 30.0)
    ride = Ride(replace(PROGRAMME, trials=(outwards,)))
    assert max(position for _, position, _ in ride.of("steps")) < 0.92
    assert {volts for _, _, volts in ride.of("steps")} == {0.0, 2.0, -2.0}
    assert ride.outcomes["steps"].ended == "time"


def test_a_moving_piston_is_braked_before_it_is_left_alone() -> None:
    """A plant that never stops once it moves, unless it is braked."""
    speed = [0.0]

    def coasting(volts: float, position: float) -> float:
        speed[0] += SAMPLE * (2.0 * volts if abs(volts) > 0.1 else 0.0)
        speed[0] = max(min(speed[0], 0.2), -0.2)
        if abs(speed[0]) < 0.03 and abs(volts) < 0.1:
            speed[0] = 0.0
        return speed[0]

    ride = Ride(PROGRAMME, coasting)
    assert list(ride.outcomes) == ["slow", "back"]
    assert max(abs(position) for _, position, _, _ in ride.rows) < 0.97


def test_a_piston_at_the_end_stop_is_taken_away_from_it() -> None:
    assert list(Ride(PROGRAMME, position=0.999).outcomes) == ["slow", "back"]
    assert list(Ride(PROGRAMME, position=-1.0).outcomes) == ["slow", "back"]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_reaching_the_end_stop_ends_everything(side: float) -> None:
    def runaway(volts: float, position: float) -> float:
        return 0.3 * side if side * position > 0.01 else cart(volts, position)

    assert f"has reached the end stop, {0.99 * side:+.2f}" in aborts(PROGRAMME, runaway)


def test_the_wrong_way_ends_everything() -> None:
    reason = aborts(PROGRAMME, lambda volts, position: -cart(volts, position))
    assert "the piston went 20 mm the wrong way" in reason
    assert "swapped" in reason


def test_a_piston_that_does_not_return_ends_everything() -> None:
    reason = aborts(PROGRAMME, lambda volts, position: 0.0)
    assert "stays at +0.000 m" in reason
    assert "is the supply on" in reason


def test_a_position_that_is_not_a_number_ends_everything() -> None:
    reason = aborts(PROGRAMME, lambda volts, position: math.nan if position < -0.1 else cart(volts, position))
    assert "the position is nan" in reason


def test_after_an_abort_the_voltage_is_0_and_nothing_is_recorded() -> None:
    conductor = Conductor(PROGRAMME)
    conductor.step(0.0, 0.0)
    with pytest.raises(AbortedError):
        conductor.step(SAMPLE, math.nan)
    assert conductor.step(2 * SAMPLE, 0.0) == 0.0
    assert conductor.recording is None
    assert not conductor.done


def test_a_piston_that_creeps_at_closed_valve_is_mentioned() -> None:
    ride = Ride(PROGRAMME, lambda volts, position: cart(volts, position) or 0.004 * (1 if position < 0.5 else 0))
    assert any("does not come to rest" in text for text in ride.said)
    assert list(ride.outcomes) == ["slow", "back"]


def test_a_ramp_lets_the_pressure_out_of_a_piston_that_jumps() -> None:
    """Beyond 0.5 V pressure drives it, at any speed, until the opposite voltage has let it out."""
    pressure, speed = 0.0, 0.0

    def jumping(volts: float, position: float) -> float:
        nonlocal pressure, speed
        pressure += SAMPLE * 20.0 * (volts if abs(volts) > 0.1 else 0.0)
        driven = abs(speed) > 0.0 or abs(pressure) > 2.0
        speed = 0.95 * speed + SAMPLE * pressure if driven else 0.0
        return speed

    trial = Trial("plumbing", Ramps(1.0, 0.05, 2.5), 2.0, anywhere=True)
    ride = Ride(Programme("plumbing", "cart", -0.9, 0.9, 0.99, 1.0, 1.0, (trial,), blind=True), jumping, longest=20.0)
    rows = ride.of("plumbing")
    first = next(k for k, (_, y, _) in enumerate(rows) if abs(y) > 1e-9)
    braked = next(k for k in range(first, len(rows)) if rows[k][2] < 0.0)
    shut = next(k for k in range(braked, len(rows)) if rows[k][2] == 0.0)
    assert rows[braked][0] - rows[first][0] < 0.3
    assert rows[shut][0] - rows[braked][0] <= 0.1 + 2.0 * SAMPLE
    assert min(volts for _, _, volts in rows[braked:shut]) < -0.1
