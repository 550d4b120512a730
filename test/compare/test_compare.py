"""A model against recordings of the independent rig: results for the true machine and for others."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from identify.making import POSITION_FLOOR, PRESSURE_NOISE, own, rig

from pneumo_ros.command.console import plain
from pneumo_ros.compare.compare import Comparison, compare
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import load_model

SIGNALS = {"position_m", "pressure_a_pa", "pressure_b_pa"}
EQUATIONS = {"momentum": "N", "chamber_a": "kg/s", "chamber_b": "kg/s"}


@pytest.fixture(scope="module")
def healthy() -> Comparison:
    """The true machine against two runs of the rig."""
    model, _, steps = rig("train_steps")
    return compare(model, [steps, rig("train_sweep")[2]])


def test_the_json_has_the_keys_programs_rely_on(healthy: Comparison) -> None:
    result = json.loads(json.dumps(plain(healthy.as_dict()), allow_nan=False))
    assert result["schema_version"] == 1
    assert result["model"] == "axis"
    assert result["horizon_s"] == 1.0
    assert [run["name"] for run in result["runs"]] == ["train_steps", "train_sweep"]
    for run in result["runs"]:
        assert run["samples"] == 20_000
        assert run["duration_s"] == pytest.approx(20.0, abs=0.01)
        assert run["error"].keys() == run["free_run"].keys() == SIGNALS
        for error in run["error"].values():
            assert {"rms", "max", "fit_percent", "noise"} <= error.keys()
        assert all(free["rms"] > 0.0 for free in run["free_run"].values())
    assert result["equations"].keys() == EQUATIONS.keys()
    for name, equation in result["equations"].items():
        assert equation["unit"] == EQUATIONS[name]
        assert equation["explained_by_noise"] is True
        assert equation["residual_rms"] > 0.0


def test_numbers_are_in_metres_and_pascals(healthy: Comparison) -> None:
    for run in healthy.runs:
        position, pressure = run.error["position_m"], run.error["pressure_b_pa"]
        assert position.noise == pytest.approx(POSITION_FLOOR, rel=0.06)
        assert pressure.noise == pytest.approx(PRESSURE_NOISE, rel=0.06)
        assert position.rms == pytest.approx(POSITION_FLOOR, rel=0.3)
        assert pressure.rms == pytest.approx(PRESSURE_NOISE, rel=0.06)
        assert 3.0 * position.rms < position.max < 30.0 * position.rms
        assert position.fit_percent > 99.99
        assert position.ratio == pytest.approx(position.rms / position.noise)


def test_the_true_machine_is_explained_by_noise(healthy: Comparison) -> None:
    for verdict in healthy.equations.values():
        assert verdict.ratio_to_noise == pytest.approx(1.0, abs=0.12)
        assert verdict.explained_by_noise


@pytest.mark.parametrize(
    ("effect", "size", "failing"),
    [
        ("viscous_friction", 2.0, {"momentum"}),
        ("cross_piston_leakage", 3e-11, {"chamber_a", "chamber_b"}),
        ("leakage_to_atmosphere", 3e-11, {"chamber_b"}),
        ("kinked_hose", 0.9, {"chamber_a"}),
        ("valve_null_offset", 0.005, {"chamber_a", "chamber_b"}),
    ],
)
def test_a_hidden_effect_fails_the_equation_it_is_in(effect: str, size: float, failing: set[str]) -> None:
    """A small share of the usual sizes; the model knows everything else."""
    model, _, run = rig("train_steps", effect=effect, size=size)
    verdicts = compare(model, [run]).equations
    assert {name for name, verdict in verdicts.items() if not verdict.explained_by_noise} == failing


def test_the_errors_of_another_machine_are_many_noises() -> None:
    comparison = compare(load_model(), [rig("train_steps")[2]])
    assert comparison.runs[0].error["position_m"].ratio > 20.0
    assert not any(verdict.explained_by_noise for verdict in comparison.equations.values())


def test_progress_names_every_run() -> None:
    model, _, run = own("steps", seconds=3.0)
    said: list[tuple[float, str]] = []
    compare(model, [run, replace(run, name="again")], 0.5, lambda share, name: said.append((share, name)))
    assert said[:2] == [(0.0, "steps"), (0.5, "again")]


def test_a_run_alone_and_among_others_is_judged_equally(healthy: Comparison) -> None:
    alone = compare(rig("train_steps")[0], [rig("train_sweep")[2]])
    for name, error in alone.runs[0].error.items():
        assert error.rms == pytest.approx(healthy.runs[1].error[name].rms, rel=1e-9)


def test_what_never_moves_is_not_judged_by_momentum() -> None:
    model, _, run = own("steps", seconds=3.0)
    rng = np.random.default_rng(0)
    still = replace(
        run,
        position=0.1 + rng.normal(0.0, 5e-6, len(run)),
        pressure_a=3e5 + rng.normal(0.0, 300.0, len(run)),
        pressure_b=3.8e5 + rng.normal(0.0, 300.0, len(run)),
        input=np.zeros_like(run.input),
    )
    comparison = compare(model, [still])
    momentum = comparison.equations["momentum"]
    assert momentum.explained_by_noise is None
    assert math.isnan(momentum.ratio_to_noise)
    assert comparison.equations["chamber_a"].explained_by_noise
    assert plain(comparison.as_dict())["equations"]["momentum"]["residual_rms"] is None


def test_a_simulation_without_noise_is_explained() -> None:
    """A recording of `pneumo simulate`."""
    model, _, run = own("steps", noisy=False, seconds=5.0)
    comparison = compare(model, [run])
    assert all(verdict.explained_by_noise for verdict in comparison.equations.values())
    assert all(error.ratio < 1.0 for error in comparison.runs[0].error.values())


def test_a_run_without_a_window_is_named() -> None:
    model, _, run = own("steps", seconds=3.0)
    with pytest.raises(UsageError, match="steps has no window of 4 s"):
        compare(model, [run], 4.0)


def test_a_run_outside_the_stroke_is_named() -> None:
    model, _, run = own("steps", seconds=3.0)
    with pytest.raises(DataError, match="steps: the position is"):
        compare(model, [replace(run, position=run.position + 5.0)])


def test_no_runs_at_all() -> None:
    comparison = compare(load_model(), [])
    assert comparison.runs == ()
    assert comparison.equations == {}
