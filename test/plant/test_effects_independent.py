"""Effects against those of the independent rig under test/, where both have the same law."""

import numpy as np
import pytest
from plant.catalogue import AXIS
from rig import effects as rig_effects
from rig import loop, sensors
from rig.machine import SMOOTH, Machine

from pneumo_ros.plant import Model

MANOEUVRE = np.repeat([2.0, -2.5, 0.0, 0.95, -1.1, 3.0], [400, 700, 250, 400, 350, 300])
OMEGA = 2.0 * np.pi * 15.0
TANK = 1e8 * 1e-3 / (1.4 * 287.0 * 293.0)  # s, of a supply of 1e8 Pa s/kg and 1e-3 m3
NORMAL = np.sqrt(293.0 / 293.15)  # the rig's gas is as warm as the norm's

# name of the effect, and the case if there are several: fields of the rig's machine, values of ours
SAME = {
    "viscous_friction": ({"viscous_out": 180.0, "viscous_in": 180.0}, {"coefficient": 180.0}),
    "asymmetric_friction": ({"retract_excess": 0.3}, {"ratio": 0.3}),
    "asymmetric_friction, of Coulomb friction": (
        {"retract_excess": 0.3, "retract_static": 0.0},
        {"ratio": 0.3, "static_ratio": (100.0 + 0.3 * 70.0) / (1.3 * 100.0) - 1.0},
    ),
    "asymmetric_viscous_friction": (
        {"viscous_out": 30.0, "viscous_in": 100.0},
        {"coefficient_extension": 30.0, "coefficient_retraction": 100.0},
    ),
    "heat_exchange": ({"adiabatic": 1.2}, {"rate": 0.0, "share": 0.5}),
    "heat_exchange, through a film": ({"wall_time": 0.25}, {"rate": 4.0, "film": 1.0}),
    "pressure_dependent_friction": ({"seal": 8e-5}, {"coefficient": 8e-5}),
    "stribeck_shape": ({"stribeck_power": 0.7, "stribeck_rational": 0.6}, {"exponent": 0.7, "rational": 0.6}),
    "friction_warmup": ({"warm_share": 0.3, "warm_fast": 1.0}, {"share": 0.3, "time_constant": 1.0}),
    "friction_lag": ({"lag_film": 5e-3}, {"time_constant": 5e-3}),
    "dwell_time_breakaway": (
        {"rest_rise": 30.0, "rest_time": 0.5, "rest_slip": 1e-4},
        {"rise": 30.0, "time_constant": 0.5, "distance": 1e-4},
    ),
    "payload_mass": ({"payload": 8.0}, {"mass_added": 8.0}),
    "constant_load": ({"load": 30.0}, {"load": 30.0}),
    "spring_load": (
        {"spring": 100.0, "spring_centre": 0.1, "spring_hardening": 0.18},
        {"stiffness": 100.0, "rest_position": 0.1, "hardening": 2.0},
    ),
    "load_compliance": (
        {"load_share": 0.4, "coupling": 2.0 * OMEGA**2, "coupling_damping": 2.0 * 0.1 * OMEGA},
        {"load_share": 0.4, "frequency": 15.0, "damping_ratio": 0.05},
    ),
    "choked_flow": (
        {"sonic": 1.0, "sonic_conductance": 5e-9, "critical_ratio": 0.3},
        {"conductance_filling": 5e-9 * NORMAL, "conductance_exhaust": 5e-9 * NORMAL * 0.898105 / 0.69501},
    ),
    "valve_spool_dynamics": (
        {"spool_rate": 60.0, "spool_damping": 0.8},
        {"angular_frequency": 60.0, "damping_ratio": 0.8},
    ),
    "valve_null_offset": ({"null_offset": 0.2}, {"offset": 0.2}),
    "valve_hysteresis": ({"play": 0.15}, {"half_width": 0.15}),
    "supply_pressure_droop": ({"feed": 1e8, "tank": 1e-3}, {"resistance_supply": 1e8, "time_constant": TANK}),
    "cross_piston_leakage": ({"cross": 5e-10}, {"conductance": 5e-10}),
    "leakage_to_atmosphere": ({"leak_a": 5e-10, "leak_b": 2e-10}, {"conductance_a": 5e-10, "conductance_b": 2e-10}),
    "dead_volume": ({"volume_a": 7.1e-4, "volume_b": 4.5e-4}, {"volume_added_a": 2e-4, "volume_added_b": 5e-5}),
}
# A pure delay against its approximation, a first-order lag against a second-order one: differences vanish as fast
ALIKE = {
    "line_delay": ({"line_delay": 0.012, "line_loss": 6e3}, {"delay": 0.012, "loss_pressure": 6e3}),
    "valve_spool_dynamics": ({"spool_lag": 0.01}, {"angular_frequency": 500.0, "damping_ratio": 2.5}),
}
CLOSE = np.array([5e-6, 4e-4, 5.0, 5.0])  # m, m/s, Pa, Pa: the difference of the integrators
NEARLY = np.array([1e-4, 5e-3, 2.5e3, 4e3])


