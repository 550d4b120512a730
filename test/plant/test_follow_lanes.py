"""Many lanes of parameters along a measured motion: each equal to the bit to a run alone."""

from functools import cache

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model

HOW = {"sample_time": 2e-3, "step": 4e-4, "parts": 2}
VOLTAGE = np.repeat([4.0, -3.0, 0.0, 6.0, -8.0], 60)
MACHINES = {
    "axis": AXIS,
    "velocities of its own": AXIS.with_effects([*AXIS.effects, "load_compliance", "valve_spool_dynamics"]),
    "memory": AXIS.with_effects([*AXIS.effects, "dwell_time_breakaway", "valve_hysteresis", "line_delay"]),
    "no states of its own": AXIS.with_effects([name for name in AXIS.effects if name != "lugre_friction"]),
}


@cache
def motion() -> np.ndarray:
    """Frame's states (151, 4) of a machine that slides, sticks and reverses, from the one before the first voltage."""
    start = AXIS.state(y=-0.4, p_a=3e5, p_b=4e5)
    return np.vstack([start, AXIS.simulate(VOLTAGE, start, **HOW)])[:, :4]


def varied(model: Model, lanes: int) -> list[Model]:
    """A model for each lane, with different parameters in each."""
    scales = np.random.default_rng(lanes).uniform(0.98, 1.0, (lanes, len(model.parameters)))
    rows = [dict(zip(model.parameters, (model.values * row).tolist(), strict=True)) for row in scales]
    return [Model(model.composition, row, model.name, model.library) for row in rows]


def values(models: list[Model]) -> np.ndarray:
    """Parameters (lanes, parameters) of these models."""
    return np.array([model.values for model in models])


def assert_alone(found: tuple[np.ndarray, np.ndarray], lane: int, alone: tuple[np.ndarray, np.ndarray]) -> None:
    for many, one in zip(found, alone, strict=True):
        assert many[lane].tobytes() == one.tobytes()


@pytest.mark.parametrize("lanes", [1, 3, 16, 17, 18, 40])
@pytest.mark.parametrize("machine", MACHINES)
def test_lanes_equal_single_runs_to_the_bit(machine: str, lanes: int) -> None:
    model = MACHINES[machine]
    models, rest = varied(model, lanes), model.state()[4:]
    found = model.follow_lanes(motion(), VOLTAGE, rest, values(models), **HOW)
    assert found[0].shape == found[1].shape == (lanes, 151, len(model.states))
    for lane, single in enumerate(models):
        assert_alone(found, lane, single.follow(motion(), VOLTAGE, rest, **HOW))
    if lanes > 1:
        assert np.ptp(found[1][:, 20, 1]) > 0.0, "the lanes do differ"


def test_lanes_may_have_measurements_and_beginnings_of_their_own() -> None:
    """Corrections of sensors differ by lane, and where a bristle begins."""
    model, random = MACHINES["memory"], np.random.default_rng(3)
    models = varied(model, 18)
    measured = motion() * random.uniform(0.99, 1.01, (18, 1, 4))
    rest = model.state()[4:] + random.uniform(0.0, 1e-5, (18, len(model.states) - 4))
    found = model.follow_lanes(measured, VOLTAGE, rest, values(models), **HOW)
    for lane, single in enumerate(models):
        assert_alone(found, lane, single.follow(measured[lane], VOLTAGE, rest[lane], **HOW))


def test_a_force_driven_machine_follows_too() -> None:
    model = Model.build(["lugre_friction"], {}, frame=("piston",), defaults=True)
    models, force = varied(model, 3), 20.0 * VOLTAGE
    assert model.force_driven
    found = model.follow_lanes(motion()[:, :2], force, [0.0], values(models), **HOW)
    for lane, single in enumerate(models):
        assert_alone(found, lane, single.follow(motion()[:, :2], force, [0.0], **HOW))


def test_plain_python_follows_to_the_same_bits() -> None:
    model = MACHINES["memory"]
    given = (motion()[:12], VOLTAGE[:22], model.state()[4:], values(varied(model, 3)))
    compiled, plain = (m.follow_lanes(*given, **HOW) for m in (model, in_python(model)))
    for lane in range(3):
        assert_alone(compiled, lane, (plain[0][lane], plain[1][lane]))


def test_effects_that_a_block_lacks_are_passed_over() -> None:
    """Signals that they would change stand as without them; their own states stay where they begin."""
    effects = ("friction_lag", "line_delay", "valve_hysteresis", "spring_load")
    neutral = {"friction_lag.time_constant": 0.0, "line_delay.delay": 0.0, "valve_hysteresis.half_width": 0.0}
    model = AXIS.with_effects([*AXIS.effects, *effects], neutral | {"spring_load.stiffness": 0.0})
    loaded = model.with_parameters({"friction_lag.time_constant": 5e-3, "spring_load.stiffness": 100.0})
    given = (motion(), VOLTAGE, model.state()[4:])
    for lanes, moving in (([model], {"z"}), ([model, loaded], {"z", "v_f"})):
        passed = model.follow_lanes(*given, values(lanes), **HOW, columns=("v", "p_a", "p_b"), passing=True)
        usual = model.follow_lanes(*given, values(lanes), **HOW, columns=("v", "p_a", "p_b"))
        np.testing.assert_allclose(passed[1], usual[1], rtol=1e-9, atol=1e-9 * np.abs(usual[1]).max())
        moved = {name for k, name in enumerate(model.states[4:], 4) if np.ptp(passed[0][:, :, k]) > 0.0}
        assert moved == moving
        assert np.ptp(usual[0][:, :, model.states.index("line_a_1")]) > 0.0, "it moves where it is not passed over"
    assert np.abs(passed[1][1] - passed[1][0]).max() > 1.0, "the spring acts"


