"""Residuals of the equations: one noise level where nothing is missing; a missing effect in its unit where it acts."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from identify.making import POSITION_NOISE, own, recording, rig

from pneumo_ros.equations.bump import Bump
from pneumo_ros.equations.equations import Balance
from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.equations.weak import Residual, equation_residuals
from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import Run, make_run
from pneumo_ros.runs.sensors import driven

EQUATIONS = ("momentum", "chamber_a", "chamber_b")
RUNS = ("train_steps", "train_sweep", "train_slow", "train_creep")


def ratios(model: Model, run: Run) -> dict[str, float]:
    return {name: residual.ratio_to_noise for name, residual in equation_residuals(model, run).items()}


@pytest.mark.parametrize("kind", ["steps", "sweep", "slow"])
def test_the_true_machine_leaves_its_noise(kind: str) -> None:
    model, _, run = own(kind)
    found = equation_residuals(model, run)
    assert found.keys() == set(EQUATIONS)
    for residual in found.values():
        assert residual.ratio_to_noise == pytest.approx(1.0, abs=0.1)
    assert found["momentum"].rms < 0.06


@pytest.mark.check
def test_the_true_machine_leaves_its_noise_on_the_independent_rig() -> None:
    """Eight runs of two worn rigs that hide nothing."""
    found = [
        equation_residuals(model, run) for model, _, run in (rig(name, seed) for name in RUNS for seed in range(2))
    ]
    for equation in EQUATIONS:
        values = np.concatenate([one[equation].value / one[equation].noise for one in found])
        assert np.sqrt(np.mean(values**2)) == pytest.approx(1.0, abs=0.06)
        assert max(one[equation].ratio_to_noise for one in found) < 1.25
    assert max(one["momentum"].rms for one in found) < 0.08


@pytest.mark.parametrize("sample_time", [5e-4, 2e-3, 4e-3, 1e-2])
def test_any_rate(sample_time: float) -> None:
    """Few samples in a window: sums must still be integrals, or state their distance from them."""
    for noisy in (True, False):
        model, _, run = own("steps", sample_time, noisy)
        assert max(ratios(model, run).values()) < 1.15


def slope(residual: Residual, run: Run, signal: np.ndarray) -> float:
    """Slope of the residual over a signal (n,) of the run."""
    return float(np.polyfit(np.interp(residual.time, run.time, signal), residual.value, 1)[0])


def test_viscous_friction_shows_in_momentum_alone_and_in_newtons() -> None:
    model, recorded, run = rig("train_sweep", effect="viscous_friction", size=180.0)
    found = equation_residuals(model, run)
    assert found["momentum"].ratio_to_noise > 50.0
    assert found["momentum"].unit == "N"
    assert slope(found["momentum"], run, recorded.truth[:, 1]) == pytest.approx(-180.0, rel=0.03)
    assert max(found[name].ratio_to_noise for name in ("chamber_a", "chamber_b")) < 1.25


def test_a_constant_load_shows_as_what_it_is() -> None:
    model, _, run = rig("train_steps", effect="constant_load", size=35.0)
    found = equation_residuals(model, run)
    assert np.mean(found["momentum"].value) == pytest.approx(-35.0, rel=0.01)
    assert max(found[name].ratio_to_noise for name in ("chamber_a", "chamber_b")) < 1.25


def test_a_leak_shows_in_the_chambers_alone_and_in_kilograms_per_second() -> None:
    size = 3e-10
    model, recorded, run = rig("train_steps", effect="cross_piston_leakage", size=size)
    found = equation_residuals(model, run)
    difference = recorded.truth[:, 2] - recorded.truth[:, 3]
    for name, sign in (("chamber_a", -1.0), ("chamber_b", 1.0)):
        assert found[name].unit == "kg/s"
        assert found[name].ratio_to_noise > 5.0
        assert slope(found[name], run, difference) == pytest.approx(sign * size, rel=0.05)
    assert found["momentum"].ratio_to_noise < 1.25


def test_signs_are_measured_minus_claimed() -> None:
    """A model with too much friction, and one whose valve lets too much in."""
    model, truth, run = own("steps")
    heavier = model.with_parameters({"lugre_friction.coulomb_friction": 80.0})
    residual = equation_residuals(heavier, run)["momentum"]
    direction = np.sign(np.interp(residual.time, run.time, truth[:, 1]))
    assert np.mean(residual.value * direction) == pytest.approx(10.0, rel=0.02)
    wider = model.with_parameters({"arctan_flow.filling_coefficient": 1.1 * model["arctan_flow.filling_coefficient"]})
    residual = equation_residuals(wider, run)["chamber_a"]
    assert residual.value[np.argmax(np.abs(residual.value))] < 0.0
    assert residual.ratio_to_noise > 10.0


def test_where_the_piston_rests_or_is_at_the_end_of_its_stroke_momentum_is_not_judged() -> None:
    model, truth, run = own("steps")
    fast = np.abs(np.interp(equation_residuals(model, run)["momentum"].time, run.time, truth[:, 1]))
    assert fast.min() > 0.009
    beyond = replace(run, position=run.position - run.position.max() + 1.02)
    ends = equation_residuals(model, beyond)["momentum"].time
    assert len(ends) > 20
    assert np.interp(ends, run.time, beyond.position).max() < 0.999


def test_a_piston_that_turns_between_two_samples_is_not_judged() -> None:
    """By 0.2 m/s from one sample to the next: none is slow, but friction changes its sign within each window."""
    model, _, run = own("steps", 2e-3, seconds=5.0)
    shaken = replace(run, position=0.04 * np.sin(2.0 * np.pi * 8.0 * run.time + 0.3))
    assert np.mean(np.abs(shaken.smoothed.motion[:, 1]) < 0.01) < 0.02
    assert len(equation_residuals(model, shaken)["momentum"].value) == 0


def test_nothing_moves() -> None:
    model, _, run = own("steps", seconds=5.0)
    still = replace(run, position=np.full(len(run), 0.1), input=np.zeros_like(run.input))
    residual = equation_residuals(model, still)["momentum"]
    assert len(residual.value) == 0
    assert np.isnan(residual.rms)
    assert np.isnan(residual.ratio_to_noise)


@pytest.mark.parametrize("samples", [60, 150])
def test_a_run_shorter_than_a_window_has_no_window(samples: int) -> None:
    model, _, run = own("steps", seconds=5.0)
    cut = {name: getattr(run, name)[:samples] for name in ("position", "pressure_a", "pressure_b", "measured")}
    found = equation_residuals(model, replace(run, **cut, input=run.input[: (samples - 1) * 10]))
    assert len(found["chamber_a"].value) == 0


def test_gaps_are_not_judged() -> None:
    model, _, run = own("steps", seconds=5.0)
    measured, pressure = run.measured.copy(), run.pressure_a.copy()
    measured[2000:2100] = False
    pressure[2000:2100] += 5e4
    found = equation_residuals(model, replace(run, measured=measured, pressure_a=pressure))["chamber_a"]
    assert found.ratio_to_noise < 1.3
    assert not np.any((found.time > 1.91) & (found.time < 2.19))


def test_positions_outside_the_stroke_are_refused() -> None:
    model, _, run = own("steps", seconds=5.0)
    with pytest.raises(DataError, match="outside the stroke"):
        equation_residuals(model, replace(run, position=run.position + 2.0))


FORCE_DRIVEN = """/**:
  ros__parameters:
    effects: [lugre_friction, quadratic_drag]
    piston: {mass: 20.0, area_a: 4.1e-4, area_b: 3.0e-4, stroke: 4.0}
    lugre_friction: {static_friction: 30.0, coulomb_friction: 20.0, stribeck_velocity: 0.01, bristle_stiffness: 1.0e+5,
                     bristle_damping: 300.0, breakaway_ratio: 0.9}
    quadratic_drag: {coefficient: 500.0}
"""


@pytest.fixture(scope="module")
def force_driven(tmp_path_factory: pytest.TempPathFactory) -> tuple[Model, Run]:
    """A mass on a rail, pushed by a measured force; the noise of the force is 0.5 N."""
    path: Path = tmp_path_factory.mktemp("machine") / "rail.yaml"
    path.write_text(FORCE_DRIVEN)
    model, rng = load_model(path), np.random.default_rng(0)
    time = np.arange(20_001) * 1e-3
    force = 60.0 * np.sin(2.0 * np.pi * 0.4 * time)
    parts = np.interp((np.arange(200_000) + 0.5) * 1e-4, time, force)
    y = np.append(0.0, model.simulate(parts, model.state(), parts=10)[:, 0])
    y += rng.normal(0.0, POSITION_NOISE, len(time))
    return model, make_run(recording(time=time, position=y, effort=force + rng.normal(0.0, 0.5, len(time))))


def test_a_force_driven_axis_has_momentum_alone(force_driven: tuple[Model, Run]) -> None:
    model, run = force_driven
    found = equation_residuals(model, run)
    assert list(found) == ["momentum"]
    assert found["momentum"].ratio_to_noise == pytest.approx(1.0, abs=0.15)
    lighter = model.with_parameters({"lugre_friction.coulomb_friction": 19.0})
    assert equation_residuals(lighter, run)["momentum"].ratio_to_noise > 5.0


@pytest.mark.parametrize("samples", [9, 11, 51, 201])
def test_the_test_function_takes_means_and_derivatives(samples: int) -> None:
    bump = Bump.of((samples - 1) * 1e-3, 1e-3)
    assert bump.width == samples
    t = (np.arange(samples) - samples // 2) * 1e-3
    assert bump.apply(bump.phi, np.ones(samples)) == pytest.approx(1.0)
    assert bump.apply(bump.first, np.full(samples, 7.0)) == pytest.approx(0.0, abs=1e-9)
    assert bump.apply(-bump.first, 3.0 * t) == pytest.approx(3.0, rel=1e-12)
    assert bump.apply(bump.second, 7.0 + 3.0 * t) == pytest.approx(0.0, abs=1e-7)
    assert bump.apply(bump.second, 0.5 * 9.81 * t**2) == pytest.approx(9.81, rel=1e-9)


@pytest.mark.parametrize("samples", [9, 11, 51, 201])
def test_sums_by_parts_hold_for_any_samples(samples: int) -> None:
    """Not for smooth signals alone: the rate of a pressure jumps where the valve's command steps."""
    bump, step = Bump.of((samples - 1) * 1e-3, 1e-3), 1e-3
    x = np.random.default_rng(samples).normal(size=samples + 2)
    rate, bend = (x[2:] - x[:-2]) / (2.0 * step), (x[2:] - 2.0 * x[1:-1] + x[:-2]) / step**2
    assert bump.apply(-bump.first, x[1:-1]) == pytest.approx(bump.apply(bump.phi, rate), rel=1e-9)
    assert bump.apply(bump.second, x[1:-1]) == pytest.approx(bump.apply(bump.phi, bend), rel=1e-9)


@pytest.mark.parametrize("sample_time", [1e-3, 4e-3])
def test_short_windows_of_the_true_chambers_leave_nothing(sample_time: float) -> None:
    """Without noise, though the smoothed velocity is wrong where the motion turns: its part of the claim cancels."""
    model, _, run = own("steps", sample_time, noisy=False)
    states, claimed = driven(model, measured_frame(run, model.chambers), run)
    bump = Bump.of(0.04, sample_time)
    for chamber in model.chambers:
        equation = Balance(model, chamber)
        flow = np.abs(equation.value(bump, states, np.zeros(len(run)))).max()
        left = np.abs(equation.value(bump, states, claimed[:, equation.column])).max()
        assert left < 1e-4 * flow


@pytest.mark.parametrize("samples", [11, 41, 101])
@pytest.mark.parametrize("more", [-1, 0, 1, 24, 25, 26, 1000])
def test_every_window_is_summed_by_itself(samples: int, more: int) -> None:
    bump = Bump.of((samples - 1) * 1e-3, 1e-3)
    signal = np.random.default_rng(samples).normal(size=samples + more)
    step = samples // 4
    alone = [bump.phi @ signal[k : k + samples] for k in range(0, more + 1, step)]
    assert bump.apply(bump.phi, signal) == pytest.approx(alone, abs=1e-12)
    assert len(bump.centres(len(signal))) == len(alone)


def test_windows_lie_a_quarter_of_their_width_apart() -> None:
    model, _, run = own("steps", seconds=5.0)
    np.testing.assert_allclose(np.diff(equation_residuals(model, run)["chamber_a"].time), 0.05, rtol=1e-9)


def test_the_noise_of_a_force_is_that_of_all_the_mass_that_moves() -> None:
    """A payload amplifies the noise of the position as the piston's own mass does: the true machine is explained."""
    import pneumo_ros as pn

    axis = pn.load_model("axis")
    heavy = axis.with_effects([*axis.effects, "payload_mass"], {"payload_mass.mass_added": 15.0})
    noise = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}
    found = pn.compare(pn.simulate(heavy, "sine:4,1.3", seconds=5, noise=noise), heavy)
    assert found.detail.equations["momentum"].ratio_to_noise < 1.2  # 4 with that of the piston's 5 kg alone
