"""Stops are counted once each, and only those at wrong places, until the goal moves."""

from pneumo_ros.control.stops import FREE, WIDEST, Stops


def stand(stops: Stops, position: float, goal: float = 0.0, arrived: bool = False, seconds: float = 0.1) -> None:
    for _ in range(round(seconds * 1e3)):
        stops.watch(goal, position, 5e-5, arrived, 1e-3)


def test_each_stop_counts_once_however_long_it_lasts() -> None:
    stops = Stops()
    for k in range(3):
        stand(stops, 1e-3 * (k + 1), seconds=1.0)
    assert stops.count == 3
    assert stops.stuck


def test_noise_is_no_motion_and_a_short_halt_no_stop() -> None:
    stops = Stops()
    for k in range(500):
        stops.watch(0.0, 1e-3 + 2e-5 * (-1.0) ** k, 5e-5, False, 1e-3)
    assert stops.count == 1
    for k in range(20):
        stand(stops, 2e-3 + 1e-3 * k, seconds=0.03)
    assert stops.count == 1
    assert not stops.stuck


def test_the_goal_is_no_wrong_place_and_a_new_goal_restarts_the_count() -> None:
    stops = Stops()
    stand(stops, 1e-3, arrived=True)
    assert stops.count == 0
    stand(stops, 2e-3)
    stand(stops, 2e-3, goal=0.1)
    assert stops.count == 0


def test_patience_doubles_after_the_free_stops_but_not_for_ever() -> None:
    stops, seen = Stops(), []
    for k in range(FREE + WIDEST + 3):
        stand(stops, 1e-3 * (k + 1))
        seen.append(stops.patience)
    assert seen[FREE - 1] == 1.0
    assert seen[FREE : FREE + 2] == [2.0, 4.0]
    assert seen[-1] == 2.0**WIDEST
