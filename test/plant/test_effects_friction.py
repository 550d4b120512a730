"""Effects of friction against values that theory gives."""

import numpy as np
import pytest
from plant.catalogue import EFFECTS, effect_function, in_python, lone_machine
from plant.driven import F_C, F_S, SIGMA, V_S, along, sliding

from pneumo_ros.plant import Library, Model

FAST, SLOW = 0.3, 0.02  # m/s: without Stribeck decay, and with little of it


def test_viscous_friction_is_in_proportion_to_velocity() -> None:
    assert sliding("viscous_friction", 0.4, coefficient=80.0) == pytest.approx(32.0, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.3, -0.2])
def test_asymmetric_friction_has_two_levels(ratio: float) -> None:
    assert sliding("asymmetric_friction", FAST, ratio=ratio) == pytest.approx(F_C, rel=1e-9)
    assert sliding("asymmetric_friction", -FAST, ratio=ratio) == pytest.approx(-(1.0 + ratio) * F_C, rel=1e-9)


def test_asymmetric_friction_does_not_jump_at_reversal() -> None:
    """Though the level falls from 140 N to 100 N at once, the bristle keeps its deflection and unloads as it moves."""
    model = lone_machine("asymmetric_friction").with_parameters({"asymmetric_friction.ratio": 1.0})
    v = 0.05 * -np.cos(2.0 * np.pi * 1.0 * np.arange(601) * 1e-3)
    _, seen = along(model, -0.1 * np.ones(601), v, 1e-3)
    turn = np.flatnonzero(np.diff(np.sign(v)))[0]
    assert seen["friction"][turn] < -1.9 * F_C
    assert abs(np.diff(seen["friction"])[turn]) < 1.5 * SIGMA * 2.0 * np.abs(v[turn : turn + 2]).max() * 1e-3


def test_asymmetric_viscous_friction_has_a_slope_for_each_direction() -> None:
    name, given = "asymmetric_viscous_friction", {"coefficient_extension": 20.0, "coefficient_retraction": 60.0}
    slopes = [
        (sliding(name, sign * 0.4, **given) - sliding(name, sign * 0.2, **given)) / (sign * 0.2) for sign in (1, -1)
    ]
    assert slopes == pytest.approx([20.0, 60.0], rel=1e-9)


def test_friction_rises_with_the_mean_gauge_pressure() -> None:
    rise = [sliding("pressure_dependent_friction", FAST, p=p, coefficient=5e-5) - F_C for p in (1e5, 2e5, 6e5, 5e4)]
    assert rise == pytest.approx([0.0, 5.0, 25.0, 0.0], rel=1e-9, abs=1e-9)


def test_friction_rises_with_the_force_that_a_transmission_passes_on() -> None:
    """Half the sum of what pushes its two sides: 0 where a load is released as hard as it is driven."""
    effect = effect_function(EFFECTS["load_dependent_friction"], "equations")
    pushed = ((10.0, 10.0), (10.0, 0.0), (-5.0, -15.0), (8.0, -8.0))
    rise, static = zip(*(effect(drive, load, 0.4, 0.02, 0.1) for drive, load in pushed), strict=True)
    assert rise == pytest.approx([6.0, 2.5, 6.0, 0.0])
    assert static == pytest.approx([1.0, 0.5, 1.0, 0.0])


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("speed", [0.5 * V_S, V_S, 2.0 * V_S])
def test_stribeck_curve_falls_with_the_exponent_given(exponent: float, speed: float) -> None:
    level = F_C + (F_S - F_C) * np.exp(-((speed / V_S) ** exponent))
    for sign in (1.0, -1.0):
        friction = sliding("stribeck_shape", sign * speed, exponent=exponent, seconds=0.5)
        assert friction == pytest.approx(sign * level, rel=1e-9)


def test_warm_friction_decays_with_the_running_time() -> None:
    values = {"friction_warmup.share": 0.3, "friction_warmup.time_constant": 0.5}
    model = lone_machine("friction_warmup").with_parameters(values)
    _, seen = along(model, np.zeros(3001), np.full(3001, FAST), 1e-3)
    t = 1e-3 * np.arange(3001)
    assert seen["friction"][100:] == pytest.approx(F_C * (0.7 + 0.3 * np.exp(-t[100:] / 0.5)), rel=1e-4)


def test_equal_knots_are_a_constant_profile_to_the_very_ends() -> None:
    knots = {f"knot_{i:02d}": 0.25 for i in range(25)}
    levels = [sliding("position_dependent_friction", FAST, y=y, **knots) for y in (-1.0, -0.97, 0.013, 0.6, 1.0)]
    assert levels == pytest.approx([1.25 * F_C] * 5, rel=1e-9)


