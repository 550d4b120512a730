"""Every number of the model's specification, from the compiled model."""

import numpy as np
import pytest

from pneumo_ros.plant import Model, load_model

# The steady state does not depend on volumes: a stroke of 20 m leaves time to settle.
LONG = {"piston.stroke": 20.0, "chambers.volume_a": 4.2e-3, "chambers.volume_b": 3.1e-3}


@pytest.fixture(scope="module")
def axis() -> Model:
    return load_model("axis")


def steady(model: Model, voltage: float) -> np.ndarray:
    """State at constant voltage after four long strokes, each begun as the last one ended: settled, and checked."""
    ends = [model.state(p_a=3.5e5, p_b=3.5e5)]
    for _ in range(4):
        start = ends[-1].copy()
        start[0] = -8.0 if voltage > 0.0 else 8.0
        ends.append(model.simulate(np.full(60, voltage), start, sample_time=1.0)[-1])
    assert ends[-1][1:4] == pytest.approx(ends[-2][1:4], rel=1e-6), "not settled"
    return ends[-1]


@pytest.mark.parametrize(
    ("machine", "voltage", "speed"),
    [
        ("axis", 7.0, 0.1827),
        ("axis", 2.0, 0.1795),
        ("axis", 1.0, 0.1561),
        ("axis", -7.0, -0.1465),
        ("paper", 7.0, 0.1888),
        ("paper", -7.0, -0.1385),
    ],
)
def test_steady_speed(machine: str, voltage: float, speed: float) -> None:
    assert steady(load_model(machine).with_parameters(LONG), voltage)[1] == pytest.approx(speed, rel=1e-3)


@pytest.mark.parametrize(("voltage", "pressures"), [(7.0, (6.446e5, 1.051e5)), (-7.0, (1.056e5, 6.664e5))])
def test_steady_pressures(axis: Model, voltage: float, pressures: tuple[float, float]) -> None:
    assert steady(axis.with_parameters(LONG), voltage)[2:4] == pytest.approx(pressures, rel=1e-3)


def test_sliding_bristle_bends_by_50_um(axis: Model) -> None:
    assert steady(axis.with_parameters(LONG), 7.0)[4] == pytest.approx(50e-6, rel=1e-6)


DISREGARDED = {
    "air.heat_capacity_ratio": 1.0,
    "chambers.volume_a": 6e-3,
    "chambers.volume_b": 5e-3,
    "piston.mass": 20.0,
    "lugre_friction.bristle_stiffness": 3e5,
    "lugre_friction.bristle_damping": 500.0,
}


@pytest.mark.parametrize("name", DISREGARDED)
def test_steady_state_does_not_know(axis: Model, name: str) -> None:
    long = axis.with_parameters(LONG)
    changed = long.with_parameters({name: DISREGARDED[name]})
    assert steady(changed, 1.2)[1:4] == pytest.approx(steady(long, 1.2)[1:4], rel=1e-5)


@pytest.mark.parametrize(
    "name", ["lugre_friction.coulomb_friction", "quadratic_drag.coefficient", "arctan_flow.filling_coefficient"]
)
def test_steady_state_does_know(axis: Model, name: str) -> None:
    long = axis.with_parameters(LONG)
    changed = long.with_parameters({name: 1.1 * long[name]})
    assert abs(steady(changed, 7.0)[1] / steady(long, 7.0)[1] - 1.0) > 1e-3


def test_air_spring_has_345_newtons_per_metre(axis: Model) -> None:
    p_b = (axis["piston.area_a"] * 4e5 - 11.0) / axis["piston.area_b"]  # where the forces balance
    slope = axis.derivatives(axis.state(v=1e-3, p_a=4e5, p_b=p_b), 0.0)[0]
    stiffness = (axis["piston.area_b"] * slope[3] - axis["piston.area_a"] * slope[2]) / 1e-3
    assert stiffness == pytest.approx(345.0, rel=1e-3)


def test_air_spring_swings_at_1_32_hertz(axis: Model) -> None:
    smooth = axis.with_effects(["dead_zone", "arctan_flow", "rod_atmospheric_force"])
    p_b = (smooth["piston.area_a"] * 4e5 - 11.0) / smooth["piston.area_b"]
    v = smooth.simulate(np.zeros(8000), smooth.state(v=1e-3, p_a=4e5, p_b=p_b))[:, 1]
    falls = np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0))
    assert (len(falls) - 1) / ((falls[-1] - falls[0]) * 1e-3) == pytest.approx(1.32, abs=0.005)


def test_bristle_bends_by_71_4_um_before_it_slides(axis: Model) -> None:
    """Creeping towards z_max(0) = F_s / sigma_0 the deflection still grows; beyond, it shrinks."""
    limit = axis["lugre_friction.static_friction"] / axis["lugre_friction.bristle_stiffness"]
    assert limit == pytest.approx(71.4e-6, rel=1e-3)
    before, at, beyond = (
        axis.derivatives(axis.state(v=1e-7, z=limit * share), 0.0)[0, 4] for share in (0.999, 1.0, 1.001)
    )
    assert before > 0.0 > beyond
    assert at == pytest.approx(0.0, abs=1e-15)


def test_caution_speaks_above_3761_newton_seconds_per_metre(axis: Model) -> None:
    assert axis.cautions() == ()
    assert axis.with_parameters({"lugre_friction.bristle_damping": 3760.0}).cautions() == ()
    (sentence,) = axis.with_parameters({"lugre_friction.bristle_damping": 3762.0}).cautions()
    assert "3761" in sentence
    assert "passive" in sentence


def test_stuck_piston_rings_at_84_hertz_with_a_damping_ratio_of_0_009(axis: Model) -> None:
    """Without voltage the piston swings on its bristles; logarithmic decrement over ten swings."""
    start = axis.state(v=1e-4, p_a=3e5, p_b=(4.1e-4 * 3e5 - 11.0) / 3e-4)  # where the forces balance
    velocity = axis.simulate(np.zeros(4000), start, sample_time=1e-4)[:, 1]
    tops = np.flatnonzero((velocity[1:-1] > velocity[:-2]) & (velocity[1:-1] >= velocity[2:])) + 1
    assert 10.0 / ((tops[10] - tops[0]) * 1e-4) == pytest.approx(84.2, abs=0.3)
    decrement = np.log(velocity[tops[0]] / velocity[tops[10]]) / (20.0 * np.pi)
    assert decrement == pytest.approx(0.0094, abs=0.0003)
