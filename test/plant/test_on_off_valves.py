"""On/off valves and pressure regulators: pulses, delays, least pulse, average flow, and pressures held."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python

from pneumo_ros.diagnose.hypothesis import missing
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import SENSORS

STILL = {"piston.mass": 1e4, "lugre_friction.static_friction": 1e5, "chambers.volume_a": 5.0, "chambers.volume_b": 5.0}
PLAIN = [name for name in AXIS.effects if name != "dead_zone"]


def valves(**values: float) -> Model:
    """The axis with on/off valves, a piston that cannot move, and chambers so large that they never fill."""
    given = {f"on_off_valves.{key}": value for key, value in values.items()}
    return AXIS.with_effects([*PLAIN, "on_off_valves"], {**STILL, **given})


def body(model: Model, volts: np.ndarray, side: str = "a") -> np.ndarray:
    """Position of the valves of a chamber at the end of each tenth of a millisecond."""
    x = model.simulate(volts, model.state(), sample_time=1e-4)
    return np.asarray(x[:, model.states.index(f"body_{side}")])


def mean_flow(model: Model, volts: float) -> tuple[float, float]:
    """Mean flow into both chambers over 1 s, over that of valves that are fully open."""
    held = np.full(10_000, volts)
    seen = model.outputs(model.simulate(held, model.state(p_b=4e5), sample_time=1e-4), held)
    full = np.arctan(2.0 * 10.0)
    fill, empty = AXIS["arctan_flow.filling_coefficient"] * 6e5, AXIS["arctan_flow.exhaust_coefficient"] * 3e5
    return float(seen["port_flow_a"].mean() / (full * fill)), float(seen["port_flow_b"].mean() / (full * empty))


def test_a_command_opens_and_closes_after_its_delays() -> None:
    """Half way of the travel is reached a delay and half a travel after the command."""
    model = valves(pulse_frequency=0.0, switch_on=8e-3, switch_off=3e-3, travel=1e-3)
    seen = body(model, np.repeat([0.0, 10.0, 0.0], [100, 400, 400]))
    opened, closed = int(np.argmax(seen > 0.5)) * 1e-4 - 0.01, (500 + int(np.argmax(seen[500:] < 0.5))) * 1e-4 - 0.05
    assert opened == pytest.approx(8.5e-3, abs=2.5e-4)
    assert closed == pytest.approx(3.5e-3, abs=2.5e-4)
    assert seen.max() == pytest.approx(1.0, abs=1e-3)


def test_pairs_of_valves_close_before_the_other_opens() -> None:
    seen = body(valves(pulse_frequency=0.0, switch_on=6e-3, switch_off=2e-3), np.repeat([10.0, -10.0], 300))
    assert seen[250] == pytest.approx(1.0, abs=1e-3)
    assert abs(seen[300 + 45]) < 1e-2, "closed 4.5 ms after the change"
    assert seen[-1] == pytest.approx(-1.0, abs=1e-3)


@pytest.mark.parametrize("name", ["least_pulse", "switch_on"])
def test_a_pulse_that_is_too_short_passes_nothing(name: str) -> None:
    """By the driver's least pulse, or as the valve body has not begun to move; 9 % of 20 ms is 1.8 ms, 12 % 2.4 ms."""
    times = {"switch_on": 1e-4, "switch_off": 1e-4} | {name: 2.1e-3}
    model = valves(pulse_frequency=50.0, travel=3e-4, **times)
    assert body(model, np.full(2000, 0.9)).max() == 0.0
    assert body(model, np.full(2000, 1.2)).max() > 0.3


def test_mean_flow_follows_the_duty() -> None:
    """Equal delays shift pulses and change no mean, which so is the duty; chamber b empties as chamber a fills."""
    model = valves(pulse_frequency=25.0, switch_on=2e-3, switch_off=2e-3, travel=2e-4)
    flows = [mean_flow(model, volts) for volts in (2.0, 5.0, 8.0, 10.0)]
    assert [a for a, _ in flows] == pytest.approx([0.2, 0.5, 0.8, 1.0], abs=0.03)
    assert [-b for _, b in flows] == pytest.approx([0.2, 0.5, 0.8, 1.0], abs=0.03)
    late = mean_flow(valves(pulse_frequency=25.0, switch_on=6e-3, switch_off=2e-3, travel=2e-4), 5.0)[0]
    assert late == pytest.approx(0.5 - 4e-3 * 25.0, abs=0.03), "each pulse is shorter by the difference of the delays"


