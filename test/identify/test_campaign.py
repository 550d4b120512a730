"""Identification as a whole: the paper's machine with noise, the independent rig, and runs that show too little."""

import os
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from identify.constant import VOLTAGES, constant_run, constant_runs, truth, wrong
from identify.making import rig

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.identify.campaign import FRICTION, Identification, identify
from pneumo_ros.identify.flow import COEFFICIENTS, LIMITS
from pneumo_ros.identify.presliding import DAMPING, STIFFNESS
from pneumo_ros.identify.summary import summary
from pneumo_ros.plant import Model, load_model, save_model
from pneumo_ros.records import read_recording
from pneumo_ros.runs.run import make_run

STATIC, COULOMB, STRIBECK, DRAG = FRICTION[:4]
RECORDED = Path(os.environ.get("PNEUMO_RIG", Path(__file__).parents[3] / "shared" / "rig")) / "healthy"
EVERY = (*FRICTION[:4], *COEFFICIENTS, *LIMITS, STIFFNESS)


@lru_cache(maxsize=1)
def campaign() -> Identification:
    """Ten runs of 8 s of the paper's machine, identified from an inexact machine file."""
    return identify(wrong(), constant_runs())


@lru_cache(maxsize=1)
def of_the_rig() -> tuple[Model, Identification]:
    """Six runs of the independent rig, worn, identified from the default machine."""
    runs = [rig(f"constant_{name}", 3) for name in ("p0880", "m0880", "p1100", "m1100", "p7000", "m7000")]
    return runs[0][0], identify(load_model(), [run for _, _, run in runs])


def errors(found: Identification, true: Model) -> dict[str, float]:
    """Relative error of everything that has an interval."""
    return {n: abs(p.value / true[n] - 1.0) for n, p in found.parameters.items() if p.interval}


def inside(found: Identification, true: Model) -> list[bool]:
    """Whether each interval holds the truth."""
    return [p.interval[0] <= true[n] <= p.interval[1] for n, p in found.parameters.items() if p.interval]


def test_friction_of_the_paper_comes_back() -> None:
    found = errors(campaign(), truth())
    assert found[COULOMB] < 0.01
    assert found[DRAG] < 0.01
    assert found[STATIC] < 0.05
    assert found[STRIBECK] < 0.05
    assert max(found[name] for name in (*COEFFICIENTS, *LIMITS)) < 0.005
    assert found[STIFFNESS] < 0.05
    assert not campaign().undetermined


def test_intervals_hold_the_truth_and_are_narrow() -> None:
    """Nine intervals: one miss is consistent with 95 %, three are not."""
    assert sum(inside(campaign(), truth())) >= 7
    for name, parameter in campaign().parameters.items():
        if parameter.interval:
            low, high = parameter.interval
            assert low < parameter.value < high
            assert high - low < 0.1 * parameter.value, name
    assert set(campaign().parameters) == {*EVERY, DAMPING}


def test_noise_explains_the_map() -> None:
    assert campaign().map_fit.ratio == pytest.approx(1.0, abs=0.1)


def test_the_model_holds_the_values_and_nothing_else_moved() -> None:
    found = campaign()
    for name, value in found.model.parameters.items():
        expected = found.parameters[name].value if name in found.parameters else wrong()[name]
        assert value == expected
    assert found.parameters[STATIC].before == wrong()[STATIC] == found.before[STATIC]


def test_the_machine_file_written_says_the_same(tmp_path_factory: pytest.TempPathFactory) -> None:
    path = save_model(campaign().model, tmp_path_factory.mktemp("machine") / "found.yaml")
    assert load_model(path).parameters == campaign().model.parameters


@pytest.mark.check
def test_the_independent_rig_is_identified() -> None:
    true, found = of_the_rig()
    off = errors(found, true)
    assert off[COULOMB] < 0.01
    assert off[DRAG] < 0.01
    assert off[STATIC] < 0.05
    assert off.get(STRIBECK, 0.0) < 0.15
    assert max(off[name] for name in (*COEFFICIENTS, *LIMITS)) < 0.01
    assert np.mean(inside(found, true)) >= 0.7
    assert found.map_fit.ratio == pytest.approx(1.0, abs=0.15)


def test_one_direction_leaves_the_other_limit_alone() -> None:
    found = identify(wrong(), constant_runs(0.83, 1.0, 7.0))
    assert found.parameters["dead_zone.left_limit"].interval is None
    assert "needs runs at negative voltages" in found.parameters["dead_zone.left_limit"].remark
    off = errors(found, truth())
    assert max(off[COULOMB], off[DRAG]) < 0.01


def test_one_run_determines_nothing_it_does_not_show() -> None:
    found = identify(wrong(), [constant_run(1.0)])
    assert set(found.undetermined) == {STATIC, COULOMB, STRIBECK, DRAG, *COEFFICIENTS}
    for name in found.undetermined:
        assert found.parameters[name].interval is None
        assert found.model[name] == wrong()[name]
        assert found.parameters[name].remark.startswith("not determined: ")
    assert found.correlations == {}


def exactly(model: Model, *names: str) -> Model:
    """The model, some of its parameters true and stated to be known exactly."""
    return model.with_parameters({n: truth()[n] for n in names}).with_uncertainty(dict.fromkeys(names, 0.0))


