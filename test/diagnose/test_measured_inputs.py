"""Friction that follows recorded pressures, on a rod that a measured force drives, simulated by the independent rig."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from identify.making import POSITION_NOISE, recording_of
from rig import case as rig_case
from rig.effects import Wish, build

from pneumo_ros.diagnose.adding import Adding, add
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import Hypothesis, missing, unmeasured
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.diagnose.screening import screen
from pneumo_ros.errors import DataError
from pneumo_ros.plant import Library, Model, load_model
from pneumo_ros.runs.inputs import measured_inputs
from pneumo_ros.runs.run import PARTS, Run, make_run

EFFECT = "pressure_dependent_friction"
RISE, FORCE_NOISE, SAMPLES = 8e-5, 0.3, 12_000  # N/Pa, N, of each run
NO_CELL = {"measured_load": ("load_force",)}
NAMES = ("train_steps", "train_slow", "holdout_steps")


def rod(library: Library | None = None) -> Model:
    """Piston and friction alone; the section air is left out, too."""
    axis, own = load_model("axis"), ("lugre_friction", "quadratic_drag", "end_stop")
    values = {name: value for name, value in axis.parameters.items() if name.partition(".")[0] in (*own, "piston")}
    return Model.build(own, values, frame=("piston",), name="rod", library=library)


@lru_cache(maxsize=1)
def runs() -> tuple[Run, ...]:
    """A worn machine whose seals rub with pressure: position, pressures, and the force on its piston."""
    case = build(3, [Wish(EFFECT, RISE)])
    m, noise, found = case.machine, np.random.default_rng(1), list[Run]()
    for run in rig_case.make_runs(case, NAMES, step=4e-5):
        _, _, p_a, p_b, _ = run.truth.T
        force = m.area_a * p_a - m.area_b * p_b - m.atmosphere * (m.area_a - m.area_b)
        whole = recording_of(run)
        own = {name: getattr(whole, name)[:SAMPLES] for name in ("time", "position", "pressure_a", "pressure_b")}
        effort = (force + noise.normal(0.0, FORCE_NOISE, len(force)))[:SAMPLES]
        found.append(make_run(replace(whole, **own, effort=effort, voltage=None, command=None, command_time=None)))
    return tuple(found)


def blind(run: Run, *lost: str) -> Run:
    """The run without some of its pressures."""
    return replace(run, further={name: held for name, held in run.further.items() if name not in lost})


def ranked(model: Model, given: Sequence[Run]) -> list[Hypothesis]:
    """The candidates, best first; the last run is held out."""
    *train, held = given
    fitter = Fitter(model, train, [held])
    return screen(fitter.ranking_fit(fitter.refit(model)))


@pytest.mark.check
def test_it_is_ranked_first_with_its_size() -> None:
    best = ranked(rod(), runs())[0]
    assert best.name == EFFECT
    assert best.values[f"{EFFECT}.coefficient"] == pytest.approx(RISE, rel=0.05)


OWN = '''
from pneumo_ros.plant.effect import Effect, Parameter


class SealOfA(Effect):
    """The piston's seal, pressed on by the air of chamber a."""

    rise = Parameter(2e-5, "N/Pa", "rise of friction with the pressure in chamber a", low=0.0, neutral=0.0)

    def equations(p_a, p_atm, rise):
        friction_rise = rise * max(p_a - p_atm, 0.0)
        return friction_rise
