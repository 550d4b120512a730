"""Measured inputs of a force-driven run: laid on the grid, kept through cuts and shifts, asked for by models."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from identify.making import recording

from pneumo_ros.diagnose.mechanics import driven_by_pressures
from pneumo_ros.diagnose.stretches import stretch
from pneumo_ros.diagnose.timing import later
from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model
from pneumo_ros.plant.mechanical import mechanical, whole
from pneumo_ros.reading.read import ReadOptions, checked_run, read_run
from pneumo_ros.records import Recording, write_recording
from pneumo_ros.runs.inputs import check_inputs, judged, measured_inputs, measuring
from pneumo_ros.runs.run import ATMOSPHERE, PARTS, Run, make_run

N = 3000
TIME = np.arange(N) * 1e-3
EMPS = load_model("emps")
SEALED = EMPS.with_effects([*EMPS.effects, "pressure_dependent_friction"])
NAMES = ("U", "p_a", "p_b")


def force_driven(**changes: object) -> Recording:
    """A piston pushed to and fro, with both pressures."""
    signals: dict[str, object] = {
        "time": TIME, "position": 0.1 * np.sin(2.0 * TIME), "effort": 90.0 * np.cos(2.0 * TIME),
        "pressure_a": 4e5 + 1e5 * np.sin(3.0 * TIME), "pressure_b": 3e5 - 1e5 * np.cos(3.0 * TIME),
    }  # fmt: skip
    return recording(**(signals | changes))


def test_inputs_stand_side_by_side_in_the_order_asked_for() -> None:
    run = make_run(force_driven())
    held = run.inputs(NAMES)
    middle = (np.arange((N - 1) * PARTS) + 0.5) / PARTS * 1e-3
    assert held.shape == ((N - 1) * PARTS, 3)
    assert held.flags.c_contiguous
    assert np.array_equal(held[:, 0], run.input)
    assert held[:, 1] == pytest.approx(4e5 + 1e5 * np.sin(3.0 * middle), abs=1.0)
    assert held[:, 2] == pytest.approx(3e5 - 1e5 * np.cos(3.0 * middle), abs=1.0)
    assert np.array_equal(run.inputs(("U", "p_b", "p_a")), held[:, [0, 2, 1]])
    assert np.array_equal(run.inputs(("U",)), run.input[:, None])


def test_from_each_sample_on_their_mean_until_the_next() -> None:
    run = make_run(force_driven())
    sampled = run.sampled(NAMES)
    assert sampled.shape == (N, 3)
    assert sampled[:-1, 0] == pytest.approx(run.held, rel=1e-12)
    assert sampled[7, 1] == pytest.approx(run.inputs(NAMES)[70:80, 1].mean(), rel=1e-12)
    assert np.array_equal(sampled[-1], sampled[-2])


def test_they_are_cut_and_put_off_with_the_force() -> None:
    run = make_run(force_driven())
    part = stretch(run, 1.0, 2.0)
    assert np.array_equal(part.inputs(NAMES), run.inputs(NAMES)[1000 * PARTS : 2000 * PARTS])
    put_off = later(run, 0.5e-3)
    assert np.array_equal(put_off.inputs(NAMES)[5:], run.inputs(NAMES)[:-5])
    assert np.array_equal(replace(run, name="other").inputs(NAMES), run.inputs(NAMES))


def test_a_recording_without_a_pressure_says_which_sensor_the_model_needs() -> None:
    run = make_run(force_driven(pressure_b=None))
    assert measured_inputs([run]) == ("U", "p_a")
    assert measured_inputs([run, make_run(force_driven())]) == ("U", "p_a")
    check_inputs(EMPS, run)
    with pytest.raises(DataError, match="has no chamber_b/pressure, which the model reads as p_b; record it"):
        run.inputs(NAMES)
    wanted = "has no chamber_b/pressure, which effect pressure_dependent_friction of 'emps' reads as p_b; record also"
    with pytest.raises(DataError, match=wanted):
        check_inputs(SEALED, run)
    with pytest.raises(DataError, match=wanted):
        checked_run(force_driven(pressure_b=None), SEALED)


def test_gauge_pressures_are_not_used_or_refused() -> None:
    low = force_driven(pressure_a=3.0 + np.sin(TIME), pressure_b=2.0 + np.cos(TIME))
    run, notes = checked_run(low, EMPS)
    assert run.further == {}
    assert "its pressures are not used, and no effect of them is tried" in notes[0]
    assert "--read-as bar" in notes[0]
    with pytest.raises(DataError, match="--read-as bar"):
        checked_run(low, SEALED)


def test_pressures_may_be_constant_where_a_force_moves_the_piston() -> None:
    run, notes = checked_run(force_driven(pressure_a=np.full(N, 5e5), pressure_b=np.full(N, 1e5)), SEALED)
    assert not notes
    assert (run.inputs(NAMES)[:, 1:] == [5e5, 1e5]).all()


def test_pressures_alone_push_the_piston() -> None:
    run, _ = checked_run(force_driven(effort=None), SEALED)
    inputs = run.inputs(NAMES)
    areas = SEALED["piston.area_a"], SEALED["piston.area_b"]
    assert inputs[:, 0] == pytest.approx(areas[0] * inputs[:, 1] - areas[1] * inputs[:, 2], rel=1e-9)
    with pytest.raises(DataError, match="has no effort and no chamber pressure"):
        checked_run(force_driven(effort=None, pressure_a=None, pressure_b=None), SEALED)


def test_without_its_sensor_the_other_side_is_the_atmosphere() -> None:
    run, _ = checked_run(force_driven(effort=None, pressure_b=None), EMPS)
    inputs = run.inputs(("U", "p_a"))
    thrust = EMPS["piston.area_a"] * inputs[:, 1] - EMPS["piston.area_b"] * ATMOSPHERE
    assert inputs[:, 0] == pytest.approx(thrust, rel=1e-9)
    said = judged(measuring(EMPS, [run]), [run])
    assert said.startswith("Judged: momentum (the other side is taken at the atmosphere's pressure; chamber_b/pressure")


def test_a_load_cell_is_an_input_where_it_is_not_the_force_that_is_predicted() -> None:
    cell = 30.0 * np.sin(5.0 * TIME)
    run = make_run(force_driven(load_cell=cell))
    assert run.inputs(("U", "load_force"))[5::PARTS, 1] == pytest.approx(cell[:-1], abs=0.1)
    imposed = force_driven(load_cell=cell, effort=None, description={"map": {"motion": "imposed"}})
    assert "load_force" not in make_run(imposed, force_driven=True).further


def test_pressures_of_oil_are_taken_where_they_drive() -> None:
    oil = {"pressure_a": 8e6 + 4e6 * np.sin(3.0 * TIME), "pressure_b": 6e6 - 4e6 * np.cos(3.0 * TIME)}
    run, notes = checked_run(force_driven(effort=None, **oil), EMPS)
    assert not notes
    assert run.further["p_a"].max() == pytest.approx(12e6, rel=1e-3)
    with pytest.raises(DataError, match="more than a hydraulic one has"):
        checked_run(force_driven(effort=None, pressure_a=np.full(N, 2e8), pressure_b=oil["pressure_b"]), EMPS)


def test_a_bag_without_a_valve_command_judges_the_mechanics_alone(tmp_path: Path) -> None:
    signals = force_driven()
    path = tmp_path / "cylinder"
    write_recording(
        path, time=TIME, position=signals.position, pressure_a=signals.pressure_a, pressure_b=signals.pressure_b
    )
    axis = load_model("axis")
    with pytest.raises(DataError, match="no valve command"):
        read_run(path, axis)
    run = read_run(path, axis, ReadOptions(mechanics=True)).run
    judged = measuring(axis, [run])
    assert judged.force_driven
    assert set(judged.effects) < set(axis.effects)
    commanded = replace(run, name="valve", force_driven=False)
    with pytest.raises(DataError, match="cylinder has no valve command, valve has one"):
        measuring(axis, [run, commanded])


def test_what_was_found_in_the_mechanics_goes_back_into_the_machine() -> None:
    axis = load_model("axis")
    part = mechanical(axis)
    assert part is not None
    slower = part.with_effects([*part.effects, "asymmetric_viscous_friction"]).with_parameters({"piston.mass": 7.0})
    again = whole(axis, slower)
    assert again.effects == (*axis.effects, "asymmetric_viscous_friction")
    assert again["piston.mass"] == 7.0
    chambers = {k: v for k, v in axis.parameters.items() if k.startswith("chambers.")}
    assert chambers.items() <= again.parameters.items()
    assert whole(EMPS, EMPS) is EMPS


def test_the_mechanics_of_a_machine_with_chambers_read_its_pressures() -> None:
    axis = load_model("axis")
    model = mechanical(axis.with_effects([*axis.effects, "pressure_dependent_friction"]))
    assert model is not None
    assert model.inputs == NAMES
    p_a, p_b = 4e5 + 1e5 * np.sin(3.0 * TIME), 3e5 - 1e5 * np.cos(3.0 * TIME)
    held = np.zeros((N - 1) * PARTS)
    run = Run("axis", 1e-3, 0.1 * np.sin(TIME), p_a, p_b, held, np.ones(N, dtype=bool), False)
    inputs = driven_by_pressures(axis, run).inputs(model.inputs)
    assert inputs[:, 0] == pytest.approx(4.1e-4 * inputs[:, 1] - 3e-4 * inputs[:, 2], rel=1e-9)
    assert inputs[::PARTS, 1] == pytest.approx(p_a[:-1], abs=200.0)


def test_one_line_says_what_is_judged_and_which_sensor_would_add_the_rest() -> None:
    import pneumo_ros as pn
    from pneumo_ros.reading.read import run_of
    from pneumo_ros.runs.inputs import judged

    axis = pn.load_model("axis")
    recording = pn.simulate(axis, "sine:3,1", seconds=1)
    said = judged(axis, [run_of(recording, axis)[0]])
    assert said.startswith("Judged: momentum, chamber a, chamber b. Not judged: ")
    assert "supply/pressure would add it" in said
    assert "a load_cell would add it" in said
    emps = pn.load_model("emps")
    driven = pn.simulate(emps, "sine:100,1", seconds=1)
    said = judged(emps, [run_of(driven, emps)[0]])
    assert said.startswith("Judged: momentum. Not judged: chambers and valve (valve/command and both chamber pressures")
