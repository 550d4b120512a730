"""Every actuator: its chambers keep the balance of mass, an open side is the atmosphere, and every effect fits it.

All are found automatically: a new file in the folder of actuators is tested without further work.
"""

import numpy as np
import pytest
from plant.catalogue import AXIS, CATALOGUE, actuated, in_python

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, Model, model_from_dict
from pneumo_ros.plant.actuator import SIDES, Chamber
from pneumo_ros.plant.library import ACTUATORS

every_actuator = pytest.mark.parametrize("name", ACTUATORS)
VOLTAGE = np.repeat([3.0, -3.0, 0.0, 6.0, -1.5], 60)


def volume(model: Model, chamber: Chamber, states: np.ndarray) -> np.ndarray:
    """Volume of a chamber (n,) [m3]."""
    return np.asarray(model[chamber.volume] + chamber.way * model[chamber.area] * states[:, 0])


@every_actuator
def test_its_chambers_are_its_pressures_and_come_after_the_motion(name: str) -> None:
    model = actuated(name)
    assert model.states[: model.frame] == ("y", "v", *(chamber.state for chamber in model.chambers))
    assert all(name in model.parameters for chamber in model.chambers for name in (chamber.area, chamber.volume))
    assert model.has_valve
    assert not model.force_driven


@every_actuator
def test_compiled_equals_plain_python(name: str) -> None:
    model = actuated(name)
    start = model.state(y=0.1, v=0.1)
    expected = in_python(model).simulate(VOLTAGE[::6], start)
    np.testing.assert_allclose(model.simulate(VOLTAGE[::6], start), expected, rtol=1e-9, atol=1e-15)


@every_actuator
def test_what_flows_in_is_what_the_chamber_gains(name: str) -> None:
    """(p V' + V p' / gamma) / (R T) is the flow through the port, wherever the piston is and however it moves."""
    model = actuated(name)
    states = model.simulate(VOLTAGE, model.state(y=0.1))
    rates, seen = model.derivatives(states, VOLTAGE), model.outputs(states, VOLTAGE)
    gamma, gas = model["air.heat_capacity_ratio"], model["air.gas_constant"] * model["air.temperature"]
    for chamber in model.chambers:
        k = model.states.index(chamber.state)
        grows = chamber.way * model[chamber.area] * states[:, 1]
        gained = (states[:, k] * grows + volume(model, chamber, states) * rates[:, k] / gamma) / gas
        np.testing.assert_allclose(gained, seen[chamber.flow], rtol=1e-9, atol=1e-12)
        assert np.ptp(seen[chamber.flow]) > 1e-4  # something flowed


@every_actuator
def test_sealed_chambers_compress_adiabatically(name: str) -> None:
    model = actuated(name, ("rod_atmospheric_force", "end_stop"))
    assert not model.has_valve
    pressures = {chamber.state: 3e5 for chamber in model.chambers}
    states = model.simulate(np.zeros(2000), model.state(v=0.3, **pressures))
    assert np.ptp(states[:, 0]) > 0.01
    for chamber in model.chambers:
        kept = states[:, model.states.index(chamber.state)] * volume(model, chamber, states) ** 1.4
        assert kept == pytest.approx(kept[0], rel=1e-6)


@every_actuator
def test_at_the_pressure_of_the_atmosphere_nothing_pushes_and_an_open_side_stays_there(name: str) -> None:
    model = actuated(name)
    rest = model.state()
    assert model.effort(rest) == pytest.approx(0.0, abs=1e-9)
    seen = model.outputs(rest[None])
    assert seen["drive"][0] - seen["force"][0] == pytest.approx(0.0, abs=1e-9)
    sides = {chamber.side for chamber in model.chambers}
    assert not any(f"port_flow_{side}" in seen for side in SIDES if side not in sides)


@every_actuator
def test_every_effect_of_the_catalogue_fits_it(name: str) -> None:
    model = actuated(name, tuple(dict.fromkeys([*AXIS.effects, *(effect.name for effect in CATALOGUE)])))
    assert model.inputs == ("U",)  # the pressure of an open side is no measured input
    plain = in_python(model)
    rates = plain.derivatives(np.tile(model.state(y=0.2, v=0.1), (3, 1)), np.array([-3.0, 0.0, 3.0]))
    assert np.isfinite(rates).all()


@every_actuator
def test_the_section_says_what_actuates_the_machine(name: str) -> None:
    model = actuated(name)
    again = model_from_dict(model.as_dict(), "again", Library())
    assert again.actuator is model.actuator
    assert again.parameters == model.parameters
    with pytest.raises(UsageError, match=f"{name} is what actuates the machine: give the machine file a section"):
        AXIS.with_effects([*AXIS.effects, name])


def test_a_machine_has_one_actuator() -> None:
    given = {**AXIS.as_dict(), ACTUATORS[-1]: {}, ACTUATORS[0]: {}}
    if len(ACTUATORS) > 1:
        with pytest.raises(UsageError, match=r"each say what actuates the machine; a machine file has one of"):
            model_from_dict(given, "two", Library())