def ours(name: str, values: dict[str, float]) -> Model:
    """The axis with the effect of that name."""
    return AXIS.with_effects([*AXIS.effects, name], {f"{name}.{key}": value for key, value in values.items()})


def theirs(fields: dict[str, float]) -> tuple[Machine, np.ndarray]:
    """The rig's machine, and y, v, p_a, p_b, z at the begin of each sample of the manoeuvre."""
    machine = Machine()._replace(**fields)
    states, _ = loop.run(machine, SMOOTH, loop.rest(machine, 0.1, 3e5), MANOEUVRE)
    return machine, loop.readings(machine, states)


def run(model: Model, begin: np.ndarray) -> np.ndarray:
    """Our run of the same manoeuvre from the same state; the contact has rested as long as the rig's."""
    rested = {"age": 5.0} if "age" in model.states else {}
    start = model.state(**dict(zip(("y", "v", "p_a", "p_b", "z"), begin, strict=True)), **rested)
    return model.simulate(MANOEUVRE, start, step=5e-5)[:-1]


def test_every_law_that_both_have_is_compared() -> None:
    """The rig marks where its shape is another; loads and sensors that need more than a field are compared below."""
    shared = {name.split(":")[0] for name, effect in rig_effects.EFFECTS.items() if effect.same_shape}
    compared = {name.split(",")[0] for name in SAME}
    elsewhere = {"line_delay", "position_sensor_delay", "pressure_sensor_offset", "pressure_sensor_gain", "backlash"}
    assert shared <= compared | elsewhere


@pytest.mark.parametrize("case", SAME)
def test_the_same_law_gives_the_same_motion(case: str) -> None:
    fields, values = SAME[case]
    _, reading = theirs(fields)
    x = run(ours(case.split(",")[0], values), reading[0])
    apart = np.abs(x[:, :4] - reading[1:, :4]).max(axis=0)
    assert np.all(apart < CLOSE), apart
    plain = np.abs(theirs({})[1][1:, :4] - reading[1:, :4]).max(axis=0)
    assert np.any(plain > 50.0 * CLOSE), "the manoeuvre shows the effect"


@pytest.mark.parametrize("name", ALIKE)
def test_approximations_move_the_piston_like_the_exact_effects(name: str) -> None:
    fields, values = ALIKE[name]
    _, reading = theirs(fields)
    apart = np.abs(run(ours(name, values), reading[0])[:, :4] - reading[1:, :4])
    assert np.all(apart.max(axis=0) < NEARLY)
    assert np.sqrt((apart[:, 2:] ** 2).mean(axis=0)).max() < 300.0  # Pa, noise of a good sensor


@pytest.mark.parametrize(("delay", "close"), [(4e-3, 1e-6), (1e-2, 1e-6), (2e-2, 6e-6)])
def test_delayed_positions_are_those_of_then(delay: float, close: float) -> None:
    machine, reading = theirs({"position_delay": delay})
    model = ours("position_sensor_delay", {"delay": delay})
    x = run(model, reading[0])
    shown = model.outputs(x, MANOEUVRE[:-1])["y_measured"]
    apart = np.abs(shown - sensors._delayed(machine, reading, 1e-3)[1:])
    assert np.sqrt((apart**2).mean()) < close  # m; a (2, 2) approximation of 10 ms leaves 3.8e-6
    assert apart.max() < 4e-5
    assert np.abs(x[:, 0] - shown).max() > 4e-4


def test_loose_encoders_show_the_same() -> None:
    machine, reading = theirs({"encoder_play": 2e-4})
    model = ours("backlash", {"gap": 4e-4})
    shown = model.outputs(run(model, reading[0]), MANOEUVRE[:-1])["y_measured"]
    assert shown == pytest.approx(sensors._loose(machine, reading[:, 0])[1:], abs=1e-5)


@pytest.mark.parametrize("half", [2e-4, 5e-4])
def test_a_load_behind_a_play_moves_the_piston_alike(half: float) -> None:
    """The rig's faces are stiffer and let the load rebound; what the play does is nearer than nothing."""
    loose = {"load_share": 0.5, "coupling": 5e5, "coupling_damping": 300.0, "coupling_gap": half}
    _, reading = theirs(loose)
    begin = reading[0]
    with_play = run(ours("backlash", {"gap": 0.0, "load_share": 0.5, "load_gap": 2.0 * half}), begin)
    apart = [np.sqrt(((x[:, 1] - reading[1:, 1]) ** 2).mean()) for x in (with_play, run(AXIS, begin))]
    assert apart[0] < 0.75 * apart[1], apart


def test_wall_heat_of_another_law_is_met_by_one_time_constant() -> None:
    """The rig's film coefficient grows with pressure, ours takes one rate: nearer than no exchange by a factor."""
    _, reading = theirs({"wall_time": 0.2})
    with_heat, without = run(ours("heat_exchange", {"rate": 5.0}), reading[0]), run(AXIS, reading[0])
    apart = [np.sqrt(((x[:, 2:4] - reading[1:, 2:4]) ** 2).mean(axis=0)) for x in (with_heat, without)]
    assert np.all(apart[0] < 0.2 * apart[1])
