"""Models: results of simulate and related methods, and their messages for invalid input."""

import numpy as np
import pytest

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.model import substeps

VOLTAGE = np.repeat([3.0, -2.0, 0.0, 5.0], 25)


@pytest.fixture(scope="module")
def axis() -> Model:
    return load_model("axis")


@pytest.fixture(scope="module")
def start(axis: Model) -> np.ndarray:
    return axis.state(y=0.1, p_a=3e5, p_b=4e5)


def test_rows_are_the_states_at_the_end_of_each_sample(axis: Model, start: np.ndarray) -> None:
    x = axis.simulate(VOLTAGE, start)
    assert x.shape == (100, 5)
    assert x[:1].tobytes() == axis.simulate(VOLTAGE[:1], start).tobytes()
    assert x[60:].tobytes() == axis.simulate(VOLTAGE[60:], x[59]).tobytes()
    assert start.tobytes() == axis.state(y=0.1, p_a=3e5, p_b=4e5).tobytes(), "the given state is left alone"


def test_voltage_acts_in_the_sample_it_is_held_in(axis: Model, start: np.ndarray) -> None:
    quiet, pulse = np.zeros(5), np.array([0.0, 0.0, 5.0, 0.0, 0.0])
    difference = axis.simulate(pulse, start)[:, 2] - axis.simulate(quiet, start)[:, 2]
    assert np.all(difference[:2] == 0.0)
    assert np.all(difference[2:] > 100.0)


def test_samples_and_steps_may_be_divided_otherwise(axis: Model, start: np.ndarray) -> None:
    whole = axis.simulate(VOLTAGE, start, sample_time=1e-3, step=1e-4)
    tenth = axis.simulate(np.repeat(VOLTAGE, 10), start, sample_time=1e-4, step=1e-4)
    assert whole == pytest.approx(tenth[9::10], rel=1e-9, abs=1e-12)
    uneven = axis.simulate(VOLTAGE, start, sample_time=1e-3, step=3e-4)  # in four steps, none longer than asked
    assert uneven.tobytes() == axis.simulate(VOLTAGE, start, sample_time=1e-3, step=2.5e-4).tobytes()
    slow = 1e-3 * (1.0 + 7e-9)  # a clock of 1 kHz takes as many steps as 1 kHz does, a sample a percent longer one more
    assert [substeps(t, 1e-4)[0] for t in (slow, 1e-3, 1.01e-3)] == [10, 10, 11]
    assert [substeps(t, 1e-4)[0] for t in (0.4, 0.40004, 0.40006)] == [4000, 4000, 4001]  # nor does a long one lose any
    assert axis.simulate(VOLTAGE, start, sample_time=slow, step=1e-4) == pytest.approx(whole, rel=1e-5, abs=1e-9)
    held = axis.simulate(VOLTAGE, start, sample_time=2e-3, parts=2)
    assert held == pytest.approx(axis.simulate(VOLTAGE, start)[1::2], rel=1e-9, abs=1e-12)


