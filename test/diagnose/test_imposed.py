"""A gas spring on a test machine that imposes its motion: sealed chambers are judged, driven and predicted alone."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from identify.making import recording

from pneumo_ros.compare.compare import compare
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.screening import screen
from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.runs.inputs import check_inputs, judged
from pneumo_ros.runs.run import ATMOSPHERE, PARTS, Run, make_run

SAMPLE, FINE = 0.01, 20  # s; steps of the truth in a sample
AREA, VOLUME = (4.1e-4, 3.0e-4), (5.1e-4, 4.0e-4)
GAMMA, ROOM, CONSTANT = 1.4, 293.0, 287.0


def machine() -> Model:
    """Two sealed chambers, moved by the test machine."""
    values = {
        "piston.mass": 5.0, "piston.area_a": AREA[0], "piston.area_b": AREA[1], "piston.stroke": 2.0,
        "air.supply_pressure": 1e5, "air.atmospheric_pressure": 1e5, "air.gas_constant": CONSTANT,
        "air.temperature": ROOM, "air.heat_capacity_ratio": GAMMA,
        "chambers.volume_a": VOLUME[0], "chambers.volume_b": VOLUME[1],
    }  # fmt: skip
    return Model.build(["imposed_motion"], values, name="spring")


def gas(volume: np.ndarray, start: float, rate: float) -> np.ndarray:
    """Pressure along volumes FINE steps a sample: first law with heat to walls of room temperature, rate [1/s]."""
    step, mass = SAMPLE / FINE, start * volume[0] / (CONSTANT * ROOM)
    warm, pressure = ROOM, np.empty(len(volume))
    for k in range(len(volume)):
        pressure[k] = mass * CONSTANT * warm / volume[k]
        if k + 1 < len(volume):
            work = (GAMMA - 1.0) * warm * np.log(volume[k] / volume[k + 1])
            warm += work + step * rate * (ROOM - warm)
    return pressure[::FINE]


@lru_cache(maxsize=4)
def run(seed: int, rate: float, seconds: float = 60.0) -> Run:
    """Sines of several periods, and the pressures of both chambers; sensors of 20 um and 100 Pa."""
    rng, n = np.random.default_rng(seed), round(seconds / SAMPLE)
    t = np.arange(n * FINE + 1) * SAMPLE / FINE
    y = 0.2 * sum(np.sin(2.0 * np.pi * t / period + rng.uniform(0.0, 6.0)) for period in (3.0, 7.0, 19.0))
    a = gas(VOLUME[0] + AREA[0] * y, 5e5, rate) + 100.0 * rng.standard_normal(n + 1)
    b = gas(VOLUME[1] - AREA[1] * y, 4e5, rate) + 100.0 * rng.standard_normal(n + 1)
    position = y[::FINE] + 2e-5 * rng.standard_normal(n + 1)
    held = np.repeat(np.diff(position) / SAMPLE, PARTS)
    return Run(
        f"spring_{seed}", SAMPLE, position, a, b, np.zeros(len(held)), np.ones(n + 1, dtype=bool), False,
        {"imposed_velocity": held}, imposed=True,
    )  # fmt: skip


def test_the_motion_is_that_of_the_test_machine() -> None:
    model, one = machine(), run(1, 0.0)
    held = one.inputs(model.inputs)
    start = model.state(y=one.position[0], v=held[0, 1], p_a=5e5, p_b=4e5)
    states = model.simulate(held, start, sample_time=SAMPLE, parts=PARTS)
    assert np.abs(states[:, 0] - one.position[1:]).max() < 2e-4
    law = states[:, 2] * (VOLUME[0] + AREA[0] * states[:, 0]) ** GAMMA
    assert np.ptp(law) < 1e-5 * law.mean()


def test_pressures_are_predicted_and_forces_are_not_judged() -> None:
    found = compare(machine(), [run(1, 0.0)])
    assert set(found.equations) == {"chamber_a", "chamber_b"}
    assert all(one.explained_by_noise for one in found.equations.values())
    assert set(found.runs[0].error) == {"pressure_a_pa", "pressure_b_pa"}
    assert all(one.typical < 1.3 for one in found.runs[0].error.values())


def test_heat_to_the_walls_fails_both_chambers() -> None:
    found = compare(machine(), [run(1, 0.5)])
    assert not any(one.explained_by_noise for one in found.equations.values())
    assert all(one.typical > 5.0 for one in found.runs[0].error.values())


@pytest.mark.check
def test_heat_exchange_is_found() -> None:
    found = diagnose(machine(), [run(1, 0.5), run(2, 0.5)], [run(3, 0.5)])
    assert [one.effect for one in found.added] == ["heat_exchange"]
    assert found.added[0].parameters["rate"].value == pytest.approx(0.5, rel=0.05)
    assert found.waterfall[-1][1] < 1.5 < 5.0 < found.waterfall[0][1]


def rig(seed: int, viscous: float) -> Run:
    """A friction rig: a motion that is imposed, and the force that it takes, of Coulomb and viscous friction."""
    rng, step = np.random.default_rng(seed), 2e-3
    t = step * np.arange(6001)
    y = 0.1 * np.sin(2.0 * np.pi * t / 3.0) + 0.02 * np.sin(2.0 * np.pi * t / 0.9 + seed)
    v = np.gradient(y, step)
    force = FRICTION["piston.mass"] * np.gradient(v, step) + 20.0 * np.tanh(v / 1e-3) + viscous * v
    force = np.interp(np.arange(6000 * PARTS) / PARTS, np.arange(6001), force + 0.3 * rng.standard_normal(len(t)))
    position = y + 1e-7 * rng.standard_normal(len(t))
    return Run(f"rig_{seed}", step, position, None, None, force, np.ones(len(t), dtype=bool), True, imposed=True)


FRICTION = {
    "piston.mass": 4.0, "piston.area_a": 4e-4, "piston.area_b": 4e-4, "piston.stroke": 0.3,
    "lugre_friction.static_friction": 20.0, "lugre_friction.coulomb_friction": 20.0,
    "lugre_friction.stribeck_velocity": 0.01, "lugre_friction.bristle_stiffness": 1e6,
    "lugre_friction.bristle_damping": 50.0, "lugre_friction.breakaway_ratio": 0.9,
}  # fmt: skip


def test_the_force_of_an_imposed_motion_is_predicted_and_its_position_is_not() -> None:
    model = Model.build(["lugre_friction"], FRICTION, name="rig", frame=("piston",))
    fits, fails = compare(model, [rig(1, 0.0)]), compare(model, [rig(1, 100.0)])
    assert set(fits.runs[0].error) == {"force_n"}
    assert fits.equations["momentum"].explained_by_noise
    assert fits.runs[0].error["force_n"].typical < 6.0  # reversals of the bristle are not those of tanh
    assert not fails.equations["momentum"].explained_by_noise
    speed = np.gradient(rig(1, 0.0).position, 2e-3)
    assert fails.runs[0].error["force_n"].rms == pytest.approx(100.0 * speed.std(), rel=0.1)


def sealed(name: str, pressure: float, speed: float) -> Run:
    """A seal rig at one pressure, which one sensor measures; the seal's friction rises with it."""
    rng, time = np.random.default_rng(1), 2e-3 * np.arange(4001)
    position = speed / 3.0 * np.sin(3.0 * time) + 2e-6 * rng.standard_normal(len(time))
    v = speed * np.cos(3.0 * time)
    friction = (20.0 + RISE * (pressure - ATMOSPHERE)) * np.tanh(v / 1e-3)
    cell = friction - FRICTION["piston.mass"] * 3.0 * speed * np.sin(3.0 * time) + 0.3 * rng.standard_normal(len(time))
    whole = recording(
        name=name, time=time, position=position, pressure_a=np.full(len(time), pressure), pressure_b=None,
        load_cell=cell, effort=None, description={"map": {"motion": "imposed"}},
    )  # fmt: skip
    return make_run(whole, force_driven=True)


