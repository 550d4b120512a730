"""A model fitted with possible new effects: sizes that replace each other, and parameters with known values."""

from functools import lru_cache
from importlib import import_module

import numpy as np
import pytest
from identify.making import PARTS, PRESSURE_NOISE, own, rig, voltage

from pneumo_ros.api.simulating import simulate
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.polishing import polish
from pneumo_ros.diagnose.refining import refine
from pneumo_ros.diagnose.screening import screen
from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import Run, run_for

STRIBECK, LEAKS = "stribeck_shape", "leakage_to_atmosphere"
STATIC = "lugre_friction.static_friction"
OFFSET, RIGHT, LEFT = "valve_null_offset.offset", "dead_zone.right_limit", "dead_zone.left_limit"


@lru_cache(maxsize=2)
def fitter(candidate: str) -> Fitter:
    """Of a machine that hides nothing."""
    model, _, run = own("steps")
    return Fitter(model, [run], [run], [candidate])


def with_effect(name: str, **values: float) -> Model:
    start = fitter(name).start
    return start.with_effects([*start.effects, name], {f"{name}.{key}": value for key, value in values.items()})


def test_a_size_that_another_one_replaces_is_left_neutral() -> None:
    """For a Gaussian Stribeck curve, exponent 2 and no rational tail; a tail with another exponent is similar."""
    found = fitter(STRIBECK).simplest(with_effect(STRIBECK, exponent=1.6, rational=0.5), STRIBECK)
    assert 0.0 in (found[f"{STRIBECK}.rational"], found[f"{STRIBECK}.exponent"] - 2.0)


def test_a_valley_that_is_flat_is_followed_to_its_end() -> None:
    """A null offset is two dead zones that moved apart; what the file knows of them says how large it is.

    By finite differences of 0.5 and 0.2 mV the slopes of the three differed at the edges of slow openings, and the fit
    stopped on its way: at -0.234 V here, and half way with a campaign.
    """
    axis = load_model("axis")
    truth = axis.with_effects([*axis.effects, "valve_null_offset"], {OFFSET: -0.24})
    noise = {"position": 5e-6, "pressure_a": 300.0, "pressure_b": 300.0}
    slow = [simulate(truth, f"sine:{text}", seconds=20, noise=noise, name=text) for text in ("1.3,0.1", "1.6,0.2")]
    fitter = Fitter(axis, [run_for(one, axis) for one in slow], candidates=("valve_null_offset",))
    moved = fitter.refit(axis)
    assert moved[RIGHT] - moved[LEFT] == pytest.approx(0.48, abs=0.01)
    found = fitter.refit(moved.with_effects([*moved.effects, "valve_null_offset"], {OFFSET: -0.02}))
    assert [found[name] for name in (OFFSET, RIGHT, LEFT)] == pytest.approx([-0.24, 0.78, 0.78], abs=1e-3)


