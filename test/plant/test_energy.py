"""The integrator adds and removes no energy: oscillations decay as they should; gas and mass are conserved."""

from pathlib import Path

import numpy as np
import pytest
from plant.user_files import composed, one

from pneumo_ros.plant import Library, Model, load_model

SLED = {"piston.mass": 5.0, "lugre_friction.bristle_stiffness": 1.4e6}


def sled(damping: float) -> Model:
    """A mass on its bristles, without gas."""
    values = {**SLED, "lugre_friction.bristle_damping": damping}
    return Model.build(["lugre_friction"], values, library=Library(), frame=("piston",), defaults=True)


def energy(model: Model, x: np.ndarray) -> np.ndarray:
    """Kinetic energy and that of the bent bristles [J]."""
    mass, stiffness = model["piston.mass"], model["lugre_friction.bristle_stiffness"]
    return np.asarray(0.5 * mass * x[:, 1] ** 2 + 0.5 * stiffness * x[:, 2] ** 2)


@pytest.mark.parametrize("step", [1e-5, 1e-4, 5e-4])
def test_undamped_ringing_goes_on_for_two_thousand_swings(step: float) -> None:
    model = sled(damping=0.0)
    period = 2.0 * np.pi * np.sqrt(5.0 / 1.4e6)
    count = int(2000 * period / step) if step > 1e-5 else 200000
    x = model.simulate(np.zeros(count), model.state(v=0.01), sample_time=step, step=step)
    part = int(20 * period / step)
    first, last = energy(model, x[:part]), energy(model, x[-part:])
    assert last.mean() == pytest.approx(first.mean(), rel=2e-4)
    assert last.max() == pytest.approx(first.max(), rel=2e-3)


def test_damped_ringing_loses_what_the_bristles_dissipate() -> None:
    """Energy lost = integral of sigma_1 v^2 dt; with alpha = 0 nothing else takes any."""
    model = sled(damping=50.0)
    x = model.simulate(np.zeros(20000), model.state(v=0.01), sample_time=1e-5, step=1e-5)
    lost = 0.5 * 5.0 * 0.01**2 - energy(model, x)[-1]
    speed = np.concatenate([[0.01], x[:, 1]])
    dissipated = 50.0 * np.sum((0.5 * (speed[1:] + speed[:-1])) ** 2) * 1e-5
    assert lost == pytest.approx(dissipated, rel=1e-3)
    assert lost > 0.5 * 5.0 * 0.01**2 * 0.5  # there was energy to lose


def test_closed_chambers_swing_as_an_adiabatic_spring() -> None:
    """Without friction and with the valve shut, p V^gamma stays, and so does the swing."""
    model = load_model("axis").with_effects(["dead_zone", "arctan_flow", "rod_atmospheric_force"])
    start = model.state(v=0.3, p_a=3e5, p_b=(4.1e-4 * 3e5 - 11.0) / 3e-4)
    x = model.simulate(np.zeros(20000), start)
    volume = model["chambers.volume_a"] + model["piston.area_a"] * x[:, 0]
    invariant = x[:, 2] * volume ** model["air.heat_capacity_ratio"]
    assert invariant == pytest.approx(invariant[0], rel=1e-6)
    assert x[-4000:, 1].max() == pytest.approx(x[:4000, 1].max(), rel=1e-5)


@pytest.mark.parametrize("gamma", [1.0, 1.4])
def test_chambers_hold_what_flows_in(gamma: float) -> None:
    """Energy balance of Eqs. 3-4: d(p V)/dt + (gamma - 1) p V' = gamma R T q, in random states of the running axis."""
    model = load_model("axis").with_parameters({"air.heat_capacity_ratio": gamma})
    random = np.random.default_rng(3)
    x = np.array([model.state(y=y) for y in random.uniform(-0.9, 0.9, 50)])
    x[:, 1], x[:, 2:4] = random.uniform(-1.0, 1.0, 50), random.uniform(1e5, 7e5, (50, 2))
    voltage = random.uniform(-10.0, 10.0, 50)
    slope, seen = model.derivatives(x, voltage), model.outputs(x, voltage)
    for side, sign, p in (("a", 1.0, 2), ("b", -1.0, 3)):
        area = sign * model[f"piston.area_{side}"]
        volume = model[f"chambers.volume_{side}"] + area * x[:, 0]
        flow = (volume * slope[:, p] + gamma * x[:, p] * area * x[:, 1]) / (gamma * 287.0 * 293.0)
        assert flow == pytest.approx(seen[f"port_flow_{side}"], rel=1e-9, abs=1e-12)


def test_isothermal_chamber_keeps_count_of_its_mass() -> None:
    """With gamma = 1 the mass p V / (R T) changes by what flows through the port, over a whole run."""
    model = load_model("axis").with_parameters({"air.heat_capacity_ratio": 1.0})
    voltage = np.repeat([3.0, -2.0, 0.0, 1.5], 200)
    x = model.simulate(voltage, model.state(p_a=3e5, p_b=4e5), sample_time=1e-4, step=1e-5)
    flow = model.outputs(x, voltage)["port_flow_a"]
    mass = x[:, 2] * (model["chambers.volume_a"] + model["piston.area_a"] * x[:, 0]) / (287.0 * 293.0)
    held = np.flatnonzero(np.diff(voltage) == 0.0)  # the flow jumps with the voltage
    gained, flowed = np.diff(mass)[held].sum(), 0.5 * (flow[1:] + flow[:-1])[held].sum() * 1e-4
    assert gained == pytest.approx(flowed, rel=1e-5)
    assert abs(flowed) > 1e-6


def test_heat_raises_the_pressure_by_gamma_less_one_over_the_volume(tmp_path: Path) -> None:
    """p' = (gamma - 1) Q / V: first law at constant volume."""
    heaters = "heat_a, heat_b = 30.0 + 0.0 * v, -20.0 + 0.0 * v"
    model = composed(tmp_path, one("v", heaters, "return heat_a, heat_b"), "own")
    slope = model.derivatives(model.state(y=0.3), 0.0)[0, 2:4]
    volumes = np.array([5.1e-4 + 0.3 * 4.1e-4, 4.0e-4 - 0.3 * 3.0e-4])
    assert slope == pytest.approx(0.4 * np.array([30.0, -20.0]) / volumes, rel=1e-12)


def test_added_volume_and_mass_take_their_place(tmp_path: Path) -> None:
    body = "added_volume_a, added_volume_b, added_mass = 1e-4 + 0.0 * v, 2e-4 + 0.0 * v, 5.0 + 0.0 * v"
    model = composed(tmp_path, one("v", body, "return added_volume_a, added_volume_b, added_mass"), "own")
    state = {"v": 0.1, "p_a": 3e5, "p_b": 4e5, "z": 5e-5}
    axis = load_model("axis")
    more, base = (m.derivatives(m.state(**state), 3.0)[0] for m in (model, axis))
    assert more[1] == pytest.approx(0.5 * base[1], rel=1e-12)
    assert more[2:4] == pytest.approx(base[2:4] * [5.1e-4 / 6.1e-4, 4.0e-4 / 6.0e-4], rel=1e-12)
