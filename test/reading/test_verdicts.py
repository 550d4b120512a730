"""Unfit recordings get a verdict of their own when they are read, with what to type."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from reading.motions import MODEL, TIME, N, both, regulated, sealed, vented, without

from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.read import judged_part, run_of
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import corrected

ATM = MODEL["air.atmospheric_pressure"]


def noisy(value: float) -> np.ndarray:
    return value + np.random.default_rng(4).normal(0.0, 300.0, N)


def scaled(whole: Recording, factor: float = 1.0, below: float = 0.0, only: str = "ab") -> Recording:
    """Pressures in another unit, or over `below` [Pa]."""
    changed = {f"pressure_{c}": (getattr(whole, f"pressure_{c}") - below) * factor for c in only}
    return replace(whole, **changed)


UNFIT: dict[str, tuple[Callable[[], Recording], tuple[str, ...]]] = {
    "vented": (vented, ("chamber b is vented", "the atmosphere's", "no-command", "no-pressure-b")),
    "vented, gauge": (
        lambda: scaled(vented(), below=ATM),
        ("chamber b is vented, and the pressures are gauge", "--read-as gauge,no-command", "gauge,no-pressure-b"),
    ),
    "vented, bar": (lambda: scaled(vented(), 1e-5), ("as it would be in bar", "type --read-as bar")),
    "steady": (regulated, ("chamber b is held at one pressure", "stays at 220 kPa", "type --read-as no-command")),
    "steady, bar": (lambda: scaled(regulated(), 1e-5), ("as it would be in bar", "type --read-as bar")),
    "steady, gauge": (
        lambda: scaled(regulated(), below=ATM, only="b"), ("chamber b is held at one pressure", "stays at 120 kPa")
    ),
    "dead": (
        lambda: replace(both(), pressure_b=noisy(2.3e5)),
        ("chamber_b/pressure stays at 2", "its sensor is dead or not connected; look", "--read-as no-pressure-b"),
    ),
    "dead at the atmosphere's pressure": (
        lambda: replace(both(), pressure_b=noisy(ATM)), ("its sensor is dead or not connected; look",)
    ),
    "no signal": (
        lambda: replace(both(), pressure_b=noisy(0.0)), ("its sensor gives no signal", "--read-as no-pressure-b")
    ),
    "negated": (
        lambda: replace(both(), pressure_a=-both().pressure_a), ("it counts the wrong way; change its sign",)
    ),
    "centimetres": (lambda: replace(both(), position=1e2 * both().position), ("type --read-as cm: of mm and cm",)),
    "swapped": (
        lambda: replace(both(), pressure_a=both().pressure_b, pressure_b=both().pressure_a),
        ("seem to be exchanged", "--read-as swapped-chambers"),
    ),
    "swapped, no command": (
        lambda: without(replace(both(), pressure_a=both().pressure_b, pressure_b=both().pressure_a), "voltage"),
        ("seem to be exchanged", "--read-as swapped-chambers"),
    ),
    "backwards, no command": (
        lambda: without(replace(both(), position=-both().position), "voltage"),
        ("the position seems to count the wrong way", "--read-as reversed-position"),
    ),
    "sealed": (sealed, ("the motion was imposed, it seems", "Type --imposed", "imposed_motion")),
}  # fmt: skip


@pytest.mark.parametrize("name", UNFIT)
def test_each_fault_has_its_verdict(name: str) -> None:
    make, words = UNFIT[name]
    with pytest.raises(DataError) as caught:
        run_of(make(), MODEL, mechanics=True)
    assert [word for word in words if word not in str(caught.value)] == [], str(caught.value)


ADVICE = {
    "vented, gauge": (("gauge", "no-command"), ("gauge", "no-pressure-b")),
    "vented": (("no-command",), ("no-pressure-b",)),
    "steady": (("no-command",), ("no-pressure-b",)),
    "dead": (("no-pressure-b",),),
    "no signal": (("no-pressure-b",),),
    "centimetres": (("cm",),),
}


@pytest.mark.parametrize(("name", "words"), [(name, words) for name, own in ADVICE.items() for words in own])
def test_what_is_advised_helps(name: str, words: tuple[str, ...]) -> None:
    recording = corrected(UNFIT[name][0](), words, ATM)
    _, notes = run_of(recording, MODEL, mechanics=True)
    assert notes == []


@pytest.mark.parametrize(
    ("hidden", "values"),
    [
        ("viscous_friction", {"viscous_friction.coefficient": 200.0}),
        ("pressure_dependent_friction", {}),
        ("position_dependent_friction", {}),  # large beside the piston's own: it may be either
    ],
)
def test_a_wrong_machine_file_is_no_dead_sensor(hidden: str, values: dict[str, float]) -> None:
    """Friction that the file does not know, and a fifth of the rest wrong."""
    wrong = MODEL.with_effects([*MODEL.effects, hidden], values)
    rough = wrong.with_parameters({"lugre_friction.coulomb_friction": 56.0, "piston.mass": 6.0})
    with pytest.raises(DataError, match=r"chamber b is vented|or the chamber is vented"):
        run_of(vented(), rough, mechanics=True)


def test_a_supply_on_a_gauge_is_not_used_and_named() -> None:
    recording = replace(both(), supply_pressure=noisy(MODEL["air.supply_pressure"] - ATM))
    run, (note,) = run_of(recording, MODEL)
    assert "its supply pressure is not used" in note
    assert "type --read-as gauge-supply" in note
    assert "measured_supply" not in run.further
    right, notes = run_of(corrected(recording, ("gauge-supply",), ATM), MODEL)
    assert notes == []
    assert right.further["measured_supply"].mean() == pytest.approx(MODEL["air.supply_pressure"], rel=1e-3)


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (1.0, None),
        (-1.0, "counts the other way than the position"),
        (1e3, "is in mm/s, it seems"),
        (-100.0, "counts the other way than the position, in cm/s"),
    ],
)
def test_a_velocity_that_does_not_fit_is_named(factor: float, words: str | None) -> None:
    velocity = factor * np.gradient(both().position, TIME)
    smooth = np.convolve(velocity, np.ones(25) / 25.0, "same")
    _, notes = run_of(replace(both(), velocity=smooth), MODEL)
    assert len(notes) == (words is not None)
    assert all(words in note for note in notes if words)


def driven(force: np.ndarray, y: np.ndarray) -> Recording:
    """A force-driven recording."""
    return replace(without(both(), "voltage", "pressure_a", "pressure_b"), position=y, effort=force)


@pytest.fixture(scope="module")
def emps() -> tuple[Model, np.ndarray, np.ndarray]:
    """A force-driven machine, the force and the measured position."""
    model = load_model("emps")
    force = 60.0 * np.sin(2.0 * np.pi * 0.5 * TIME)
    states = np.vstack([model.state(), model.simulate(force[:-1], model.state())])
    return model, force, states[:, 0] + np.random.default_rng(5).normal(0.0, 5e-6, N)


def test_a_force_in_kilonewtons_is_named(emps: tuple[Model, np.ndarray, np.ndarray]) -> None:
    model, force, y = emps
    assert run_of(driven(force, y), model)[1] == []
    with pytest.raises(DataError, match=r"the force seems to be in kN, not in N.*Type --read-as kN"):
        run_of(driven(1e-3 * force, y), model)
    with pytest.raises(DataError, match="reversed-position, or --read-as reversed-force if it is the force"):
        run_of(driven(-force, y), model)


def test_a_force_that_leads_elsewhere_may_be_of_an_imposed_motion(emps: tuple[Model, np.ndarray, np.ndarray]) -> None:
    """A friction rig: 2 mm to and fro, and a load cell whose zero is 40 N off, taken for the driving force."""
    model = emps[0]
    y = 2e-3 * np.sin(2.0 * np.pi * 1.0 * TIME)
    force = 20.0 * np.sign(np.cos(2.0 * np.pi * TIME)) + 40.0
    _, notes = run_of(driven(force, y), model)
    assert any("if a test machine imposed the motion, type --imposed" in note for note in notes)


def test_what_a_recording_judges_depends_on_what_was_measured() -> None:
    whole = both()
    assert judged_part(whole, MODEL) is MODEL
    assert judged_part(without(whole, "voltage"), MODEL).force_driven
    assert judged_part(without(whole, "voltage", "pressure_b"), MODEL).force_driven
    forced = judged_part(replace(without(whole, "voltage"), effort=whole.position), MODEL)
    assert forced.force_driven
    assert "rod_atmospheric_force" not in forced.effects, "a measured force has it in it"
    assert "rod_atmospheric_force" in judged_part(without(whole, "voltage"), MODEL).effects
    for lost in ("pressure_a", "pressure_b"):
        alone = judged_part(without(whole, lost), MODEL)
        assert alone.imposed
        assert "lugre_friction" not in alone.effects
        run, notes = run_of(without(whole, lost), MODEL, mechanics=True)
        assert notes == []
        assert run.assumed == {f"{lost}_pa"}
        assert {*run.judged} == {"pressure_a_pa", "pressure_b_pa"} - run.assumed
