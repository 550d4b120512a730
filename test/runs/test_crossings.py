"""Where a piston crosses the play before its sensor, from what the sensor reads alone."""

import numpy as np
import pytest

from pneumo_ros.runs.crossings import crossings, play_of

DT, NOISE, WIDTH = 1e-3, 5e-6, 4e-4
UNTOLD = np.zeros(2000, dtype=bool)  # rests that nobody tells of


def moved(acceleration: float, speed: float = 0.1) -> np.ndarray:
    """Position (n,) that rests for 0.4 s, moves off to a steady speed, stops and rests, and goes back."""
    push = np.zeros(2000)
    lasts = round(speed / acceleration / DT)
    for begin, direction in ((400, 1.0), (900, -1.0), (1300, -1.0), (1700, 1.0)):
        push[begin : begin + lasts] = direction * acceleration
    velocity = np.cumsum(push) * DT
    return np.asarray(np.cumsum(velocity) * DT)


def read(position: np.ndarray, width: float) -> np.ndarray:
    """What a sensor behind a play of this width reads (n,), without noise."""
    at, found = 0.0, np.empty_like(position)
    for k, y in enumerate(position):
        at = min(max(at, y - 0.5 * width), y + 0.5 * width)
        found[k] = at
    return found


@pytest.mark.parametrize("acceleration", [1.0, 4.0, 10.0])
def test_the_play_is_crossed_before_the_sensor_moves(acceleration: float) -> None:
    position = moved(acceleration)
    reading = read(position, WIDTH)
    noisy = reading + np.random.default_rng(0).normal(0.0, NOISE, len(reading))
    found = crossings(noisy, DT, NOISE, UNTOLD)
    assert [one.direction for one in found] == [1.0, -1.0]
    play = play_of(found, WIDTH, np.zeros(len(position)), 0.0)
    assert np.sqrt(np.mean((play - (position - reading)) ** 2)) < 0.02 * WIDTH


def test_it_ends_at_the_speed_that_takes_the_sensor_along() -> None:
    acceleration = 4.0
    found = crossings(read(moved(acceleration), WIDTH), DT, NOISE, UNTOLD)
    ways = np.array([0.5 * WIDTH, WIDTH])  # first from the middle of the play
    assert [one.speed / DT for one in found] == pytest.approx(np.sqrt(2.0 * acceleration * ways), rel=0.05)


def test_noise_at_rest_and_the_kink_of_a_start_are_no_reversals() -> None:
    ramp = 0.5 * np.maximum(np.arange(2000) * DT - 1.0, 0.0)  # at once at 0.5 m/s
    noisy = ramp + np.random.default_rng(1).normal(0.0, NOISE, len(ramp))
    assert [one.direction for one in crossings(noisy, DT, NOISE, UNTOLD)] == [1.0]
    assert not crossings(noisy[:900], DT, NOISE, UNTOLD[:900])


def test_a_piston_that_rests_gives_way_within_the_play() -> None:
    """It comes off the face that took the sensor along as its bristles straighten, and later slips to a face."""
    there = moved(4.0)[:1250]
    stops = np.concatenate([there, there[-1] + there, there[-1] + moved(4.0)[1249::-1]])
    reading = read(stops, 0.0)
    rests = np.gradient(reading) == 0.0
    found = crossings(reading, DT, NOISE, rests)
    assert [one.direction for one in found] == [1.0, 1.0, -1.0]
    bent = np.where(rests, -3e-5 * np.sin(np.linspace(0.0, 40.0, len(stops))), 0.0)
    play = play_of(found, WIDTH, bent, 3e-5)
    second = int(found[1].end)
    assert np.ptp(play[1000:second]) > 3e-5
    assert np.all(play[1000:second] <= 0.5 * WIDTH)
    assert np.all(play[second + 1 : second + 300] == 0.5 * WIDTH)
    assert np.all(play[int(found[2].end) + 1 :] == -0.5 * WIDTH)
