"""The bristle: no creep below breakaway, bounded and accurate at any speed, where plain Runge-Kutta is neither."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.plant import Model, load_model

SLED = """/**:
  ros__parameters:
    effects: [{friction}]
    piston: {{mass: 5.0, area_a: 4.1e-4, area_b: 3.0e-4, stroke: 2.0}}
    {friction}: {{static_friction: 100.0, coulomb_friction: 70.0, stribeck_velocity: 0.01, bristle_stiffness: 1.4e+6,
      bristle_damping: 50.0{more}}}
"""
PLAIN_LUGRE = '''
class PlainLugre(Effect):
    """LuGre friction as published first, in which the bristle yields under any load (alpha = 1)."""

    static_friction = Parameter(100.0, "N", "static friction")
    coulomb_friction = Parameter(70.0, "N", "Coulomb friction")
    stribeck_velocity = Parameter(0.01, "m/s", "Stribeck velocity")
    bristle_stiffness = Parameter(1.4e6, "N/m", "bristle stiffness")
    bristle_damping = Parameter(50.0, "N s/m", "bristle damping")
    z = State("m", "bristle deflection")

    def equations(v, z, stribeck, static_friction, coulomb_friction, bristle_stiffness, bristle_damping):
        g = coulomb_friction + (static_friction - coulomb_friction) * stribeck
        rate_z = bristle_stiffness * abs(v) / g
        der_z = v - rate_z * z
        friction = bristle_stiffness * z + bristle_damping * der_z
        return friction, der_z, rate_z
'''


def sled(folder: Path, friction: str) -> Model:
    """Mass and friction alone, pushed by a force: a machine file without chambers, here with an effect of its own."""
    effects = folder / "effects.py"
    effects.write_text("from pneumo_ros.plant import Effect, Parameter, State\n" + PLAIN_LUGRE)
    more = ", breakaway_ratio: 0.9" if friction == "lugre_friction" else ""
    machine = folder / "sled.yaml"
    machine.write_text(SLED.format(friction=friction, more=more))
    return load_model(machine, [effects])


def test_machine_without_chambers_is_driven_by_force(tmp_path: Path) -> None:
    model = sled(tmp_path, "lugre_friction")
    assert model.force_driven
    assert model.states == ("y", "v", "z")
    free = model.with_effects([])
    assert free.simulate(np.full(10, 3.0), free.state(), sample_time=0.1)[-1, 1] == pytest.approx(3.0 / 5.0, rel=1e-12)


@pytest.mark.parametrize(
    ("friction", "creep", "within"), [("plain_lugre", 5.8e-4, 5e-6), ("lugre_friction", 0.0, 1e-9)]
)
def test_drift_below_breakaway(tmp_path: Path, friction: str, creep: float, within: float) -> None:
    """40 N + 20 N sin at 2 Hz over 20 cycles, after six in which the ring of the first push dies away."""
    times = (np.arange(130000) + 0.5) * 1e-4
    y = sled(tmp_path, friction)
    x = y.simulate(40.0 + 20.0 * np.sin(4.0 * np.pi * times), y.state(), sample_time=1e-4)
    assert x[-1, 0] - x[30000 - 1, 0] == pytest.approx(creep, abs=within)


@pytest.mark.parametrize("step", [1e-5, 1e-4, 2e-4, 5e-4])
def test_deflection_never_exceeds_its_bound(step: float) -> None:
    """|z| <= F_s / sigma_0 if it starts so: any speed to 5 m/s, any voltage, any permitted friction level."""
    axis, random, lanes = load_model("axis"), np.random.default_rng(1), 48
    q = np.tile(axis.values, (lanes, 1))
    names = list(axis.parameters)
    coulomb, static = names.index("lugre_friction.coulomb_friction"), names.index("lugre_friction.static_friction")
    q[:, coulomb] = random.uniform(5.0, 200.0, lanes)
    q[:, static] = q[:, coulomb] * random.uniform(1.0, 3.0, lanes)
    bound = q[:, static] / axis["lugre_friction.bristle_stiffness"]
    x = np.tile(axis.state(), (lanes, 1))
    x[:, 1] = random.uniform(-5.0, 5.0, lanes)
    x[:, 2:4] = random.uniform(1e5, 7e5, (lanes, 2))
    x[:, 4] = random.uniform(-1.0, 1.0, lanes) * bound
    out = axis.simulate_lanes(
        np.repeat(random.uniform(-10.0, 10.0, 20), 20), x, q, sample_time=1e-3 if step > 1e-5 else 2e-4, step=step
    )
    assert np.isfinite(out).all()
    assert np.all(np.abs(out[:, :, 4]) <= bound[:, None] * (1.0 + 1e-12))


def runge_kutta(model: Model, x: np.ndarray, h: float, steps: int) -> np.ndarray:
    """The classical method on the model's own equations: what our step replaces."""
    rows = []
    for _ in range(steps):
        k1 = model.derivatives(x, 0.0)[0]
        k2 = model.derivatives(x + 0.5 * h * k1, 0.0)[0]
        k3 = model.derivatives(x + 0.5 * h * k2, 0.0)[0]
        k4 = model.derivatives(x + h * k3, 0.0)[0]
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        rows.append(x)
    return np.array(rows)


@pytest.fixture(scope="module")
def heavy() -> Model:
    """So heavy and smooth that its speed stays constant: only the bristle moves, towards 50 um."""
    return load_model("axis").with_parameters({"piston.mass": 1e4, "quadratic_drag.coefficient": 0.0})


@pytest.mark.parametrize(("speed", "stable"), [(1.38, True), (1.40, False), (3.0, False)])
def test_runge_kutta_loses_the_bristle_above_1_39_metres_per_second(heavy: Model, speed: float, stable: bool) -> None:
    """At rest in z = 50 um (1 + 1e-9), the deviation dies away below 1.39 m/s and grows above."""
    start = heavy.state(v=speed, p_a=3e5, p_b=4e5, z=50e-6 * (1.0 + 1e-9))
    deviation = np.abs(runge_kutta(heavy, start, 1e-4, 400)[:, 4] - 50e-6)
    assert (deviation[-1] < 1e-14) == stable


@pytest.mark.parametrize("speed", [1.0, 1.5, 3.0, 5.0])
@pytest.mark.parametrize("step", [1e-4, 5e-4])
def test_our_step_keeps_the_bristle_at_any_speed(heavy: Model, speed: float, step: float) -> None:
    x = heavy.simulate(np.zeros(400), heavy.state(v=speed, p_a=3e5, p_b=4e5, z=0.0), sample_time=step, step=step)
    assert x[20:, 4] == pytest.approx(50e-6, rel=1e-6)


def test_our_step_is_exact_at_constant_speed(heavy: Model) -> None:
    """z' = v - sigma_0 |v| z / F_c, from where the bristle yields fully."""
    speed, h, start = 2.0, 2e-4, 60e-6  # above z_max = 50 um, and it stays above
    z = heavy.simulate(np.zeros(5), heavy.state(v=speed, p_a=3e5, p_b=4e5, z=start), sample_time=h, step=h)[:, 4]
    rate = 1.4e6 * speed / 70.0
    exact = 50e-6 + (start - 50e-6) * np.exp(-rate * h * np.arange(1, 6))
    assert z == pytest.approx(exact, rel=1e-6)