def test_one_knot_is_a_spot_of_four_intervals() -> None:
    """Cubic B-spline: 2/3 at its knot, 1/6 at the next, nothing from the second on."""
    spot = {"knot_12": 0.0, "knot_18": 0.6}
    levels = [sliding("position_dependent_friction", FAST, y=0.5 + i / 12.0, **spot) for i in (0, 1, -1, 2, -2, -5)]
    assert levels == pytest.approx([F_C * (1.0 + 0.6 * s) for s in (2 / 3, 1 / 6, 1 / 6, 0, 0, 0)], rel=1e-9)


def test_knots_follow_a_smooth_profile_closely() -> None:
    """A straight profile is met exactly, as a spline of third degree must."""
    straight = {f"knot_{i:02d}": 0.02 * i for i in range(25)}
    levels = [sliding("position_dependent_friction", FAST, y=y, **straight) for y in (-0.5, -0.123, 0.4)]
    assert levels == pytest.approx([F_C * (1.0 + 0.24 * (1.0 + y)) for y in (-0.5, -0.123, 0.4)], rel=1e-9)


def test_a_spot_ends_at_its_width() -> None:
    """Friction is as beside it from there on; within it follows (1 - s^2)^3, tight or loose."""
    spot = {"knot_12": 0.0, "spot_height": 0.6, "spot_centre": -0.2, "spot_width": 0.05}
    at = np.array([0.0, 0.5, -0.5, 1.0, -1.0, 3.0])
    levels = [sliding("position_dependent_friction", FAST, y=2.0 * (-0.2 + 0.05 * s), **spot) for s in at]
    shares = np.maximum(1.0 - at**2, 0.0) ** 3
    assert levels == pytest.approx(F_C * (1.0 + 0.6 * shares), rel=1e-9)
    loose = sliding("position_dependent_friction", FAST, y=-0.4, **(spot | {"spot_height": -0.6}))
    assert loose == pytest.approx(0.4 * F_C, rel=1e-9)


@pytest.mark.parametrize("time_constant", [0.05, 5e-3, 5e-4, 5e-5])
def test_lagged_friction_sees_the_velocity_of_then(time_constant: float) -> None:
    """For a steadily growing velocity, a first-order lag gives that of one time constant ago, even a very short one."""
    model = lone_machine("friction_lag").with_parameters({"friction_lag.time_constant": time_constant})
    v = 0.5 * 1e-3 * np.arange(1001)
    x, _ = along(model, np.zeros(1001), v, 1e-3)
    slip, _, _ = effect_function(EFFECTS["friction_lag"], "equations")(v[-1], x[-1, -1], time_constant)
    assert v[-1] - slip == pytest.approx(0.5 * time_constant, rel=6e-2)


def test_lagged_friction_opens_a_loop_that_grows_with_frequency() -> None:
    """Around a mean speed on the falling branch friction is lower while speeding up than while slowing down."""

    def loop(frequency: float) -> float:
        model = lone_machine("friction_lag").with_parameters({"friction_lag.time_constant": 5e-3})
        count = round(2e3 / frequency)
        phase = 2.0 * np.pi * np.arange(2 * count + 1) / count
        _, seen = along(model, np.zeros(len(phase)), 0.02 - 0.01 * np.cos(phase), 1e-3 / 2.0)
        last = seen["friction"][-count:]
        return float(last[round(0.25 * count)] - last[round(0.75 * count)])

    assert loop(1.0) > 0.1
    assert loop(4.0) > 3.0 * loop(1.0)


@pytest.mark.parametrize("pause", [0.1, 0.5, 1.0, 10.0])
def test_breakaway_rises_with_the_time_of_rest_and_saturates(pause: float) -> None:
    """Under a rising pull the piston breaks away at F_s + rise (1 - exp(-pause / tau)): bending renews little here."""
    library = Library()
    values = {"dwell_time_breakaway.rise": 30.0, "dwell_time_breakaway.distance": 0.1}
    model = Model.build(
        ["lugre_friction", "dwell_time_breakaway"], values, library=library, frame=("piston",), defaults=True
    )
    force = np.linspace(95.0, 135.0, 400)
    start = model.state(z=95.0 / SIGMA, age=pause)
    x = in_python(model).simulate(force, start, sample_time=1e-3, step=2.5e-4)
    left = force[np.flatnonzero(x[:, 1] > 2e-3)[0]]
    expected = F_S + 30.0 * (1.0 - np.exp(-(pause + (left - 95.0) * 0.01) / 1.0))
    assert left == pytest.approx(expected, abs=1.5)


def test_sliding_renews_the_contact() -> None:
    model = lone_machine("dwell_time_breakaway")
    x, _ = along(model, np.zeros(21), np.full(21, 0.1), 1e-3, age=5.0)
    assert x[:, -1] == pytest.approx(1e-3 + (5.0 - 1e-3) * np.exp(-1e-3 * np.arange(21) * 0.1 / 1e-4), rel=1e-6)
    x, _ = along(model, np.zeros(1001), np.zeros(1001), 1e-3, age=0.5)
    assert x[-1, -1] == pytest.approx(1.5, rel=1e-9)
