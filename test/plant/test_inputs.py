"""Held inputs beside the drive: measured pressures, where the machine has no chambers and an effect reads them."""

from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant import Library, Model, Stepper, load_model
from pneumo_ros.plant.sensing import sense

AXIS = load_model("axis")
ROD = ("lugre_friction", "quadratic_drag")  # mechanics alone, driven by a force
INPUTS = ("U", "p_a", "p_b")
COEFFICIENT = "pressure_dependent_friction.coefficient"
SAMPLES = 200


def rod(*effects: str, frame: tuple[str, ...] = ("piston",), library: Library | None = None, **values: float) -> Model:
    """A force-driven machine with further effects."""
    own = {name: value for name, value in AXIS.parameters.items() if name.partition(".")[0] in (*ROD, *frame)}
    given = {**own, **{name.replace("__", "."): value for name, value in values.items()}}
    return Model.build([*ROD, *effects], given, frame=frame, library=library, defaults=True)


@pytest.fixture(scope="module")
def sealed() -> Model:
    """Friction that grows with the pressures, and a sensor that is late: k = 3."""
    return rod("pressure_dependent_friction", "position_sensor_delay")


@pytest.fixture(scope="module")
def held() -> np.ndarray:
    """Force and both pressures (samples, 3): it slides, sticks and reverses."""
    random = np.random.default_rng(3)
    force = np.repeat([150.0, -180.0, 20.0, 220.0, -60.0], SAMPLES // 5) + random.normal(0.0, 5.0, SAMPLES)
    return np.column_stack([force, random.uniform(2e5, 6e5, SAMPLES), random.uniform(1e5, 5e5, SAMPLES)])


def sliding_force(speed: float, model: Model, p_a: float, p_b: float) -> float:
    """Friction force [N] after 0.3 s of sliding at `speed` [m/s] under these pressures [Pa]."""
    n = 300
    motion = np.column_stack([np.linspace(0.0, speed * (n - 1) * 1e-3, n), np.full(n, speed)])
    inputs = np.tile([0.0, p_a, p_b], (n, 1))
    states, _ = model.follow(motion, inputs[:-1], model.state()[2:])
    return float(model.outputs(states, inputs)["friction"][-1])


def test_the_inputs_are_what_effects_read_and_no_state_of_the_machine_is() -> None:
    assert rod().inputs == AXIS.inputs == ("U",)
    assert AXIS.with_effects([*AXIS.effects, "pressure_dependent_friction"]).inputs == ("U",)
    assert rod("pressure_dependent_friction").inputs == INPUTS


def test_measured_pressures_raise_friction_by_the_law() -> None:
    model = rod("pressure_dependent_friction", frame=("piston", "air"), pressure_dependent_friction__coefficient=1e-4)
    rise = sliding_force(0.2, model, 6e5, 2e5) - sliding_force(0.2, model, 1e5, 1e5)
    assert rise == pytest.approx(1e-4 * (0.5 * (6e5 + 2e5) - model["air.atmospheric_pressure"]), rel=1e-3)


def test_without_the_section_air_the_atmosphere_is_the_standard_one() -> None:
    model = rod("pressure_dependent_friction", pressure_dependent_friction__coefficient=1e-4)
    rise = sliding_force(0.2, model, 6e5, 2e5) - sliding_force(0.2, model, 1e5, 1e5)
    assert rise == pytest.approx(1e-4 * (0.5 * (6e5 + 2e5) - 101325.0), rel=1e-3)
    assert not any(name.startswith("air.") for name in model.parameters)


@pytest.mark.parametrize("lanes", [1, 16, 21])
@pytest.mark.parametrize("model", [rod("position_sensor_delay"), "sealed"], ids=["one input", "three inputs"])
def test_lanes_equal_single_runs_to_the_bit(
    request: pytest.FixtureRequest, model: Model | str, lanes: int, held: np.ndarray
) -> None:
    """Simulated, driven along a motion, and read by sensors, each lane with parameters of its own."""
    model = request.getfixturevalue(model) if isinstance(model, str) else model
    inputs, random = held[:, : len(model.inputs)], np.random.default_rng(lanes)
    parameters = np.tile(model.values, (lanes, 1)) * random.uniform(0.9, 1.1, (lanes, len(model.values)))
    models = [model.with_parameters(dict(zip(model.parameters, row, strict=True))) for row in parameters]
    states = np.tile(model.state(), (lanes, 1))
    states[:, 0] = random.uniform(-0.5, 0.5, lanes)
    first = random.integers(0, 5, lanes) * 4
    out = model.simulate_lanes(inputs, states, parameters, first=first, samples=40, parts=4)
    read = sense(model, out, parameters, inputs, first, parts=4)
    motion = out[0][:, :2]
    followed, rates = model.follow_lanes(motion, inputs[: 4 * 39], model.state()[2:], parameters, parts=4)
    for lane, (own, begin) in enumerate(zip(models, first, strict=True)):
        part = inputs[begin : begin + 160]
        alone = own.simulate(part, states[lane], parts=4, start=begin * 0.25e-3)
        assert out[lane].tobytes() == alone.tobytes()
        seen = own.outputs(alone, part[3::4], start=begin * 0.25e-3)
        assert read[lane, :, 0].tobytes() == np.ascontiguousarray(seen["y_measured"]).tobytes()
        x, mean = own.follow(motion, inputs[: 4 * 39], own.state()[2:], parts=4)
        assert followed[lane].tobytes() == x.tobytes()
        assert rates[lane].tobytes() == mean.tobytes()


def test_every_input_matters_at_every_sample(sealed: Model, held: np.ndarray) -> None:
    """A column or a row mixed up would not show in lanes that are wrong like the single run."""
    model = sealed.with_parameters({COEFFICIENT: 1e-5})
    before = model.simulate(held, model.state(v=0.2))
    for column, size in ((0, 1.0), (1, 1e4), (2, 1e4)):
        changed = held.copy()
        changed[20, column] += size
        after = model.simulate(changed, model.state(v=0.2))
        assert np.array_equal(after[:20], before[:20])
        assert not np.array_equal(after[20], before[20])
    swapped = model.simulate(held[:, [0, 2, 1]], model.state(v=0.2))
    assert swapped == pytest.approx(before, rel=1e-9, abs=1e-12), "the law has the mean of both"


def test_derivatives_and_outputs_see_the_pressures(sealed: Model) -> None:
    model = sealed.with_parameters({COEFFICIENT: 1e-4})
    low, high = ([[0.0, p, p]] for p in (1e5, 5e5))
    state = model.state(v=0.2)[None]
    assert model.outputs(state, high)["friction_level"] - model.outputs(state, low)["friction_level"] == pytest.approx(
        1e-4 * (5e5 - 101325.0)
    )
    bent = model.state(v=0.2, z=6e-5)[None]
    there = model.states.index("z")
    assert model.derivatives(bent, high)[0, there] > model.derivatives(bent, low)[0, there], "more friction yields less"


def test_one_input_may_be_a_row_or_a_column() -> None:
    model, force = rod(), np.linspace(-200.0, 200.0, 50)
    assert model.simulate(force, model.state()).tobytes() == model.simulate(force[:, None], model.state()).tobytes()
    assert model.outputs(np.tile(model.state(), (3, 1)))["drive"].tolist() == [0.0] * 3


@pytest.mark.parametrize("given", [np.zeros(9), np.zeros((9, 2)), np.zeros((3, 3, 3)), [[0.0, np.nan, 1e5]] * 9])
def test_inputs_that_do_not_fit_are_reported(sealed: Model, given: np.ndarray) -> None:
    with pytest.raises(UsageError, match=r"row of 3 numbers for every sample: U, p_a, p_b"):
        sealed.simulate(given, sealed.state())


def test_a_stepper_takes_them_beside_the_drive(sealed: Model, held: np.ndarray) -> None:
    stepper = Stepper(sealed, sealed.state())
    expected = sealed.simulate(held[:20], sealed.state())
    assert np.array([stepper.advance(*row).copy() for row in held[:20]]).tobytes() == expected.tobytes()
    with pytest.raises(UsageError, match="finite numbers are needed"):
        stepper.advance(1.0)
    with pytest.raises(UsageError, match="finite numbers are needed"):
        stepper.advance(1.0, np.inf, 1e5)
    with pytest.raises(UsageError, match=r"inputs of shape \(10,\) do not fit 10 steps of \('U', 'p_a', 'p_b'\)"):
        stepper.advance_in_parts(np.zeros(stepper.parts))
    stepper.advance_in_parts(np.repeat(held[20:21], stepper.parts, axis=0))
    assert stepper.state == pytest.approx(sealed.simulate(held[:21], sealed.state())[-1], rel=1e-9, abs=1e-12)
    with pytest.raises(NumericalError):
        stepper.advance(1e300, 1e5, 1e5)


@pytest.mark.parametrize(
    ("effect", "why"),
    [
        ("cross_piston_leakage", "it reads p_a"), ("leakage_to_atmosphere", "it reads p_a"),
        ("line_delay", "it reads p_a"), ("heat_exchange", "it reads p_a"), ("dead_volume", "it reads volume_a"),
        ("pressure_sensor_offset", "it acts on them alone"), ("valve_null_offset", "it acts on them alone"),
    ],
)  # fmt: skip
def test_what_acts_on_chambers_alone_is_refused_without_them(effect: str, why: str) -> None:
    with pytest.raises(UsageError, match=rf"{effect} needs section 'chambers' \({why}\); add section 'chambers' with"):
        rod(effect)
    assert effect in AXIS.with_effects([*AXIS.effects, effect]).effects


OWN = '''
from pneumo_ros.plant.effect import Effect, Parameter


class RodSeal(Effect):
    """The rod's seal, pressed on by chamber b alone."""

    coefficient = Parameter(1e-4, "N/Pa", "rise of friction with the pressure in chamber {side}", low=0.0, neutral=0.0)

    def equations(p_{side}, p_atm, coefficient):
        friction_rise = coefficient * max(p_{side} - p_atm, 0.0)
        return friction_rise
'''


@pytest.mark.parametrize("side", ["a", "b"])
def test_an_effect_of_ones_own_reads_one_pressure(tmp_path: Path, side: str) -> None:
    (tmp_path / "own.py").write_text(OWN.format(side=side))
    model = rod("rod_seal", library=Library([tmp_path / "own.py"]))
    assert model.inputs == ("U", f"p_{side}")
    model.simulate(np.tile([150.0, 4e5], (10, 1)), model.state())


@pytest.mark.parametrize("name", ["p_a", "U"])
def test_an_input_cannot_be_written(tmp_path: Path, name: str) -> None:
    text = OWN.format(side="b").replace("friction_rise", name)
    (tmp_path / "own.py").write_text(text)
    with pytest.raises(UsageError, match=f"returns {name}, which is an input and cannot be written"):
        rod("rod_seal", library=Library([tmp_path / "own.py"]))