RISE = 7e-5  # N/Pa
SEAL_RUNS = ((1e5, 0.03), (3e5, 0.1), (5e5, 0.06), (7e5, 0.1))


def test_friction_of_a_seal_rig_follows_the_pressure_of_its_one_sensor() -> None:
    """And not the force that is predicted: an effect of the drive would follow from itself."""
    model = Model.build(["lugre_friction"], FRICTION, name="rig", frame=("piston",))
    *train, held = (sealed(f"seal_{k}", *one) for k, one in enumerate(SEAL_RUNS))
    fitter = Fitter(model, train, [held])
    assert "load_dependent_friction" not in fitter.lacking
    best = screen(fitter.ranking_fit(fitter.refit(model)))[0]
    assert best.name == "pressure_dependent_friction"
    assert best.values["pressure_dependent_friction.coefficient"] == pytest.approx(RISE, rel=0.1)
    said = judged(model, train)
    assert "chamber b is taken at the other's pressure; chamber_b/pressure would show it" in said
    assert "load_cell" not in said


def test_an_effect_of_the_drive_is_refused_where_the_drive_is_predicted() -> None:
    model = Model.build(
        ["lugre_friction", "load_dependent_friction"], FRICTION, name="rig", frame=("piston",), defaults=True
    )
    with pytest.raises(DataError, match=r"load_dependent_friction of 'rig' reads that force as its drive.*leave"):
        check_inputs(model, rig(1, 0.0))
    free = replace(rig(1, 0.0), imposed=False)
    check_inputs(model, free)
    plain = Model.build(["lugre_friction"], FRICTION, frame=("piston",))
    assert "load_dependent_friction" in Fitter(plain, [free]).lacking


def test_what_an_imposed_force_lacks_follows_pressure_and_not_itself() -> None:
    model = Model.build(["lugre_friction"], FRICTION, name="rig", frame=("piston",))
    found = compare(model, [sealed(f"seal_{k}", *one) for k, one in enumerate(SEAL_RUNS)])
    assert "force" not in found.dependences["momentum"]
    assert "pressure_a" in found.dependences["momentum"]