def test_three_way_valves_fill_or_empty_and_never_close() -> None:
    model = valves(three_way=1.0, pulse_frequency=25.0, switch_on=2e-3, switch_off=2e-3, travel=2e-4)
    for volts in (-10.0, -4.0, 0.0, 6.0):
        seen = body(model, np.full(12_000, volts))[2000:]
        assert seen.mean() == pytest.approx(volts / 10.0, abs=0.03)
        assert (np.abs(seen) > 0.99).mean() > 0.9


def test_each_chamber_has_its_own_pulses_with_two_commands() -> None:
    model = AXIS.with_effects(
        ["second_valve", *PLAIN, "on_off_valves"], {**STILL, "on_off_valves.pulse_frequency": 25.0}
    )
    held = np.tile([5.0, 2.0], (10_000, 1))
    x = model.simulate(held, model.state(), sample_time=1e-4)
    a, b = (x[:, model.states.index(f"body_{side}")].mean() for side in "ab")
    assert (a, b) == pytest.approx((0.5, 0.2), abs=0.03)


def regulators(*names: str, **values: float) -> Model:
    """The axis with pressure regulators."""
    given = {f"pressure_regulator.{key}": value for key, value in values.items()}
    return AXIS.with_effects([*PLAIN, "pressure_regulator", *names], given)


def test_a_regulator_holds_the_pressure_that_the_command_asks_for() -> None:
    """Within its dead band; chamber b is open."""
    model = regulators(pressure_range=5e5, dead_band=2e-3)
    volts = np.repeat([6.0, 2.0, 8.0], 1500)
    x = model.simulate(volts, model.state())
    for end, bar in ((1500, 3.0), (3000, 1.0), (4500, 4.0)):
        assert x[end - 1, 2] == pytest.approx(1e5 + 1e5 * bar, abs=2e-3 * 5e5 + 1e3)
        assert x[end - 1, 3] == pytest.approx(1e5, abs=1e4), "the moving piston pushes its air out"


def test_the_loop_of_a_regulator_is_a_lag_of_second_order() -> None:
    """Its step response, overshoot and all, with a valve that is much faster."""
    omega, zeta = 30.0, 0.4
    model = regulators("second_regulator", angular_frequency=omega, damping_ratio=zeta).with_parameters(
        {"piston.mass": 1e4, "lugre_friction.static_friction": 1e5}
    )
    held = np.tile([5.0, 2.5], (600, 1))
    x = model.simulate(held, model.state())
    t = 1e-3 * np.arange(1, 601)
    root = np.sqrt(1.0 - zeta**2)
    step = 1.0 - np.exp(-zeta * omega * t) * (np.cos(omega * root * t) + zeta / root * np.sin(omega * root * t))
    for state, bar in (("r_a", 3e5), ("r_b", 1.5e5)):
        assert x[:, model.states.index(state)] == pytest.approx(bar * step, abs=2e-3 * bar)
    assert x[-1, 2:4] == pytest.approx([4e5, 2.5e5], abs=3e3)


@pytest.mark.parametrize("names", [("on_off_valves",), ("pressure_regulator", "second_regulator")])
def test_compiled_equals_python_to_the_bit(names: tuple[str, ...]) -> None:
    model = AXIS.with_effects([*PLAIN, *names])
    held = np.column_stack([np.repeat([3.0, -3.0, 10.0], 20)] * len(model.inputs))
    assert model.simulate(held, model.state()).tobytes() == in_python(model).simulate(held, model.state()).tobytes()


def test_what_a_machine_is_made_of_is_no_candidate() -> None:
    parts = {name for name in AXIS.library.names() if AXIS.library.find(name).part}
    assert {"on_off_valves", "pressure_regulator", "second_regulator", "second_valve", "command_delay"} <= parts
    assert not parts.intersection(missing(AXIS, set(SENSORS)))
