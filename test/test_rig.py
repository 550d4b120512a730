"""The independent rig against the numbers of the model's specification, and its two integrators against each other."""

from pathlib import Path

import numpy as np
import pytest
from rig import axis, loop, oracle
from rig.machine import SMOOTH, WORN, Machine, worn

LONG = {"stroke": 100.0, "volume_a": 5.1e-3, "volume_b": 4.0e-3}  # room to settle: the steady state knows no volumes
STEADY = [  # voltage [V], rod force on, speed [m/s], pressures [Pa]
    (7.0, 1.0, 0.1827, (6.446e5, 1.051e5)),
    (2.0, 1.0, 0.1795, None),
    (1.0, 1.0, 0.1561, None),
    (-7.0, 1.0, -0.1465, (1.056e5, 6.664e5)),
    (7.0, 0.0, 0.1888, None),
    (-7.0, 0.0, -0.1385, None),
]


@pytest.mark.parametrize(("voltage", "rod", "speed", "pressures"), STEADY)
def test_oracle_settles_at_the_published_speeds(voltage, rod, speed, pressures):
    start = {"p_a": 5.5e5, "p_b": 1.2e5} if voltage > 0.0 else {"p_a": 1.2e5, "p_b": 5.5e5}
    x = oracle.simulate({**LONG, "rod_atmospheric_force": rod}, np.full(60, voltage), start, 1.0)[-1]
    assert x[1] == pytest.approx(speed, rel=1e-3)
    if pressures:
        assert x[2:4] == pytest.approx(pressures, rel=1e-3)


def test_oracle_slides_with_the_bristle_at_50_um():
    x = oracle.simulate(LONG, np.full(40, 7.0), {"p_a": 3e5, "p_b": 4e5}, 1.0)[-1]
    assert x[4] == pytest.approx(50e-6, rel=1e-3)


def test_oracle_air_spring_has_345_newtons_per_metre():
    machine = axis.Axis({})
    invariants = np.array([4e5, (4.1e-4 * 4e5 - 11.0) / 3.0e-4])
    force = [machine.drive(*machine.pressures(y, *invariants)) for y in (-1e-4, 1e-4)]
    assert (force[0] - force[1]) / 2e-4 == pytest.approx(345.0, rel=2e-3)


@pytest.mark.parametrize(("plain_lugre", "creep", "within"), [(True, 5.8e-4, 5e-6), (False, 0.0, 1e-9)])
def test_oracle_creeps_below_breakaway_only_as_plain_lugre(plain_lugre, creep, within):
    cycles = np.arange(27) * 0.5  # in six cycles the ring of the first step dies away, twenty more are counted
    y = oracle.push({}, lambda t: 40.0 + 20.0 * np.sin(4.0 * np.pi * t), cycles, 1e-9, plain_lugre)[:, 0]
    assert y[26] - y[6] == pytest.approx(creep, abs=within)


MANOEUVRE = np.concatenate([np.full(300, 2.0), np.full(300, -1.5), np.zeros(200), np.full(200, 0.85)])


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_oracle_does_not_depend_on_its_solver(method):
    start = {"y": 0.1, "p_a": 3e5, "p_b": 4e5}
    difference = oracle.simulate({}, MANOEUVRE, start, 1e-3, 1e-10)
    difference -= oracle.simulate({}, MANOEUVRE, start, 1e-3, 1e-9, method)
    assert np.all(np.abs(difference).max(axis=0) < [1e-9, 1e-7, 1e-3, 1e-3, 1e-10])


def test_oracle_keeps_the_bristle_within_its_highest_force():
    x = oracle.simulate({}, MANOEUVRE, {"y": 0.1, "p_a": 3e5, "p_b": 4e5}, 1e-3)
    assert np.abs(x[:, 4]).max() <= 100.0 / 1.4e6 * (1.0 + 1e-9)


def test_oracle_stops_at_the_end_of_the_stroke():
    x = oracle.simulate({}, np.full(150, 7.0), {"y": 0.9, "p_a": 3e5, "p_b": 3e5}, 0.02)
    assert x[-1, 0] == pytest.approx(1.0, abs=1e-3)
    assert abs(x[-1, 1]) < 1e-4


def test_the_rig_shares_no_code_with_what_it_judges():
    sources = [source.read_text() for source in Path(oracle.__file__).parent.glob("*.py")]
    assert len(sources) > 10
    assert not any("pneumo_ros" in source for source in sources)


def test_oracle_refuses_names_it_does_not_know():
    with pytest.raises(KeyError, match="masss"):
        oracle.simulate({"masss": 5.0}, np.zeros(2), {}, 1e-3)
    with pytest.raises(KeyError, match="pressure"):
        oracle.simulate({}, np.zeros(2), {"pressure": 5.0}, 1e-3)


BASE = Machine()


def fixed_step(voltage, step=loop.STEP, machine=BASE):
    start = loop.rest(machine, 0.1, 3e5)
    return loop.readings(machine, loop.run(machine, SMOOTH, start, np.append(voltage, 0.0), step=step)[0])


def test_two_derivations_and_two_integrators_agree():
    """Energy balance with masses at 20 us against adiabatic invariants to ten digits."""
    x = fixed_step(MANOEUVRE)
    exact = oracle.simulate({}, MANOEUVRE, dict(zip(oracle.COLUMNS, x[0], strict=True)), 1e-3, 1e-11)
    assert np.all(np.abs(x[1:] - exact).max(axis=0) < [1e-10, 1e-8, 1e-4, 1e-4, 1e-11])


def test_they_agree_at_the_end_of_the_stroke():
    machine = Machine(half_stroke=0.105)
    x = fixed_step(MANOEUVRE, machine=machine)
    start = dict(zip(oracle.COLUMNS, x[0], strict=True))
    exact = oracle.simulate({"stroke": 0.21}, MANOEUVRE, start, 1e-3, 1e-11)
    assert x[:, 0].max() > 0.105
    assert np.all(np.abs(x[1:] - exact).max(axis=0) < [1e-7, 1e-4, 1.0, 1.0, 1e-7])


def test_they_agree_on_a_worn_machine():
    machine = worn(Machine(), np.random.default_rng(5))
    x = fixed_step(MANOEUVRE, machine=machine)
    names = {
        "right_limit": "dead_right",
        "left_limit": "dead_left",
        "voltage_gain": "gain",
        "filling_coefficient": "fill",
        "exhaust_coefficient": "exhaust",
        "static_friction": "static",
        "coulomb_friction": "coulomb",
        "stribeck_velocity": "stribeck",
        "bristle_stiffness": "bristle",
        "bristle_damping": "bristle_damping",
        "drag_coefficient": "drag",
    }
    parameters = {theirs: getattr(machine, ours) for theirs, ours in names.items()}
    exact = oracle.simulate(parameters, MANOEUVRE, dict(zip(oracle.COLUMNS, x[0], strict=True)), 1e-3, 1e-10)
    assert set(names.values()) == set(WORN)
    assert np.all(np.abs(x[1:] - exact).max(axis=0) < [1e-9, 1e-7, 1e-3, 1e-3, 1e-10])


@pytest.mark.check
def test_the_fixed_step_is_fine_enough():
    difference = fixed_step(MANOEUVRE) - fixed_step(MANOEUVRE, 5e-6)
    assert np.all(np.abs(difference).max(axis=0) < [1e-10, 1e-8, 1e-4, 1e-4, 1e-11])