def test_what_is_known_exactly_is_kept() -> None:
    known = (STATIC, COEFFICIENTS[0], LIMITS[0], STIFFNESS)
    found = identify(exactly(wrong(), *known), constant_runs(0.83, 1.0, 7.0))
    assert not set(known) & set(found.parameters)
    assert {name: found.model[name] for name in known} == {name: truth()[name] for name in known}
    off = errors(found, truth())
    assert max(off[name] for name in (COULOMB, DRAG, COEFFICIENTS[1])) < 0.01


def test_nothing_is_left_to_identify() -> None:
    model = exactly(wrong(), *(name for name in FRICTION if name in wrong().parameters))
    with pytest.raises(UsageError, match=r"that lugre_friction.static_friction, .* are known exactly; give one"):
        identify(model, [constant_run(1.0)])


def test_runs_may_differ_in_sample_time() -> None:
    runs = [constant_run(volts, sample_time=1e-3 if volts > 0.0 else 2e-3) for volts in VOLTAGES[:8]]
    off = errors(identify(wrong(), runs), truth())
    assert max(off[COULOMB], off[DRAG]) < 0.01
    assert max(off[STATIC], off[STRIBECK]) < 0.10


def test_a_stuck_piston_among_the_runs_does_no_harm() -> None:
    """Ten seconds at half a volt: no window of it is used, and nothing else changes."""
    runs = constant_runs(0.83, 1.0, -7.0)
    without, with_it = identify(wrong(), runs), identify(wrong(), [*runs, constant_run(0.5, seconds=10.0)])
    assert {w.reason for w in with_it.windows if w.run == "constant_+0.50V"} == {"the piston rests or creeps"}
    assert with_it.model.parameters == without.model.parameters


@pytest.mark.parametrize(
    ("runs", "words"),
    [
        ([constant_run(0.5, seconds=10.0)], r"voltage \(39 times: the piston rests or creeps\), and no motion to fit"),
        ([constant_run(1.0), constant_run(1.0)], r"constant_\+1.00V is given twice"),
        ([replace(constant_run(1.0), position=1e3 * constant_run(1.0).position)], "outside the stroke"),
        ([], "the voltage is nowhere constant for a quarter of a second, and no motion"),
    ],
    ids=["stuck", "twice", "millimetres", "none"],
)
def test_what_cannot_be_identified_is_said(runs: list, words: str) -> None:
    with pytest.raises((DataError, UsageError), match=words):
        identify(wrong(), runs)


def test_without_one_steady_stretch_all_is_fitted_by_the_motion() -> None:
    """A sweep shows no static map and every parameter: it was refused once."""
    true, _, run = rig("train_sweep")
    filling = COEFFICIENTS[0]
    found = identify(true.with_parameters({COULOMB: 1.2 * true[COULOMB], filling: 0.9 * true[filling]}), [run])
    assert found.why_motion == "The voltage is nowhere constant for a quarter of a second"
    assert found.segments > 50
    for name in (COULOMB, filling):
        low, high = found.parameters[name].interval
        assert low < true[name] < high
        assert found.model[name] == pytest.approx(true[name], rel=0.02)


def test_a_machine_without_lugre_friction_is_refused() -> None:
    bare = truth().with_effects([e for e in truth().effects if e not in ("lugre_friction", "quadratic_drag")])
    with pytest.raises(UsageError, match="add lugre_friction to the effects"):
        identify(bare, [constant_run(1.0)])


def test_the_summary_holds_the_evidence() -> None:
    runs = constant_runs()
    data = summary(campaign(), runs)
    used = sum(run["used"] for run in data["runs"])
    points = data["map"]["points"]
    assert used == len(points["velocity"]) == len(points["residual"]) == len(campaign().points)
    assert used + len(data["refused"]) == sum(run["windows"] for run in data["runs"]) == len(campaign().windows)
    for run in data["runs"]:
        assert run["used"] == sum(part["windows"] for part in run["stretches"])
        assert run["windows"] - run["used"] == sum(run["refused"].values())
    curve = data["map"]["curve"]
    assert np.isnan(curve["friction"]).sum() == 1
    assert data["breakaways"][0]["force_n"] > 90.0
    assert all(abs(pair["r"]) <= 1.0 + 1e-9 for pair in data["correlations"])


@pytest.mark.skipif(not RECORDED.is_dir(), reason="the recordings of the rig lie beside the checkout, not in it")
def test_recordings_of_the_rig_are_identified() -> None:
    """Bags of a machine whose parameters are within 5 % of the default ones."""
    names = ("p0880", "m0880", "p7000", "m7000")
    found = identify(load_model(), [make_run(read_recording(RECORDED / f"constant_{name}")) for name in names])
    assert found.map_fit.ratio == pytest.approx(1.0, abs=0.2)
    assert {COULOMB, DRAG, *COEFFICIENTS, *LIMITS} <= {name for name, one in found.parameters.items() if one.interval}
    for name in (*FRICTION[:2], DRAG, *COEFFICIENTS, *LIMITS):
        assert found.model[name] == pytest.approx(load_model()[name], rel=0.06), name
