"""Effects in the chambers against values that theory gives, and the mass of gas that every effect must account for."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python, machine

from pneumo_ros.plant import Model, load_model

R_T = 287.0 * 293.0
HELD = {"piston.mass": 1e4, "lugre_friction.static_friction": 1e5}  # a sled that cannot move
VOLTAGE = np.repeat([4.0, -3.0, 0.0, 1.5, -8.0], 200)


def chambers(name: str, held: bool = True, **values: float) -> Model:
    """The axis with an effect at the given values, its piston held or not."""
    given = {f"{name}.{key}": value for key, value in values.items()}
    return machine(name).with_parameters({**given, **(HELD if held else {})})


def volumes(model: Model, y: np.ndarray) -> np.ndarray:
    """Volumes (n, 2) of both chambers [m3]."""
    a = model["chambers.volume_a"] + model["piston.area_a"] * y
    return np.column_stack([a, model["chambers.volume_b"] - model["piston.area_b"] * y])


def masses(model: Model, x: np.ndarray) -> np.ndarray:
    """Gas in both chambers (n, 2) [kg], p V / (R T_g) with the temperature T_g of the gas."""
    T = np.full((len(x), 2), 293.0)
    if "theta_a" in model.states:
        T += x[:, [model.states.index("theta_a"), model.states.index("theta_b")]]
    return np.asarray(x[:, 2:4] * volumes(model, x[:, 0]) / (287.0 * T))


def test_leak_across_the_piston_evens_the_chambers_out_and_loses_nothing() -> None:
    """Isothermal, so that the mass is p V / (R T); the difference decays at G R T (1 / V_a + 1 / V_b)."""
    model = chambers("cross_piston_leakage", conductance=5e-9).with_parameters({"air.heat_capacity_ratio": 1.0})
    x = model.simulate(np.zeros(1000), model.state(p_a=6e5, p_b=2e5))
    total = masses(model, x).sum(axis=1)
    assert total == pytest.approx(total[0], rel=1e-6)
    pace = 5e-9 * R_T * (1.0 / 5.1e-4 + 1.0 / 4.0e-4)
    assert x[-1, 2] - x[-1, 3] == pytest.approx(4e5 * np.exp(-pace), rel=3e-3)  # the bristle yields a little


@pytest.mark.parametrize("side", ["a", "b"])
def test_leak_to_atmosphere_empties_one_chamber(side: str) -> None:
    other = "b" if side == "a" else "a"
    model = chambers("leakage_to_atmosphere", **{f"conductance_{side}": 5e-9, f"conductance_{other}": 0.0})
    x = model.simulate(np.zeros(1000), model.state(p_a=5e5, p_b=5e5))
    leaking, whole = (2, 3) if side == "a" else (3, 2)
    pace = 1.4 * R_T * 5e-9 / model[f"chambers.volume_{side}"]
    assert x[-1, leaking] - 1e5 == pytest.approx(4e5 * np.exp(-pace), rel=1e-3)
    assert x[-1, whole] == pytest.approx(5e5, rel=1e-4)


def slopes(model: Model, y: float = 0.0) -> np.ndarray:
    """Rates of both pressures while chamber a is filled at 3 V."""
    plain = in_python(model)
    return np.asarray(plain.derivatives(plain.state(y=y, p_a=2e5, p_b=4e5), 3.0)[0, 2:4])


def test_dead_volume_slows_the_pressures_in_proportion() -> None:
    wider = slopes(chambers("dead_volume", volume_added_a=1e-4, volume_added_b=2e-4))
    assert wider == pytest.approx(slopes(AXIS) * [5.1 / 6.1, 4.0 / 6.0], rel=1e-12)


def test_volume_taken_away_leaves_a_tenth_at_the_end_of_the_stroke() -> None:
    """5.1e-4 m3 less 4.1e-4 m2 times 1 m is 1e-4 m3, of which 1e-5 m3 stay."""
    narrow = slopes(chambers("dead_volume", volume_added_a=-1e-3, volume_added_b=-5e-5), y=-1.0)
    assert narrow == pytest.approx(slopes(AXIS, y=-1.0) * [10.0, 7.0 / 6.5], rel=1e-9)


@pytest.mark.parametrize("end", [1.0, -1.0])
def test_cushion_throttles_what_leaves_the_small_chamber_and_nothing_else(end: float) -> None:
    model, bare = in_python(chambers("cushioning", remaining=0.1, length=0.02)), in_python(AXIS)

    def factors(distance: float, voltage: float) -> list[float]:
        state = {"y": end * (1.0 - distance), "p_a": 3e5, "p_b": 4e5}
        seen = [m.outputs(m.state(**state), voltage) for m in (model, bare)]
        return [float(seen[0][port][0] / seen[1][port][0]) for port in ("port_flow_a", "port_flow_b")]

    small = 1 if end > 0.0 else 0  # b ends at the extended end
    for distance, share in ((0.03, 1.0), (0.018, 0.55), (0.015, 0.1), (0.0, 0.1)):
        expected = [1.0, 1.0]
        expected[small] = share
        assert factors(distance, end * 5.0) == pytest.approx(expected, rel=1e-9)
        assert factors(distance, end * -5.0) == pytest.approx([1.0, 1.0], rel=1e-12)


def swing(rate: float, share: float = 0.0) -> np.ndarray:
    """Pressure and volume of chamber a (n, 2) while a sled without friction swings between closed chambers."""
    free = {
        "lugre_friction.static_friction": 1.0,
        "lugre_friction.coulomb_friction": 1.0,
        "quadratic_drag.coefficient": 0.0,
    }
    model = chambers("heat_exchange", held=False, rate=rate, share=share).with_parameters(free)
    x = model.simulate(np.zeros(600), model.state(v=-2.0, p_a=3e5, p_b=3.7e5))
    return np.column_stack([x[:, 2], volumes(model, x[:, 0])[:, 0]])


@pytest.mark.parametrize(
    ("rate", "share", "exponent"), [(0.0, 0.0, 1.4), (1e3, 0.0, 1.0), (0.0, 0.5, 1.2), (0.0, 1.0, 1.0)]
)
def test_closed_gas_is_a_polytropic_spring(rate: float, share: float, exponent: float) -> None:
    """p V^n is constant: n = gamma without heat exchange, n = 1 with a fast or an instant one."""
    p, volume = swing(rate, share).T
    kept = p * volume**exponent
    assert np.ptp(volume) > 0.1 * volume[0]
    assert kept == pytest.approx(kept[0], rel=3e-3)


def test_between_the_springs_the_exponent_is_between() -> None:
    p, volume = swing(4.0).T
    tight = int(volume.argmin())
    assert 1.05 < -np.log(p[tight] / p[0]) / np.log(volume[tight] / volume[0]) < 1.39


def test_gas_warmed_by_filling_cools_and_takes_the_pressure_along() -> None:
    """Filled fast, a chamber is up to gamma times as warm as the supply; in the end it holds p = m R T / V."""
    model = chambers("heat_exchange", rate=4.0)
    voltage = np.repeat([10.0, 0.0], [150, 2500])
    x = model.simulate(voltage, model.state())
    warm = x[:, model.states.index("theta_a")]
    assert 30.0 < warm[149] < 0.4 * 293.0
    assert warm[[399, 649]] == pytest.approx(warm[149] * np.exp([-1.0, -2.0]), abs=0.05)  # the sled yields a little
    held = masses(model, x)[149, 0] * R_T / volumes(model, x[:, 0])[-1, 0]
    assert x[-1, 2] == pytest.approx(held, rel=1e-4)
    assert x[-1, 2] < 0.9 * x[149, 2]


def test_emptied_gas_is_cold_and_follows_the_adiabat_of_what_stays() -> None:
    """Emptied quickly, the remaining gas has expanded: T_g / T = (p / p_0)^((gamma - 1) / gamma)."""
    model = chambers("heat_exchange", rate=1.0).with_parameters({"arctan_flow.exhaust_coefficient": 5e-7})
    x = model.simulate(np.full(10, -10.0), model.state(p_a=6e5))
    ratio = x[-1, 2] / 6e5
    assert ratio < 0.4
    cold = 1.0 + x[-1, model.states.index("theta_a")] / 293.0
    assert cold == pytest.approx(ratio ** (0.4 / 1.4), rel=5e-3)


def test_a_temperature_that_nothing_reads_stays_bounded() -> None:
    """Driven along pressures that hold while the valve empties a warm chamber: no gas would be left, and T_g no end."""
    measured, voltage = np.tile([0.0, 0.0, 5e5, 5e5], (20_000, 1)), np.full(19_999, -2.0)
    states, claimed = dict[float, np.ndarray](), dict[float, np.ndarray]()
    for rate in (0.0, 4.0):
        model = chambers("heat_exchange", rate=rate)
        rest = model.state(theta_a=200.0, theta_b=200.0)[4:]
        states[rate], claimed[rate] = model.follow(measured, voltage, rest)
    thetas = [model.states.index(f"theta_{side}") for side in "ab"]
    assert np.abs(states[4.0][:, thetas]).max() == 200.0
    assert np.abs(states[0.0][:, thetas]).max() < 1e6, "of a bounded source that fades at 0.1 1/s"
    plain = machine("lugre_friction").with_parameters(HELD)
    _, alone = plain.follow(measured, voltage, plain.state()[4:])
    assert claimed[0.0][:, 2:4] == pytest.approx(alone[:, 2:4], rel=1e-9)


def fade(model: Model, volume: str, y: float) -> np.ndarray:
    """Rates [1/s] at which gas at rest behind a closed valve takes the walls' temperature, of both chambers, times V.

    Without what the film's coefficient does of itself, sqrt(p T_g): over S at mid stroke it leaves S at `y`.
    """
    x = model.state(y=y, p_a=4e5, p_b=4e5, theta_a=-10.0, theta_b=-10.0)
    slopes = np.ravel(in_python(model).derivatives(x, 0.0, 0.0))
    warm = 1.0 - 10.0 / 293.0
    swept = np.array([model["piston.area_a"], -model["piston.area_b"]]) * y
    middle = np.array([model[f"{volume}.volume_a"], model[f"{volume}.volume_b"]])
    rates = np.array([slopes[model.states.index(f"theta_{side}")] / 10.0 for side in "ab"])
    return rates / model["heat_exchange.rate"] * (middle + swept) / middle / warm**1.5


def test_a_film_follows_the_walls_of_a_round_bore() -> None:
    """Both ends and the wall along the way, S = pi d^2 / 2 + 4 V / d, of bores that have the areas of the machine."""
    model = chambers("heat_exchange", rate=4.0, film=1.0)
    d = np.sqrt(4.0 * np.array([model["piston.area_a"], model["piston.area_b"]]) / np.pi)
    around = [np.pi * d**2 / 2.0 + 4.0 * volumes(model, np.array([y]))[0] / d for y in (0.4, 0.0)]
    assert fade(model, "chambers", 0.4) == pytest.approx(around[0] / around[1], rel=1e-12)


@pytest.mark.parametrize("vanes", [1, 2])
def test_a_film_follows_the_six_walls_between_vane_and_stop(vanes: int) -> None:
    """Summed one by one: vane and stop, both sides, casing and hub, of a vane 60 mm wide between 15 and 45 mm."""
    width, inner, outer = 0.06, 0.015, 0.045
    face, swept = width * (outer - inner), 0.5 * width * (outer**2 - inner**2)
    vane = load_model("vane")
    assert (vane["piston.area_a"], vane["piston.area_b"]) == pytest.approx((swept, swept))
    assert vane["rotary_vane.wall_volume"] == pytest.approx(face**2 / (width + outer - inner))
    given = {"heat_exchange.rate": 4.0, "heat_exchange.film": 1.0}
    given |= {f"piston.area_{side}": vanes * swept for side in "ab"}
    given |= {
        f"rotary_vane.{key}": vanes * vane[f"rotary_vane.{key}"] for key in ("volume_a", "volume_b", "wall_volume")
    }
    model = vane.with_effects([*vane.effects, "heat_exchange"], given)

    def walls(y: float) -> np.ndarray:
        angles = np.array([vane[f"rotary_vane.volume_{side}"] for side in "ab"]) / swept + np.array([y, -y])
        return vanes * (2.0 * face + (outer**2 - inner**2) * angles + width * (inner + outer) * angles)

    assert fade(model, "rotary_vane", 0.8) == pytest.approx(walls(0.8) / walls(0.0), rel=1e-12)


@pytest.mark.parametrize(("rate", "share"), [(0.3, 0.0), (1.0, 0.0), (4.0, 0.0), (50.0, 0.0), (1.0, 0.3), (4.0, 1.0)])
def test_heat_moves_no_mass(rate: float, share: float) -> None:
    """p V / (R T_g) of both chambers changes by the flow through the ports: theta and p are consistent."""
    assert_mass_balance(chambers("heat_exchange", held=False, rate=rate, share=share), 1e-3)


@pytest.mark.parametrize(
    "name",
    [
        "arctan_flow", "choked_flow", "cushioning", "line_delay", "supply_pressure_droop", "valve_hysteresis",
        "valve_internal_leakage", "valve_null_offset", "valve_spool_dynamics",
    ],
)  # fmt: skip
def test_chambers_hold_what_comes_through_their_ports(name: str) -> None:
    """Isothermal, so that the mass is p V / (R T)."""
    assert_mass_balance(machine(name).with_parameters({"air.heat_capacity_ratio": 1.0}), 1e-4)


def assert_mass_balance(model: Model, tolerance: float) -> None:
    """What both chambers gain is the integral of the flows through their ports, over a run to an end and back."""
    fine = np.repeat(VOLTAGE, 10)
    x = model.simulate(fine, model.state(y=0.93, p_a=3e5, p_b=4e5), sample_time=1e-4, step=2e-5)
    seen = model.outputs(x, fine)
    mass, steady = masses(model, x), np.diff(fine) == 0.0  # the flow jumps with the voltage
    for side, port in enumerate(("port_flow_a", "port_flow_b")):
        flow = 0.5e-4 * (seen[port][1:] + seen[port][:-1])
        gained, moved = np.diff(mass[:, side])[steady], np.abs(flow[steady]).sum()
        assert np.abs(np.cumsum(gained - flow[steady])).max() < tolerance * moved
        assert moved > 1e-4
