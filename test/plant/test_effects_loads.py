"""Effects of loads and of the position sensor against values that theory gives."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python, lone_machine, machine
from plant.driven import along

from pneumo_ros.plant import Library, Model
from pneumo_ros.shooting.refit import default_free

OFFSET, STIFFNESS = 0.2, 250.0


def seen(name: str, signal: str, values: dict[str, float], **state: float) -> float:
    """A signal of the axis with the effect at one instant."""
    model = in_python(machine(name).with_parameters({f"{name}.{key}": value for key, value in values.items()}))
    return float(model.outputs(model.state(**state), 0.0)[signal][0])


def test_constant_load_pulls_back_at_rest_and_both_ways() -> None:
    rod = 1e5 * (4.1e-4 - 3.0e-4)
    forces = [seen("constant_load", "force", {"load": 35.0}, v=v) - rod for v in (-0.5, 0.0, 0.5)]
    assert forces == pytest.approx([35.0] * 3, rel=1e-12)


def test_spring_load_is_hookes() -> None:
    given = {"stiffness": STIFFNESS, "rest_position": OFFSET}
    forces = [seen("spring_load", "force", given, y=y) - 11.0 for y in (-0.4, OFFSET, 0.9)]
    assert forces == pytest.approx([-0.6 * STIFFNESS, 0.0, 0.7 * STIFFNESS], rel=1e-9, abs=1e-9)


def test_a_hardening_spring_is_duffings() -> None:
    given = {"stiffness": STIFFNESS, "rest_position": OFFSET, "hardening": 2.0}
    forces = [seen("spring_load", "force", given, y=y) - 11.0 for y in (-0.4, OFFSET, 0.9)]
    assert forces == pytest.approx([-0.6 * STIFFNESS * 1.72, 0.0, 0.7 * STIFFNESS * 1.98], rel=1e-9, abs=1e-9)


def test_a_progressive_spring_grows_stiffer_by_the_metre_both_ways() -> None:
    given = {"stiffness": STIFFNESS, "rest_position": OFFSET, "progression": 2.0}
    forces = [seen("spring_load", "force", given, y=y) - 11.0 for y in (-0.4, OFFSET, 0.9)]
    assert forces == pytest.approx([-0.6 * STIFFNESS * 2.2, 0.0, 0.7 * STIFFNESS * 2.4], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("hardening", "stiffer"), [(100.0, 10.0), (-100.0, 0.5)])
def test_no_spring_changes_more_than_tenfold(hardening: float, stiffer: float) -> None:
    given = {"stiffness": STIFFNESS, "rest_position": OFFSET, "hardening": hardening}
    assert seen("spring_load", "force", given, y=0.9) - 11.0 == pytest.approx(0.7 * STIFFNESS * stiffer, rel=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_end_stop_resists_more_on_the_way_in_than_out_and_never_pulls(side: float) -> None:
    """F = k x (1 + d x') at either end, x and x' counted into the stop."""
    model, rod = in_python(AXIS), 1e5 * (4.1e-4 - 3.0e-4)
    k, d, x = model["end_stop.stiffness"], model["end_stop.damping"], 1e-4
    for inwards in (0.1, 0.0, -0.1, -10.0):
        state = model.state(y=side * (0.5 * model["piston.stroke"] + x), v=side * inwards)
        force = float(model.outputs(state, 0.0)["force"][0]) - rod
        assert force == pytest.approx(side * k * x * max(1.0 + d * inwards, 0.0), rel=1e-6, abs=1e-9)


def test_payload_is_felt_in_acceleration_alone() -> None:
    def rates(model: Model) -> np.ndarray:
        plain = in_python(model)
        return np.asarray(plain.derivatives(plain.state(p_a=4e5, p_b=2e5), 3.0)[0])

    loaded, bare = rates(machine("payload_mass").with_parameters({"payload_mass.mass_added": 7.0})), rates(AXIS)
    assert loaded[1] == pytest.approx(bare[1] * 5.0 / 12.0, rel=1e-12)
    assert np.delete(loaded, 1).tobytes() == np.delete(bare, 1).tobytes()


def test_held_rod_lets_the_load_swing_at_its_frequency_and_decay() -> None:
    """x = x_0 exp(-zeta omega t) (cos omega_d t + ...), omega_d = omega sqrt(1 - zeta^2): peaks one period apart."""
    values = {"load_compliance.frequency": 20.0, "load_compliance.damping_ratio": 0.05}
    x, _ = along(lone_machine("load_compliance").with_parameters(values), np.zeros(5001), 0.0, 1e-4, stretch=1e-3)
    stretch, omega = x[:, 4], 2.0 * np.pi * 20.0
    peaks = np.flatnonzero((stretch[1:-1] > stretch[:-2]) & (stretch[1:-1] >= stretch[2:])) + 1
    assert np.diff(peaks).mean() * 1e-4 == pytest.approx(1.0 / (20.0 * np.sqrt(1.0 - 0.05**2)), rel=2e-3)
    assert stretch[peaks[3]] == pytest.approx(1e-3 * np.exp(-0.05 * omega * peaks[3] * 1e-4), rel=1e-2)


def test_free_masses_swing_faster_and_keep_their_momentum() -> None:
    """Without friction and gas: frequency f / sqrt(1 - share) about the common centre of mass, undamped for long."""
    values = {
        "load_compliance.load_share": 0.4,
        "load_compliance.frequency": 20.0,
        "load_compliance.damping_ratio": 0.0,
    }
    model = in_python(Model.build(["load_compliance"], values, library=Library(), frame=("piston",), defaults=True))
    x = model.simulate(np.zeros(3000), model.state(stretch=1e-3), sample_time=1e-4)
    momentum = 0.6 * x[:, 1] + 0.4 * x[:, 3]
    assert np.abs(momentum).max() < 1e-6 * np.abs(x[:, 1]).max()
    crossings = np.flatnonzero(np.diff(np.sign(x[:, 2])) != 0)
    assert np.diff(crossings).mean() * 2e-4 == pytest.approx(np.sqrt(0.6) / 20.0, rel=2e-3)
    assert np.abs(x[-500:, 2]).max() == pytest.approx(1e-3, rel=2e-3)


def test_load_begins_with_the_velocity_of_its_piston() -> None:
    model = machine("load_compliance")
    assert model.state(v=0.4)[model.states.index("v_l")] == 0.4
    assert model.state(v=0.4, v_l=0.1)[model.states.index("v_l")] == 0.1
    moving = AXIS.state(v=0.3, p_a=4e5)
    assert model.continued(AXIS, moving)[model.states.index("v_l")] == 0.3


def measured(name: str, values: dict[str, float], y: np.ndarray, v: np.ndarray, sample: float) -> np.ndarray:
    """Reading of the position sensor along a motion."""
    model = machine(name).with_parameters({f"{name}.{key}": value for key, value in values.items()})
    return np.asarray(along(model, y, v, sample)[1]["y_measured"])


def test_backlash_waits_for_half_the_play_and_at_reversals_for_all_of_it() -> None:
    gap, t = 4e-4, 1e-3 * np.arange(4001)
    y, v = 1e-3 * np.sin(np.pi * t), 1e-3 * np.pi * np.cos(np.pi * t)
    shown = measured("backlash", {"gap": gap}, y, v, 1e-3)
    waiting = y < 0.5 * gap
    assert np.abs(shown[: np.flatnonzero(~waiting)[0]]).max() < 1e-7
    rising = slice(150, 500)
    assert shown[rising] == pytest.approx(y[rising] - 0.5 * gap, abs=1e-7)
    after = (t > 0.5) & (t < 1.0) & (y > 1e-3 - gap + 1e-6)
    assert shown[after] == pytest.approx(np.full(after.sum(), 1e-3 - 0.5 * gap), abs=1e-7)
    falling = slice(900, 1500)
    assert shown[falling] == pytest.approx(y[falling] + 0.5 * gap, abs=1e-7)


def test_load_flies_through_its_play_and_takes_the_piston_along() -> None:
    """Without friction and gas: v_l is constant until the face, the momentum always; no face lets the load rebound."""
    share, gap, speed = 0.4, 1e-3, 0.1
    values = {"backlash.gap": 0.0, "backlash.load_share": share, "backlash.load_gap": gap}
    model = in_python(Model.build(["backlash"], values, library=Library(), frame=("piston",), defaults=True))
    x = model.simulate(np.zeros(2000), model.state(v_loose=speed), sample_time=1e-4)
    v, ahead, loose = (x[:, model.states.index(name)] for name in ("v", "ahead", "v_loose"))
    assert (1.0 - share) * v + share * loose == pytest.approx(np.full(len(x), share * speed), rel=1e-3)
    flight = int(np.argmax(ahead > 0.4 * gap))
    assert loose[:flight] == pytest.approx(np.full(flight, speed), rel=0.05)
    assert flight * 1e-4 * speed == pytest.approx(0.4 * gap, rel=0.05)
    assert ahead.max() < gap
    assert np.abs(loose - v)[-100:].max() < 0.15 * speed


def test_a_fit_of_one_form_of_a_play_leaves_the_other_alone() -> None:
    """Neither a load that hangs on nothing, nor the width of a play that no load has."""

    def free(**values: float) -> set[str]:
        model = machine("backlash").with_parameters({f"backlash.{key}": value for key, value in values.items()})
        return {name.partition(".")[2] for name in default_free(model) if name.startswith("backlash.")}

    assert free(gap=2e-4) == {"gap"}
    assert free(gap=0.0, load_share=0.3) == {"load_share", "load_gap"}
    assert free(gap=2e-4, load_share=0.3) == {"gap", "load_share", "load_gap"}
    assert free(gap=0.0) == {"gap", "load_share"}


@pytest.mark.parametrize("delay", [5e-4, 2e-3, 5e-3, 2e-2])
def test_delayed_position_is_the_position_of_then(delay: float) -> None:
    """To what the approximation allows: a few parts in 10^4 of the lag for motions of an axis."""
    t = 1e-3 * np.arange(3001)
    wave = 2.0 * np.pi * 1.5
    y, v = 0.05 * (1.0 - np.cos(wave * t)), 0.05 * wave * np.sin(wave * t)
    shown = measured("position_sensor_delay", {"delay": delay}, y, v, 1e-3)
    then = 0.05 * (1.0 - np.cos(wave * (t - delay)))
    largest = 0.05 * wave * delay
    assert np.abs(shown - then)[200:].max() < max(5e-4, 2e-3 * 1e-3 / delay) * largest + 3e-6


@pytest.mark.parametrize("delay", [0.0, 5e-3])
@pytest.mark.parametrize("low_pass", [1e-3, 2e-3, 1.5e-2])
def test_a_low_pass_smooths_the_position_of_then(low_pass: float, delay: float) -> None:
    """As the exact response of a delay and a lag of first order to a sine."""
    t = 1e-3 * np.arange(3001)
    wave = 2.0 * np.pi * 1.5
    y, v = 0.05 * (1.0 - np.cos(wave * t)), 0.05 * wave * np.sin(wave * t)
    shown = measured("position_sensor_delay", {"delay": delay, "low_pass": low_pass}, y, v, 1e-3)
    then = 0.05 * (1.0 - (np.exp(1j * wave * (t - delay)) / (1.0 + 1j * wave * low_pass)).real)
    assert np.abs(shown - then)[300:].max() < 5e-3 * 0.05 * wave * (low_pass + delay) + 3e-6


def test_sensors_of_pressure_err_by_offset_and_gain() -> None:
    offset = {"offset_a": 7e3, "offset_b": -4e3}
    assert seen("pressure_sensor_offset", "p_a_measured", offset, p_a=3e5) == pytest.approx(3.07e5, rel=1e-12)
    assert seen("pressure_sensor_offset", "p_b_measured", offset, p_b=3e5) == pytest.approx(2.96e5, rel=1e-12)
    gain = {"error_a": 0.02, "error_b": -0.01}
    assert seen("pressure_sensor_gain", "p_a_measured", gain, p_a=3e5) == pytest.approx(3.06e5, rel=1e-12)
    assert seen("pressure_sensor_gain", "p_b_measured", gain, p_b=3e5) == pytest.approx(2.97e5, rel=1e-12)


def test_errors_of_sensors_do_not_move_the_machine() -> None:
    names = ["backlash", "position_sensor_delay", "pressure_sensor_gain", "pressure_sensor_offset"]
    model = in_python(AXIS.with_effects([*AXIS.effects, *names]))
    given, voltage = {"p_a": 3e5, "p_b": 4e5}, np.repeat([4.0, -3.0], 20)
    wrong, right = model.simulate(voltage, model.state(**given)), AXIS.simulate(voltage, AXIS.state(**given))
    assert wrong[:, : len(AXIS.states)].tobytes() == right.tobytes()