@pytest.mark.parametrize(("behind", "best"), [(0.0, "rational"), (10.0, "exponent")])
def test_of_kinds_that_explain_as_much_the_one_that_predicts_best_is_kept(
    behind: float, best: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tail predicts twice as well; it is taken unless the equations lose more than 3 nats by it."""
    tail = f"{STRIBECK}.rational"
    monkeypatch.setattr(Fitter, "refit", lambda _self, model, fixed=(): model)
    monkeypatch.setattr(Fitter, "gain", lambda _self, new, _old: -behind if new[tail] else 0.0)
    monkeypatch.setattr(
        import_module(Fitter.__module__), "windowed", lambda model, *_: {"y": 1.0 if model[tail] else 2.0}
    )
    found = fitter(STRIBECK).simplest(with_effect(STRIBECK, exponent=1.3, rational=0.0), STRIBECK)
    assert found[f"{STRIBECK}.exponent"] == (1.3 if best == "exponent" else 2.0)
    assert (found[tail] > 0.0) == (best == "rational")


def test_sizes_of_one_kind_are_all_kept() -> None:
    model = with_effect(LEAKS, conductance_a=1e-11, conductance_b=2e-11)
    assert fitter(LEAKS).simplest(model, LEAKS) is model


def test_the_equations_speak_against_an_effect_that_is_not_there() -> None:
    start = fitter(LEAKS).start
    values = {f"{LEAKS}.conductance_{side}": 0.0 for side in "ab"}
    assert abs(fitter(LEAKS).against(start, LEAKS, values)) < 0.5
    assert fitter(LEAKS).against(start, LEAKS, values | {f"{LEAKS}.conductance_a": 2e-10}) > 100.0


@pytest.mark.check
@pytest.mark.parametrize("std", [1e-4, None])
def test_what_is_known_from_elsewhere_holds_a_refit_by_prediction(std: float | None) -> None:
    """Static friction is 2 % off: segments correct it, unless it is given as known."""
    start = fitter(LEAKS).start
    off = start.with_parameters({STATIC: 1.02 * start[STATIC]})
    sure = None if std is None else {STATIC: std}
    found = polish(fitter(LEAKS), off, fitter(LEAKS).train.runs, 12, sure=sure).model
    moved = abs(found[STATIC] - off[STATIC])
    assert moved < 0.02 if std else moved > 0.5


def test_parameters_of_the_model_that_are_zero_have_a_prior() -> None:
    """A spring whose rest position is 0, as by default: a prior of 0 would divide by it."""
    model, _, run = own("steps")
    known = Fitter(model.with_effects([*model.effects, "spring_load"]), [run], [run], []).known(
        model.with_effects([*model.effects, "spring_load"])
    )
    assert (known.prior > 0.0).all()
    assert (known.step > 0.0).all()


def test_priors_are_as_wide_as_the_machine_file_states() -> None:
    """What is stated of the frame, which is fixed otherwise, is free, too."""
    model, _, run = own("steps")
    volume = "chambers.volume_a"
    stated = Model.build(
        model.effects, model.parameters, library=model.library, uncertainty={STATIC: 30.0, volume: 5e-5}
    )
    plain, wide = (Fitter(one, [run], [run], []).known(one) for one in (model, stated))
    assert set(wide.names) - set(plain.names) == {volume}
    widths = dict(zip(wide.names, wide.prior.tolist(), strict=True))
    assert (widths[STATIC], widths[volume]) == (30.0, 5e-5)
    others = [name for name in plain.names if name != STATIC]
    assert [widths[n] for n in others] == [p for n, p in zip(plain.names, plain.prior, strict=True) if n != STATIC]


def test_the_curve_of_an_added_valve_is_fitted_and_no_effect() -> None:
    """Its index is 0.6: with 0.5, the critical ratio came out as 0.39, and sensors' gains explained what was left."""
    model, _, run = rig("train_steps", 0, "choked_flow:mixed", 0.95)
    found = Fitter(model, [run], [run], ["choked_flow"])
    iso = found.refit(model.with_effects([*model.effects, "choked_flow"]))
    bent = found.shaped(iso)
    assert bent["subsonic_index.index"] == pytest.approx(0.6, abs=0.02)
    assert bent["choked_flow.critical_ratio"] == pytest.approx(0.25, abs=0.02)
    assert found.added(bent) == ["choked_flow"]
    assert found.gain(bent, iso) > 100.0
    assert found.shaped(model) is model


def test_a_hypothesis_leaves_the_chambers_some_volume() -> None:
    """A machine file from data sheets states how well volumes are known, so that a linear step may move them far."""
    model, _, run = own("steps")
    volume = "chambers.volume_a"
    found = Fitter(model.with_uncertainty({volume: 0.2 * model[volume]}), [run], [run], [LEAKS])
    names = found.known(found.start).names
    shift = np.array([-5.0 if name == volume else 0.0 for name in names])
    larger = found.extended(found.start, Hypothesis(LEAKS, (), np.empty(0), shift, np.empty(0)))
    assert larger[volume] > 0.5 * model["piston.stroke"] * model["piston.area_a"]


@pytest.mark.parametrize(("noise", "least"), [(5e-5, 5.4), (1e-4, 4.5)])
@pytest.mark.parametrize("kind", ["sweep", "sine"])
def test_a_load_is_found_where_the_acceleration_is_noise(kind: str, noise: float, least: float) -> None:
    """6 kg, and a position known to 0.1 mm: least squares in a fixed unit found 0.7 kg by a sweep, and 0 by a sine.

    What the noise of the velocity costs remains: by six draws, 0.2 and 0.5 kg at 0.05 mm, 0.7 and 1.3 kg at 0.1 mm.
    """
    axis, name, rng = load_model("axis"), "payload_mass", np.random.default_rng(2)
    heavy = axis.with_effects([*axis.effects, name], {f"{name}.mass_added": 6.0})
    time = np.arange(20_000) * 1e-3
    held, start = np.repeat(voltage(kind, time)[:-1], PARTS), heavy.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([start, heavy.simulate(held, start, sample_time=1e-3, parts=PARTS)])
    y, p_a, p_b = (
        states[:, k] + rng.normal(0.0, n, len(time)) for k, n in ((0, noise), (2, PRESSURE_NOISE), (3, PRESSURE_NOISE))
    )
    run = Run(kind, 1e-3, y, p_a, p_b, held, np.ones(len(time), dtype=bool), False)
    fitter = Fitter(axis, [run], [run], [name])
    base = fitter.fits(fitter.refit(axis))[0]
    candidate = refine(base, screen(base)[:1])[0]
    assert candidate.values[f"{name}.mass_added"] > 3.0
    assert least < fitter.refit(fitter.extended(base.model, candidate))[f"{name}.mass_added"] < 6.6
