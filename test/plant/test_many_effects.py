"""All effects of the catalogue in one kernel: it compiles, neutral effects vanish, lanes advance side by side."""

import re

import numpy as np
import pytest
from plant.catalogue import AXIS, CATALOGUE, driven_in_one_kernel, everything, in_python, neutral_values
from plant.checks import own_values

from pneumo_ros.plant import Model
from pneumo_ros.plant.reach import fades

VOLTAGE = np.repeat([4.0, -3.0, 0.0, 6.0, -8.0, 1.2], 60)


def starts(count: int) -> np.ndarray:
    """States at different places."""
    return np.array([everything().state(y=y, p_a=3e5, p_b=4e5) for y in np.linspace(-0.95, 0.95, count)])


def test_all_effects_go_together() -> None:
    x = everything().simulate(VOLTAGE, starts(1)[0])
    assert np.isfinite(x).all()
    assert x[:10].tobytes() == in_python(everything()).simulate(VOLTAGE[:10], starts(1)[0]).tobytes()
    assert np.abs(x[:, 0] - AXIS.simulate(VOLTAGE, AXIS.state(y=-0.95, p_a=3e5, p_b=4e5))[:, 0]).max() > 1e-3


def test_all_at_their_neutral_values_are_the_axis() -> None:
    """One kernel serves all models: effects that a machine lacks are switched off in it."""
    neutral = {key: value for e in CATALOGUE if e.name not in AXIS.effects for key, value in neutral_values(e).items()}
    model = everything()
    x = model.with_parameters(neutral).simulate(VOLTAGE, starts(1)[0])
    axis = AXIS.simulate(VOLTAGE, AXIS.state(y=-0.95, p_a=3e5, p_b=4e5))
    assert x[:, [model.states.index(name) for name in AXIS.states]] == pytest.approx(axis, rel=1e-9)


def test_effects_may_be_listed_in_any_order() -> None:
    """If no effect overwrites another's signal, the order of effects decides only the order of states."""
    names = ["valve_spool_dynamics", "heat_exchange", "viscous_friction", "load_compliance", "supply_pressure_droop"]
    one, other = (in_python(AXIS.with_effects([*AXIS.effects, *given])) for given in (names, names[::-1]))
    x, z = (model.simulate(VOLTAGE[::10], model.state(p_a=3e5, p_b=4e5)) for model in (one, other))
    for name in one.states:
        assert x[:, one.states.index(name)] == pytest.approx(z[:, other.states.index(name)], rel=1e-9, abs=1e-15)


def mild_variants(count: int) -> list[Model]:
    """The axis with every effect, parameters drawn and then brought close to their defaults."""
    model, random = everything(), np.random.default_rng(5)
    lanes = []
    for _ in range(count):
        drawn = {k: v for e in CATALOGUE if e.name not in AXIS.effects for k, v in own_values(e, random).items()}
        lanes.append(model.with_parameters({key: model[key] + 0.02 * (v - model[key]) for key, v in drawn.items()}))
    return lanes


def test_lanes_of_all_effects_equal_single_runs_to_the_bit() -> None:
    """Each lane with parameters of its own."""
    model, states, lanes = everything(), starts(20), mild_variants(20)
    out = model.simulate_lanes(VOLTAGE, states, np.array([lane.values for lane in lanes]))
    for lane, state, run in zip(lanes, states, out, strict=True):
        assert run.tobytes() == lane.simulate(VOLTAGE, state).tobytes()


@pytest.mark.check
def test_lanes_of_all_effects_follow_a_motion_as_each_would_alone() -> None:
    """To the bit, along a measured motion that these effects would not produce themselves."""
    model, lanes = everything(), mild_variants(20)
    measured = AXIS.simulate(VOLTAGE, AXIS.state(y=-0.5, p_a=3e5, p_b=4e5), parts=2)[:, :4]
    rest, q = starts(1)[0, 4:], np.array([lane.values for lane in lanes])
    states, slopes = model.follow_lanes(measured, VOLTAGE, rest, q, step=5e-4, parts=2)
    assert np.ptp(slopes[:, 100, 1:4], axis=0).all(), "lanes differ in acceleration and in both chambers"
    for i, lane in enumerate(lanes):
        alone = lane.follow(measured, VOLTAGE, rest, step=5e-4, parts=2)
        assert (states[i].tobytes(), slopes[i].tobytes()) == (alone[0].tobytes(), alone[1].tobytes())
    plain = in_python(model).follow_lanes(measured[:4], VOLTAGE[:6], rest, q[:2], step=5e-4, parts=2)
    assert (plain[0].tobytes(), plain[1].tobytes()) == (states[:2, :4].tobytes(), slopes[:2, :4].tobytes())


@pytest.mark.check
@pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE if fades(effect)])
def test_an_effect_acts_alike_where_all_others_are_passed_over(name: str) -> None:
    """The derivatives of what is measured, along one motion."""
    measured = AXIS.simulate(VOLTAGE, AXIS.state(y=-0.5, p_a=3e5, p_b=4e5), parts=2)[:, :4]
    lane, given = driven_in_one_kernel(name), (VOLTAGE, starts(1)[0, 4:])
    how = {"step": 5e-4, "parts": 2, "columns": ("v", "p_a", "p_b")}
    passed, usual = (lane.follow_lanes(measured, *given, lane.values[None], **how, passing=p)[1] for p in (True, False))
    scale = np.abs(usual).max(axis=(0, 1))
    assert np.abs(passed - usual).max(axis=(0, 1)) / scale == pytest.approx(0.0, abs=1e-9)


@pytest.mark.check
@pytest.mark.parametrize("entry", ["run_lanes", "follow_lanes"])
def test_nothing_in_a_kernel_calls_out_and_lanes_are_vectors(entry: str) -> None:
    """No elementary function of a library, which would keep lanes from advancing side by side."""
    model = everything()
    if entry == "run_lanes":
        model.simulate_lanes(VOLTAGE[:1], starts(1))
    else:
        model.follow_lanes(starts(2)[:, :4], VOLTAGE[:1], starts(1)[:, 4:], model.values[None])
    lanes = getattr(model.kernel, entry)
    lanes.recompile()  # a kernel from the cache has no inspectable code
    text = "\n".join(lanes.inspect_llvm().values())
    called = set(re.findall(r"call [^@\n]*@\"?([\w.]+)", text))
    assert not [
        name for name in called if re.search(r"(^|\.)(sin|cos|tan|atan2?|exp2?|log|log2|pow|tanh)f?(\.|$)", name)
    ]
    single, packed = (len(re.findall(rf"f(?:mul|add|sub|div) {kind}", text)) for kind in ("double", r"<\d+ x double>"))
    assert packed > 500
    assert packed > 0.8 * single