def test_nothing_to_simulate_gives_nothing(axis: Model, start: np.ndarray) -> None:
    assert axis.simulate([], start).shape == (0, 5)
    assert axis.simulate_lanes([], np.empty((0, 5))).shape == (0, 0, 5)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"voltage": [1.0, np.nan]}, "finite numbers"),
        ({"voltage": [[1.0, 2.0]]}, "one row"),
        ({"state": [0.0, 0.0]}, "must hold 5 finite numbers: y, v, p_a, p_b, z"),
        ({"state": [0.0, np.inf, 1e5, 1e5, 0.0]}, "must hold 5 finite numbers"),
        ({"step": 0.0}, "must be positive"),
        ({"step": np.nan}, "must be positive"),
        ({"sample_time": -1.0}, "must be positive"),
        ({"parts": 3}, "do not fill whole samples"),
        ({"parts": 0}, "do not fill whole samples"),
    ],
)
def test_what_cannot_be_simulated_is_reported(axis: Model, start: np.ndarray, options: dict, sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        axis.simulate(**{"voltage": [1.0, 2.0], "state": start, **options})


def test_a_run_that_leaves_the_numbers_says_when_and_what_to_do(axis: Model) -> None:
    with pytest.raises(
        NumericalError, match=r"axis left the finite numbers at t = 2\.000 s; take a shorter step than 0"
    ):
        axis.simulate(np.full(20, 7.0), axis.state(v=1e200), start=2.0)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"pa": 1e5}, r"unknown state 'pa'; did you mean p_a"),
        ({"v": np.nan}, r"initial v is nan; it takes a finite number"),
        ({"y": 2.0}, r"initial y is 2 m, outside the stroke of -1 to 1 m"),
    ],
)
def test_impossible_states_are_reported(axis: Model, given: dict, sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        axis.state(**given)


def test_states_begin_at_rest_and_at_the_pressure_of_the_atmosphere(axis: Model) -> None:
    alps = axis.with_parameters({"air.atmospheric_pressure": 8e4})
    assert alps.state(z=1e-6).tolist() == [0.0, 0.0, 8e4, 8e4, 1e-6]


def test_chambers_without_volume_are_reported(axis: Model) -> None:
    tight = axis.with_parameters({"chambers.volume_b": 2.9e-4})
    with pytest.raises(UsageError, match=r"chamber b has no volume left.*sweeps 0.0003 m3"):
        tight.state()


def test_models_never_change(axis: Model) -> None:
    before = axis.values
    heavy = axis.with_parameters({"piston.mass": 20.0}, name="heavy")
    assert (heavy["piston.mass"], heavy.name) == (20.0, "heavy")
    assert axis.values.tobytes() == before.tobytes()
    with pytest.raises(TypeError):
        axis.parameters["piston.mass"] = 1.0  # type: ignore[index]  # the test tries this


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"piston.mas": 1.0}, r"unknown parameter 'piston.mas'; did you mean piston.mass"),
        ({"piston.mass": -1.0}, r"piston.mass is -1.0 kg; allowed is 0.001 to 10000"),
        ({"piston.mass": float("nan")}, r"piston.mass is nan kg"),
        ({"piston.mass": "heavy"}, r"piston.mass is 'heavy'; it takes a number"),
        ({"piston.mass": True}, r"piston.mass is True"),
        ({"piston.mass": 1 + 2j}, r"it takes a number"),
    ],
)
def test_bad_parameters_are_reported(axis: Model, change: dict, sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        axis.with_parameters(change)


def test_other_effects_keep_shared_values(axis: Model) -> None:
    tuned = axis.with_parameters({"piston.mass": 7.0, "lugre_friction.static_friction": 90.0})
    fewer = tuned.with_effects(["lugre_friction"])
    assert fewer.effects == ("lugre_friction",)
    assert (fewer["piston.mass"], fewer["lugre_friction.static_friction"]) == (7.0, 90.0)
    more = fewer.with_effects(["lugre_friction", "quadratic_drag"], {"quadratic_drag.coefficient": 10.0})
    assert more["quadratic_drag.coefficient"] == 10.0
    with pytest.raises(UsageError, match=r"unknown effect 'quadratic_drug'; did you mean quadratic_drag"):
        axis.with_effects(["quadratic_drug"])
    with pytest.raises(UsageError, match=r"unknown parameter 'quadratic_drag.coeficient'"):
        fewer["quadratic_drag.coeficient"]


def test_outputs_hold_what_can_be_seen(axis: Model, start: np.ndarray) -> None:
    x = axis.simulate(VOLTAGE, start)
    seen = axis.outputs(x, VOLTAGE)
    assert {"y", "v", "p_a", "p_b", "z", "effort", "friction", "y_measured", "p_a_measured"} <= set(seen)
    assert all(column.shape == (100,) for column in seen.values())
    assert seen["effort"] == pytest.approx(4.1e-4 * x[:, 2] - 3.0e-4 * x[:, 3] - 11.0, rel=1e-12)
    assert seen["p_b_measured"].tobytes() == x[:, 3].tobytes()
    speed = axis.derivatives(x, VOLTAGE)[:, 1]
    assert 5.0 * speed == pytest.approx(seen["effort"] - seen["friction"], rel=1e-9, abs=1e-9)


def test_following_a_run_gives_its_bristle_and_its_derivatives(axis: Model, start: np.ndarray) -> None:
    """Measured states from a simulation: the bristle, which is not measured, follows from them."""
    voltage = np.repeat([3.0, -3.0], 400)
    x = axis.simulate(voltage, start, sample_time=2.5e-4, step=2.5e-5)
    states, slopes = axis.follow(x[:, :4], voltage[1:], x[0, 4:], sample_time=2.5e-4, step=2.5e-5)
    assert states[:, :4].tobytes() == x[:, :4].tobytes()
    assert np.abs(states[:, 4] - x[:, 4]).max() < 2e-8
    change = np.diff(x, axis=0)
    for column, within in ((0, 3e-9), (1, 3e-6), (2, 0.01), (3, 0.01)):  # the slopes are means over each interval
        assert 2.5e-4 * slopes[1:, column] == pytest.approx(change[:, column], abs=within)
    halves = axis.follow(x[:, :4], np.repeat(voltage[1:], 2), x[0, 4:], sample_time=2.5e-4, step=2.5e-5, parts=2)[1]
    assert halves == pytest.approx(slopes, rel=1e-9, abs=1e-9)


def test_following_does_not_let_the_measured_motion_run_on(axis: Model) -> None:
    """A crawl at 1 um/s bends the bristle by the distance moved, independent of the pressure force."""
    t = np.arange(200) * 1e-3
    measured = np.column_stack([1e-6 * t, np.full_like(t, 1e-6), np.full_like(t, 7e5), np.full_like(t, 1e5)])
    states, _ = axis.follow(measured, np.zeros_like(t), [0.0], step=1e-3)
    assert states[:, 4] == pytest.approx(1e-6 * t, rel=1e-9)


@pytest.mark.parametrize(
    "method", ["simulate", "simulate_lanes", "follow", "follow_lanes", "with_parameters", "outputs", "derivatives"]
)
def test_no_misspelt_keyword_is_swallowed(axis: Model, method: str) -> None:
    with pytest.raises(TypeError, match="sampletime"):
        getattr(axis, method)([0.0], axis.state(), sampletime=1.0)


def test_outputs_take_one_voltage_for_all_and_refuse_too_few(axis: Model) -> None:
    """The kernel once read beyond the end of a short array and used other memory as voltages."""
    x = axis.simulate(VOLTAGE, axis.state())
    one, all_of_them = axis.outputs(x, 2.0), axis.outputs(x, np.full(len(x), 2.0))
    assert all(np.array_equal(one[name], all_of_them[name]) for name in one)
    with pytest.raises(UsageError, match="2 rows of inputs do not cover"):
        axis.outputs(x, [1.0, 2.0])
