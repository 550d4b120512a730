"""Recording mistakes that the model finds in a run; no hidden effect of a machine is mistaken for one."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from identify.making import own, rig
from test_rig_recordings import RECORDED

from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.plausible import check_run
from pneumo_ros.records import read_recording
from pneumo_ros.runs.run import Run, make_run

# Of all effects the rig can hide, with five kinds of runs each, those most similar to one of the mistakes, or that make
# the piston wait longest
NEAREST = [
    ("valve_null_offset", 0.3, "train_slow"),
    ("constant_load", 50.0, "train_slow"),
    ("pressure_sensor_offset", -2e4, "train_steps"),
    ("pressure_sensor_offset", 2e4, "train_slow"),
    ("choked_flow", 4e-9, "train_sweep"),
    ("heat_exchange", 0.1, "train_slow"),
    ("supply_pressure_droop", 1e5, "train_creep"),
    ("pressure_dependent_friction", 1e-4, "train_creep"),
    ("cross_piston_leakage:gap", 1e-9, "train_slow"),
    ("spring_load", 1000.0, "constant_p1100"),
]


@pytest.mark.parametrize(
    ("effect", "size", "name"),
    [pytest.param(*one, marks=pytest.mark.check if k % 2 else ()) for k, one in enumerate(NEAREST)],
)
def test_a_hidden_effect_is_no_mistake(effect: str, size: float, name: str) -> None:
    assert check_run(load_model(), rig(name, effect=effect, size=size)[2]) == []


def test_a_better_fit_of_one_equation_proves_nothing() -> None:
    """Friction that a mistake explains by chance, while it worsens the equation of a chamber."""
    assert check_run(load_model(), rig("constant_m0830", 1, "pressure_dependent_friction:lips")[2]) == []


@pytest.mark.parametrize("effect", ["", "spring_load"])
def test_a_piston_that_never_moves_is_said_to_once(effect: str) -> None:
    """A closed valve or a holding spring is no mistake, but the run is useless for identification."""
    (note,) = check_run(load_model(), rig("constant_p0785", 7, effect)[2])
    assert note.startswith("the piston does not move: its position stays at -0.")


@pytest.mark.check
def test_no_recording_of_the_rig_alarms() -> None:
    """Neither the shared recordings, if present, nor those of the driven machine."""
    folders = sorted(path for path in RECORDED.parent.glob("*/*") if (path / "metadata.yaml").exists())
    for path in folders:
        assert notes(path) == [], path
    assert notes_of(own("steps")[2]) == []


def notes(path: Path) -> list[str]:
    """All notes about a recording."""
    recording = read_recording(path)
    run = make_run(recording)
    return [*recording.warnings, *check_run(load_model("emps" if run.force_driven else "axis"), run)]


def notes_of(run: Run) -> list[str]:
    """The default machine's notes about a run."""
    return check_run(load_model(), run)


def swapped(run: Run) -> Run:
    return replace(run, pressure_a=run.pressure_b, pressure_b=run.pressure_a)


def gauge(run: Run) -> Run:
    assert run.pressure_a is not None
    assert run.pressure_b is not None
    return replace(run, pressure_a=run.pressure_a - 1e5, pressure_b=run.pressure_b - 1e5)


MISTAKES = {
    "swapped-chambers": swapped,
    "gauge": gauge,
    "reversed-position": lambda run: replace(run, position=-run.position),
    "reversed-voltage": lambda run: replace(run, input=-run.input),
}


@pytest.mark.parametrize("word", MISTAKES)
@pytest.mark.parametrize("name", ["train_slow", "constant_p1100"])
@pytest.mark.parametrize("effect", ["", "cross_piston_leakage"])
def test_a_mistake_is_found_with_and_without_a_hidden_effect(word: str, name: str, effect: str) -> None:
    run = MISTAKES[word](rig(name, effect=effect, size=5e-10 if effect else None)[2])
    with pytest.raises(DataError, match=f"Type --read-as {word}, or") as caught:
        check_run(load_model(), run)
    assert "N (momentum)" in str(caught.value)


def test_gauge_pressures_that_never_fall_low_are_found_by_the_model() -> None:
    """Both chambers stay above 2 bar, so no single reading shows it."""
    model, run = tense()
    assert min(run.pressure_a.min(), run.pressure_b.min()) > 2.0e5
    assert check_run(model, run) == []
    with pytest.raises(DataError, match="seem to be gauge pressures"):
        check_run(model, gauge(run))


@lru_cache(maxsize=1)
def tense() -> tuple[Model, Run]:
    """Short strokes between two full chambers."""
    model, rng = load_model(), np.random.default_rng(0)
    volts = np.repeat(np.tile([2.0, -1.7], 10), 4000)  # 0.4 s each, in tenths of samples
    states = np.vstack([start := model.state(p_a=4.5e5, p_b=6e5), model.simulate(volts, start, parts=10)])
    y = states[:, 0] + rng.normal(0.0, 5e-6, len(states))
    a, b = (states[:, k] + rng.normal(0.0, 300.0, len(states)) for k in (2, 3))
    return model, Run("tense", 1e-3, y, a, b, volts, np.ones(len(y), dtype=bool), False)


def test_a_driven_machine_whose_position_counts_backwards() -> None:
    model = load_model("emps")
    volts = 60.0 * np.sin(2.0 * np.pi * 0.5 * np.arange(40_000) * 1e-4)
    states = np.vstack([model.state(), model.simulate(volts, model.state(), parts=10)])
    run = Run("pushed", 1e-3, states[:, 0], None, None, volts, np.ones(len(states), dtype=bool), True)
    assert check_run(model, run) == []
    with pytest.raises(DataError, match="--read-as reversed-position"):
        check_run(model, replace(run, position=-run.position))


def test_a_piston_against_the_end_stop_is_not_stuck() -> None:
    model = load_model()
    volts = np.full(15_000, 3.0)
    states = np.vstack([start := model.state(y=0.9), model.simulate(volts, start)])
    run = Run("end", 1e-3, *states[:, [0, 2, 3]].T, np.repeat(volts, 10), np.ones(len(states), dtype=bool), False)
    assert check_run(model, run) == []
    held = replace(run, position=run.position - 0.3)
    assert any("does not move for" in note and "N push it" in note for note in check_run(model, held))


@pytest.mark.parametrize("samples", [50, 60, 200])
def test_short_runs_are_judged_as_far_as_they_go(samples: int) -> None:
    model, _, run = own("steps")
    part = replace(
        run, position=run.position[:samples], pressure_a=run.pressure_a[:samples], pressure_b=run.pressure_b[:samples],
        input=run.input[: 10 * (samples - 1)], measured=run.measured[:samples],
    )  # fmt: skip
    check_run(model, part)


def test_commands_about_another_closed_signal_are_named_with_the_word_that_mends_it() -> None:
    """A valve of 0 to 10 V: taken as it is, its recording once gave a confident diagnosis of backlash and lag."""
    run = rig("train_steps")[2]
    with pytest.raises(DataError, match="the valve seems to be closed at 5 V, not at 0 V") as caught:
        check_run(load_model(), replace(run, input=run.input + 5.0))
    assert "Type --read-as closed=5V, or add valve_null_offset" in str(caught.value)
