"""Machines with on/off valves and regulators are identified from any motion."""

from dataclasses import replace

import numpy as np
import pytest
from identify.jogging import SHEETS, jogged, sheet, true_and_seen, truth
from plant.catalogue import AXIS

from pneumo_ros.identify import by_motion
from pneumo_ros.identify.by_motion import fit_by_motion, needs_motion, parameters_of
from pneumo_ros.identify.campaign import FRICTION, identify
from pneumo_ros.identify.summary import summary

FOUND = {  # share of the truth by which a parameter may be off; 38 N of friction are 35 +- 39 N by the data sheet
    "chambers.volume_a": 5e-3, "choked_flow.conductance_filling": 0.01, "lugre_friction.static_friction": 0.05,
    "lugre_friction.coulomb_friction": 0.02,
}  # fmt: skip
OWN = {
    "pulses": {"on_off_valves.switch_on": 0.02, "on_off_valves.switch_off": 0.02},
    "regulators": {"pressure_regulator.angular_frequency": 0.01, "pressure_regulator.band": 0.05},
}


def test_which_machines_need_it() -> None:
    assert needs_motion(sheet("pulses"))
    assert needs_motion(sheet("regulators"))
    assert not needs_motion(AXIS.with_effects([*AXIS.effects, "valve_spool_dynamics"]))
    names = parameters_of(sheet("pulses"), FRICTION)
    assert {*FOUND, *OWN["pulses"]} <= {*names}
    assert "arctan_flow.filling_coefficient" not in names, "it has no influence beside choked_flow"
    assert "on_off_valves.pulse_frequency" not in names, "chosen by the builder"


def test_regulators_from_three_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few segments, and only what they tell in a short test: friction and flow."""
    model = sheet("regulators")
    real, known = truth(model), {name: model.uncertainty[name] for name in FOUND if name in model.uncertainty}
    model = real.with_parameters({name: model[name] for name in known}).with_uncertainty(known)
    monkeypatch.setattr(by_motion, "parameters_of", lambda *_: tuple(known))
    run = jogged(real, "jog", 3.0, 0.4)
    found = fit_by_motion(model, [run], FRICTION, lambda share, text: None)
    assert found.misfit == pytest.approx(1.0, abs=0.1)
    for name, share in FOUND.items():
        assert found.parameters[name].value == pytest.approx(real[name], rel=share), name
    assert found.parameters["lugre_friction.coulomb_friction"].interval is not None


@pytest.mark.parametrize("true", [2e4, 2e6])
@pytest.mark.parametrize("factor", [1.0 / 3.0, 3.0])
def test_a_bristle_stiffness_holds_whatever_its_start(
    true: float, factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Presliding of 2 mm and of 20 um below 1 mm of noise, from a third and three times the truth."""
    model = sheet("regulators")
    real = truth(model).with_parameters({by_motion.BRISTLE: true})
    known = {name: model.uncertainty[name] for name in FOUND if name in model.uncertainty}
    start = {name: model[name] for name in known} | {by_motion.BRISTLE: factor * true}
    monkeypatch.setattr(by_motion, "parameters_of", lambda *_: (*known, by_motion.BRISTLE))
    states, run = true_and_seen(real, "jog", 3.0, 0.4)
    run = replace(run, position=states[:, 0] + 1e-3 * np.random.default_rng(3).normal(size=len(states)))
    off = real.with_parameters(start).with_uncertainty(known)
    found = fit_by_motion(off, [run], FRICTION, lambda share, text: None).parameters[by_motion.BRISTLE]
    assert found.interval is None or found.interval[0] < true < found.interval[1]
    assert found.interval is not None or found.value == factor * true, "not determined: it keeps its value"


@pytest.mark.check
@pytest.mark.parametrize("kind", SHEETS)
def test_a_machine_is_found_from_its_data_sheet(kind: str) -> None:
    """All parameters at once, and the verb says how."""
    model = sheet(kind)
    real = truth(model)
    runs = [jogged(real, "steps", 15.0, 0.4), jogged(real, "quick", 15.0, 0.15), jogged(real, "slowly", 15.0, 1.5)]
    found = identify(model, runs)
    assert summary(found, runs)["motion"]["misfit"] < 1.2
    for name, share in (FOUND | OWN[kind]).items():
        assert found.model[name] == pytest.approx(real[name], rel=share), name
    assert {*found.undetermined} <= {"pressure_regulator.dead_band"}