'''


def pushed(truth: Model, phase: float) -> Run:
    """The rod pushed to and fro while the pressure in chamber a rises and falls; there is no sensor in chamber b."""
    n = 10_001
    t = (np.arange((n - 1) * PARTS) + 0.5) * 1e-3 / PARTS
    force = 180.0 * np.sin(np.pi * t + phase) + 40.0 * np.sin(8.0 * t)
    p_a = 3.5e5 + 2e5 * np.sin(0.7 * t + phase)
    states = truth.simulate(np.column_stack([force, p_a]), truth.state(), parts=PARTS)
    y = np.append(0.0, states[:, 0]) + np.random.default_rng(2).normal(0.0, POSITION_NOISE, n)
    return Run(f"run {phase}", 1e-3, y, None, None, force, np.ones(n, dtype=bool), True, {"p_a": p_a})


@pytest.mark.check
def test_an_effect_of_ones_own_needs_only_the_sensor_that_it_reads(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(OWN)
    model = rod(Library([tmp_path / "own.py"]))
    truth = model.with_effects([*model.effects, "seal_of_a"], {"seal_of_a.rise": RISE})
    given = [pushed(truth, phase) for phase in (0.0, 1.0, 2.0)]
    best = ranked(model, given)[0]
    assert best.name == "seal_of_a"
    assert best.values["seal_of_a.rise"] == pytest.approx(RISE, rel=0.05)
    offered = missing(model, measured_inputs(given))
    assert "seal_of_a" in offered
    assert EFFECT not in offered
    assert "seal_of_a" not in missing(model, measured_inputs([*given, blind(given[0], "p_a")]))


def opposed(truth: Model, phase: float) -> Run:
    """The rod pushed to and fro against another one, with a load cell between them that counts pushes as pulls."""
    n = 6001
    t = (np.arange((n - 1) * PARTS) + 0.5) * 1e-3 / PARTS
    force = 180.0 * np.sin(np.pi * t + phase) + 40.0 * np.sin(8.0 * t)
    cell = 60.0 * np.sin(4.3 * t + 2.0 * phase) + 5.0
    states = truth.simulate(np.column_stack([force, cell]), truth.state(), parts=PARTS)
    y = np.append(0.0, states[:, 0]) + np.random.default_rng(2).normal(0.0, POSITION_NOISE, n)
    return Run(f"run {phase}", 1e-3, y, None, None, force, np.ones(n, dtype=bool), True, {"load_force": cell})


@pytest.mark.check
def test_a_load_that_a_load_cell_measures_is_no_friction() -> None:
    truth = rod().with_effects([*rod().effects, "measured_load"], {"measured_load.gain": -1.0})
    best = ranked(rod(), [opposed(truth, phase) for phase in (0.0, 1.0, 2.0)])[0]
    assert best.name == "measured_load"
    assert best.values["measured_load.gain"] == pytest.approx(-1.0, rel=0.02)


@pytest.mark.parametrize("lost", [("p_a",), ("p_b",), ("p_a", "p_b")])
def test_without_both_pressures_it_is_not_offered(lost: tuple[str, ...]) -> None:
    offered = missing(rod(), measured_inputs([runs()[0], blind(runs()[1], *lost)]))
    assert EFFECT not in offered
    assert set(missing(rod(), measured_inputs(runs()))) - set(offered) == {EFFECT}
    assert unmeasured(rod(), measured_inputs([blind(runs()[1], *lost)])) == {EFFECT: lost, **NO_CELL}
    assert unmeasured(rod(), measured_inputs(runs())) == NO_CELL
    with pytest.raises(DataError, match=f"effect {EFFECT} of 'rod' reads as {' and '.join(lost)}; record also chamber"):
        add(rod(), [EFFECT], [runs()[0]], [blind(runs()[1], *lost)])


def test_leaks_of_chambers_that_the_machine_lacks_are_not_offered() -> None:
    offered = missing(rod(), measured_inputs(runs()))
    assert not {"cross_piston_leakage", "line_delay", "pressure_sensor_offset", "dead_volume"} & set(offered)


@pytest.mark.parametrize(("lost", "conditions"), [((), 5), (("p_a", "p_b"), 3)])
def test_laws_may_bend_with_the_pressures_that_are_recorded(lost: tuple[str, ...], conditions: int) -> None:
    """A seal's friction grows less than in proportion: what is left over must not pass for another effect."""
    train, *_, held = (blind(run, *lost) for run in runs())
    fitter = Fitter(rod(), [train], [held])
    assert [seen.shape[1] for seen in fitter.conditions] == [2 * conditions] * 2
    if not lost:
        middle = train.sampled(("U", "p_a"))[np.round(fitter.train.time * 1e3).astype(int), 1]
        assert np.corrcoef(fitter.conditions[0][:, 2], middle)[0, 1] == pytest.approx(1.0)


@lru_cache(maxsize=1)
def added() -> Adding:
    """It, added by name."""
    *train, held = runs()
    return add(rod(), [EFFECT], train, [held])


@pytest.mark.check
def test_added_by_name_it_has_its_coefficient_and_pays() -> None:
    found = added()
    own = found.estimates[f"{EFFECT}.coefficient"]
    assert own.value == pytest.approx(RISE, rel=0.03)
    assert own.determined
    _, before, after = found.errors
    assert after < 0.2 * before


@lru_cache(maxsize=1)
def diagnosed() -> Outcome:
    *train, held = runs()
    return diagnose(rod(), train, [held])


@pytest.mark.check
def test_a_diagnosis_finds_it_and_nothing_else() -> None:
    found = diagnosed()
    assert [one.effect for one in found.added] == [EFFECT]
    assert found.added[0].parameters["coefficient"].value == pytest.approx(RISE, rel=0.03)
    assert found.added[0].holdout_error_after < 0.2 * found.added[0].holdout_error_before
