"""Bristle stiffness from presliding where the sensor shows it, else by the paper's rules, with a remark."""

from dataclasses import replace

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.equations.breakaway import find_breakaways
from pneumo_ros.identify.presliding import DAMPING, STIFFNESS, Presliding, fit_presliding, passive_damping
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run


def fit(model: Model, runs: list[Run]) -> Presliding:
    return fit_presliding(model, runs, [b for run in runs for b in find_breakaways(model, run)])


def test_slow_rises_show_the_stiffness() -> None:
    runs = [constant_run(volts) for volts in (0.80, -0.80, 0.83, -0.83)]
    start = truth().with_parameters({STIFFNESS: 1e6})
    found = fit(start, runs)
    low, high = found.intervals[STIFFNESS]
    assert low < truth()[STIFFNESS] < high
    assert found.values[STIFFNESS] == pytest.approx(truth()[STIFFNESS], rel=0.05)
    assert found.remarks[STIFFNESS] == "presliding before 4 breakaways"


def test_intervals_hold_the_truth_over_many_noises() -> None:
    """Twenty times the same breakaway with other noise."""
    run = constant_run(0.80, noisy=False)
    held = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        assert run.pressure_a is not None
        assert run.pressure_b is not None
        noisy = Run(
            run.name, run.sample_time, run.position + 10e-6 * rng.standard_normal(len(run)),
            run.pressure_a + 300.0 * rng.standard_normal(len(run)),
            run.pressure_b + 300.0 * rng.standard_normal(len(run)), run.input, run.measured, False,
        )  # fmt: skip
        low, high = fit(truth(), [noisy]).intervals[STIFFNESS]
        held.append(low < truth()[STIFFNESS] < high)
    assert sum(held) >= 17


def test_fast_breakaways_show_no_presliding_and_the_rule_is_named() -> None:
    found = fit(truth(), [constant_run(7.0), constant_run(-7.0)])
    assert found.intervals == {}
    assert found.values[STIFFNESS] == pytest.approx(70.0 / 50e-6)
    assert "not measured" in found.remarks[STIFFNESS]
    assert "Eq. 15" in found.remarks[STIFFNESS]


@pytest.mark.parametrize("seed", range(4))
def test_a_noisy_sensor_shows_no_presliding(seed: int) -> None:
    """A millimetre of noise over 50 micrometres of presliding: the fitted slope is pure chance."""
    run = constant_run(0.80)
    noise = 1e-3 * np.random.default_rng(seed).standard_normal(len(run))
    breakaways = find_breakaways(truth(), run)
    found = fit_presliding(truth(), [replace(run, position=run.position + noise)], breakaways)
    assert found.intervals == {}
    assert "not measured" in found.remarks[STIFFNESS]


def test_damping_is_kept_where_it_is_passive() -> None:
    found = fit(truth(), [constant_run(7.0)])
    assert found.values[DAMPING] == truth()[DAMPING]
    assert found.remarks[DAMPING].startswith("not measured, kept as it was; passive up to 3761 N s/m (Eq. 16")


def test_damping_above_the_bound_is_lowered_to_it() -> None:
    found = fit(truth().with_parameters({DAMPING: 1e4}), [constant_run(7.0)])
    assert found.values[DAMPING] == pytest.approx(3761.0, abs=1.0)
    assert "lowered to the passive limit" in found.remarks[DAMPING]


def test_bound_of_passive_damping() -> None:
    """2 sqrt(C_d F_c) F_s / (F_s - F_c) of the paper's values; without a Stribeck rise there is none."""
    assert passive_damping(truth()) == pytest.approx(3761.0, abs=0.5)
    assert passive_damping(truth().with_parameters({"lugre_friction.static_friction": 70.0})) == np.inf