def test_only_what_is_asked_for_is_returned_in_that_order() -> None:
    given = (motion(), VOLTAGE, [0.0], values(varied(AXIS, 5)))
    states, slopes = AXIS.follow_lanes(*given, **HOW)
    some, columns = AXIS.follow_lanes(*given, **HOW, states=["z", "y"], columns=("p_b", "v"))
    assert some.tobytes() == states[:, :, [4, 0]].tobytes()
    assert columns.tobytes() == slopes[:, :, [3, 1]].tobytes()
    assert AXIS.follow_lanes(*given, **HOW, states=())[0].shape == (5, 151, 0)


@pytest.mark.parametrize("threads", [2, 3, 64])
def test_threads_change_nothing(threads: int) -> None:
    measured = motion() * np.random.default_rng(0).uniform(0.99, 1.01, (40, 1, 4))
    given = (measured, VOLTAGE, [0.0], values(varied(AXIS, 40)))
    one, many = (AXIS.follow_lanes(*given, **HOW, threads=count) for count in (1, threads))
    assert (one[0].tobytes(), one[1].tobytes()) == (many[0].tobytes(), many[1].tobytes())


def test_a_lane_that_leaves_the_numbers_leaves_the_others_alone() -> None:
    models = varied(AXIS, 5)
    q = values(models)
    q[2, list(AXIS.parameters).index("lugre_friction.bristle_stiffness")] = np.nan
    found = AXIS.follow_lanes(motion(), VOLTAGE, [0.0], q, **HOW)
    assert not np.isfinite(found[0][2]).all()
    assert_alone(found, 3, models[3].follow(motion(), VOLTAGE, [0.0], **HOW))


def test_arguments_are_left_as_they_are_and_may_be_read_only() -> None:
    q = values(varied(AXIS, 2))
    given = [motion().copy(), VOLTAGE.copy(), np.zeros(1), q.copy()]
    for array in given:
        array.setflags(write=False)
    found = AXIS.follow_lanes(*given, **HOW)
    assert_alone(found, 1, tuple(part[1] for part in AXIS.follow_lanes(motion(), VOLTAGE, [0.0], q, **HOW)))
    assert len(AXIS.kernel.follow_lanes.signatures) == 1, "nothing has been compiled again for them"


def test_shared_and_own_beginnings_need_one_compilation() -> None:
    model = MACHINES["velocities of its own"]
    q, rest = values(varied(model, 3)), model.state()[4:]
    for given in (rest, np.tile(rest, (3, 1))):
        model.follow_lanes(motion(), VOLTAGE, given, q, **HOW)
    assert len(model.kernel.follow_lanes.signatures) == 1


def test_one_sample_and_no_lanes_are_allowed() -> None:
    states, slopes = AXIS.follow_lanes(motion()[:1], [], [1e-6], values(varied(AXIS, 2)))
    assert states.tolist() == [[[*motion()[0], 1e-6]]] * 2
    assert not slopes.any()
    assert AXIS.follow_lanes(motion(), VOLTAGE, [0.0], np.empty((0, len(AXIS.parameters))), **HOW)[1].shape[0] == 0


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"measured": np.zeros((151, 5))}, r"lanes do not fit: measured \(151, 5\)"),
        ({"measured": np.zeros((3, 151, 4))}, r"measured \(3, 151, 4\)"),
        ({"measured": np.zeros(4)}, r"measured \(4,\)"),
        ({"measured": np.zeros((0, 4))}, r"measured \(0, 4\)"),
        ({"rest": [0.0, 0.0]}, r"rest \(2,\)"),
        ({"rest": [[0.0]]}, r"rest \(1, 1\)"),
        ({"parameters": np.zeros((2, 3))}, r"parameters \(2, 3\)"),
        ({"parameters": AXIS.values}, r"parameters \(\d+,\)"),
        ({"voltage": np.zeros(298)}, r"298 voltages do not cover 151 samples"),
        ({"voltage": np.zeros(301)}, r"301 voltages do not fill whole samples of 2"),
        ({"columns": ["p_c"]}, r"unknown state 'p_c'"),
        ({"states": ["zz"]}, r"unknown state 'zz'"),
        ({"step": 0.0}, r"must be positive"),
    ],
)
def test_lanes_that_do_not_fit_are_reported(change: dict, sentence: str) -> None:
    given = {"measured": motion(), "voltage": VOLTAGE, "rest": [0.0], "parameters": np.tile(AXIS.values, (2, 1))}
    with pytest.raises(UsageError, match=sentence):
        AXIS.follow_lanes(**{**given, **HOW, **change})
