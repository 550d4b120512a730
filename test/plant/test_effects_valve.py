"""Effects of valve, supply and lines against values that theory gives."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python, machine

from pneumo_ros.plant import Model

OPEN = np.arctan(2.0 * (10.0 - 0.78))  # phi at 10 V
FILL, EMPTY = AXIS["arctan_flow.filling_coefficient"], AXIS["arctan_flow.exhaust_coefficient"]


def valve(name: str, **values: float) -> Model:
    """The axis with an effect at the given values, in a sled that cannot move."""
    given = {f"{name}.{key}": value for key, value in values.items()}
    return machine(name).with_parameters({**given, "piston.mass": 1e4, "lugre_friction.static_friction": 1e5})


def flows(model: Model, voltage: float, **state: float) -> tuple[float, float]:
    """Flows into both chambers at one instant."""
    plain = in_python(model)
    out = plain.outputs(plain.state(**state), voltage)
    return float(out["port_flow_a"][0]), float(out["port_flow_b"][0])


def openings(model: Model, voltage: np.ndarray) -> np.ndarray:
    """Opening at the end of each sample of a run."""
    return np.asarray(model.outputs(model.simulate(voltage, model.state()), voltage)["opening"])


def test_null_offset_shifts_both_limits_of_the_dead_zone() -> None:
    model = in_python(valve("valve_null_offset", offset=0.2))
    seen = [float(model.outputs(model.state(), u)["opening"][0]) for u in (0.57, 0.6, -0.97, -1.0)]
    assert seen == pytest.approx([0.0, 0.02, 0.0, -0.02], abs=1e-12)


def test_hysteresis_is_a_loop_of_twice_its_half_width() -> None:
    up = np.linspace(-3.0, 3.0, 121)
    seen = openings(valve("valve_hysteresis", half_width=0.15), np.concatenate([up, up[::-1], up]))
    falling, rising = seen[121:242][::-1], seen[242:]
    wide = (up > 1.2) & (up < 2.6)
    assert (falling - rising)[wide] == pytest.approx(np.full(wide.sum(), 0.3), abs=1e-9)
    assert rising[wide] == pytest.approx(up[wide] - 0.15 - 0.78, abs=1e-9)
    assert seen[0] == pytest.approx(-3.0 + 0.15 + 0.78, abs=1e-9), "from rest at 0 V"


def test_hysteresis_comes_before_the_spool_and_after_the_null() -> None:
    names = ["valve_spool_dynamics", "valve_hysteresis", "valve_null_offset"]
    model = in_python(AXIS.with_effects([*AXIS.effects, *names], {"valve_null_offset.offset": 0.1}))
    up = model.simulate(np.full(150, 2.0), model.state(), sample_time=2e-3, step=1e-3)
    down = model.simulate(np.full(150, 1.0), up[-1], sample_time=2e-3, step=1e-3)
    spool = model.states.index("x_s")
    assert up[-1, spool] == pytest.approx(2.0 + 0.1 - 0.1, abs=1e-5)
    assert down[-1, spool] == pytest.approx(1.0 + 0.1 + 0.1, abs=1e-5)


@pytest.mark.parametrize(("frequency", "damping"), [(80.0, 0.7), (40.0, 0.4), (150.0, 0.25)])
def test_spool_overshoots_a_step_as_the_textbook_says(frequency: float, damping: float) -> None:
    model = valve("valve_spool_dynamics", angular_frequency=frequency, damping_ratio=damping)
    spool = model.simulate(np.full(4000, 2.0), model.state(), sample_time=1e-4)[:, model.states.index("x_s")]
    root = np.sqrt(1.0 - damping**2)
    assert spool.max() == pytest.approx(2.0 * (1.0 + np.exp(-np.pi * damping / root)), rel=1e-4)
    assert (spool.argmax() + 1) * 1e-4 == pytest.approx(np.pi / (frequency * root), rel=1e-2)
    assert spool[-1] == pytest.approx(2.0, rel=1e-2)


def test_sonic_flow_does_not_depend_on_what_is_behind_the_edge() -> None:
    """ISO 6358: C rho_0 p_1 sqrt(T_0 / T) below the critical ratio, at 2 phi / pi of the full opening."""
    model = valve("choked_flow", conductance_filling=4e-9, conductance_exhaust=6e-9, critical_ratio=0.3)
    sonic = 1.185 * np.sqrt(293.15 / 293.0) * 2.0 / np.pi * OPEN
    for p in (1e5, 1.5e5, 2.1e5):
        assert flows(model, 10.0, p_a=p)[0] == pytest.approx(4e-9 * 7e5 * sonic, rel=1e-9)
        assert flows(model, -10.0, p_b=p)[1] == pytest.approx(4e-9 * 7e5 * sonic, rel=1e-9)
    for p in (3.4e5, 5e5):
        assert flows(model, 10.0, p_b=p)[1] == pytest.approx(-6e-9 * p * sonic, rel=1e-9)


def test_subsonic_flow_is_an_ellipse_and_vanishes_at_equal_pressures() -> None:
    model = valve("choked_flow", conductance_filling=4e-9, critical_ratio=0.3)
    sonic = 4e-9 * 1.185 * np.sqrt(293.15 / 293.0) * 7e5 * 2.0 / np.pi * OPEN
    assert flows(model, 10.0, p_a=0.65 * 7e5)[0] == pytest.approx(sonic * np.sqrt(1.0 - 0.5**2), rel=1e-9)
    near = [flows(model, 10.0, p_a=ratio * 7e5)[0] for ratio in (0.9989, 0.9991, 0.9995, 1.0, 1.0005)]
    assert near[1] == pytest.approx(near[0], rel=0.2)
    assert near[2] == pytest.approx(0.5 * near[1] / 0.9, rel=1e-9)
    assert near[3] == 0.0
    assert near[4] == pytest.approx(-near[2], rel=2e-3)


def test_half_blended_flow_lies_half_way() -> None:
    whole, half = valve("choked_flow"), valve("choked_flow", blend=0.5)
    linear = flows(AXIS, 10.0, p_a=3e5, p_b=4e5)
    for side in (0, 1):
        mean = 0.5 * (flows(whole, 10.0, p_a=3e5, p_b=4e5)[side] + linear[side])
        assert flows(half, 10.0, p_a=3e5, p_b=4e5)[side] == pytest.approx(mean, rel=1e-12)


def test_leaking_valve_evens_a_closed_axis_out_between_supply_and_atmosphere() -> None:
    model = valve("valve_internal_leakage", conductance=5e-9)
    assert flows(model, 0.0, p_a=3e5, p_b=6e5) == pytest.approx((5e-9 * 2e5, -5e-9 * 4e5), rel=1e-12)
    x = model.simulate(np.zeros(6000), model.state(p_a=2e5, p_b=6e5))
    assert x[-1, 2:4] == pytest.approx([4e5, 4e5], rel=1e-2)


def test_valve_leakage_fades_with_the_opening() -> None:
    model = valve("valve_internal_leakage", conductance=1e-9, width=0.5)
    leak = [flows(model, u, p_a=3e5)[0] - flows(AXIS, u, p_a=3e5)[0] for u in (0.0, 0.78, 1.28, 1.78)]
    assert leak == pytest.approx([2e-4 * np.exp(-((2.0 * u) ** 2)) for u in (0.0, 0.0, 0.5, 1.0)], rel=1e-9)


def test_supply_falls_by_its_resistance_times_the_flow_with_its_time_constant() -> None:
    """In chambers so large that they never fill, the drop settles at d = R phi beta (p_s - d - p_a)."""
    model = valve("supply_pressure_droop", resistance_supply=5e7, time_constant=0.05).with_parameters(
        {"chambers.volume_a": 10.0, "chambers.volume_b": 10.0}
    )
    drop = model.simulate(np.full(600, 10.0), model.state())[:, model.states.index("d_s")]
    gain = 5e7 * OPEN * FILL
    t = 1e-3 * np.arange(1, 601)
    expected = gain * 6e5 / (1.0 + gain) * (1.0 - np.exp(-(1.0 + gain) * t / 0.05))
    assert drop == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("delay", [0.02, 6e-3, 1e-3])
def test_all_that_enters_a_line_leaves_it_one_delay_later(delay: float) -> None:
    """Total flow and centre of gravity in time of a pulse, however short the line."""
    model = valve("line_delay", delay=delay).with_parameters({"chambers.volume_a": 10.0, "chambers.volume_b": 10.0})
    voltage = np.repeat([0.0, 10.0, 0.0], [20, 300, 1680])
    x = model.simulate(voltage, model.state(p_b=5e5), sample_time=1e-4)
    ports, t = model.outputs(x, voltage), 1e-4 * np.arange(1, 2001)
    sent = AXIS.outputs(x[:, : len(AXIS.states)], voltage)  # flow of the same valve without delay
    for port in ("port_flow_a", "port_flow_b"):
        assert ports[port].sum() == pytest.approx(sent[port].sum(), rel=2e-3)
        late = (t * ports[port]).sum() / ports[port].sum() - (t * sent[port]).sum() / sent[port].sum()
        assert late == pytest.approx(delay, abs=6e-5)  # half a sample


def test_friction_of_the_line_takes_its_share() -> None:
    """exp(-p_l / p) of Richer and Hurmuzlu."""
    model = valve("line_delay", delay=0.0, loss_pressure=2e4)
    ports, sent = flows(model, 10.0, p_a=2e5, p_b=5e5), flows(AXIS, 10.0, p_a=2e5, p_b=5e5)
    assert ports == pytest.approx((sent[0] * np.exp(-0.1), sent[1] * np.exp(-0.04)), rel=1e-12)
