"""Machines from parts: geometry, flow, gravity, uncertainty and sources, against values worked out by hand."""

import math
from pathlib import Path

import numpy as np
import pytest
from parts.test_shelf import written

from pneumo_ros.errors import UsageError
from pneumo_ros.parts.design import Design, Wishes, design
from pneumo_ros.parts.figure import Figure
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.parts.strokes import band, drawn, stroke_times
from pneumo_ros.plant.effects.valve.choked_flow import NORMAL_DENSITY

COULOMB, STATIC = "lugre_friction.coulomb_friction", "lugre_friction.static_friction"


def made(**said: str | None) -> Design:
    """The machine of some words; the rest is a cylinder of bore 32 with SMC SY7000 at 6 bar."""
    usual = {"cylinder": "iso15552-32-250", "valve": "smc-sy7000", "supply": "6barg", "mass": "10"}
    return design(Wishes(**(usual | said)), load_shelf())


def test_areas_and_volumes_are_those_of_the_geometry() -> None:
    model = made().model
    area_a, area_b = math.pi / 4 * 0.032**2, math.pi / 4 * (0.032**2 - 0.012**2)
    assert (model["piston.area_a"], model["piston.area_b"]) == pytest.approx((area_a, area_b), rel=1e-12)
    assert model["piston.stroke"] == 0.25
    assert model["chambers.volume_b"] == pytest.approx(area_b * 0.25 * 0.62, rel=1e-12)
    assert model["air.supply_pressure"] == 7e5


@pytest.mark.parametrize("valve", ["smc-vq110u", "festo-mh2-ms1h"])
def test_the_supply_is_the_users_whatever_the_valve_may_take(valve: str) -> None:
    assert made(valve=valve, supply="5barg").model["air.supply_pressure"] == 6e5


def test_a_part_and_its_sizes_make_the_same_machine() -> None:
    by_size = design(
        Wishes(bore="32", rod="12mm", stroke="0.25 m", valve="smc-sy7000", supply="0.6 MPa", mass="10kg"), load_shelf()
    )
    for name, value in made().model.parameters.items():
        assert by_size.model[name] == pytest.approx(value, rel=1e-12), name


def test_the_published_conductance_flows_at_full_signal() -> None:
    """Choked flow out of the supply into an empty chamber, at the signal at which the valve is fully open."""
    for valve, C in (("smc-sy7000", 4.1e-8), ("tel-regulator", 4.5e-9), ("smc-vq110u", 1.44e-9)):
        model = made(valve=valve).model
        state = model.state(p_b=7e5)
        for name, full in (("x_s", 10.0), ("body_a", 1.0)):
            if name in model.states:
                state[model.states.index(name)] = full
        found = model.outputs(state[None], [10.0])["port_flow_a"][0]
        wanted = C * NORMAL_DENSITY * 7e5 * math.sqrt(293.15 / 293.0)
        assert found == pytest.approx(wanted, rel=1e-6), valve


@pytest.mark.parametrize(("mounting", "share"), [("vertical", 1.0), ("vertical-down", -1.0), ("30deg", 0.5)])
def test_gravity_pulls_against_the_rod_that_lifts(mounting: str, share: float) -> None:
    model = made(mounting=mounting).model
    assert model["constant_load.load"] == pytest.approx(share * 10 * 9.80665)
    # without air the piston falls: a vertical rod goes back in
    sealed = model.with_effects([e for e in model.effects if e in ("constant_load", "lugre_friction")])
    loose = sealed.with_parameters({STATIC: 0.0, COULOMB: 1e-3})
    state = loose.state(p_a=1e5 * model["piston.area_b"] / model["piston.area_a"], p_b=1e5)
    assert math.copysign(1.0, loose.derivatives(state, [0.0])[0, 1]) == -math.copysign(1.0, share)


def test_a_horizontal_axis_has_no_load() -> None:
    assert "constant_load" not in made().model.effects


def test_deviations_are_those_of_the_intervals() -> None:
    """Evenly drawn: friction 3 to 25 % around 8 % of the full force; flow within 10 %."""
    model = made(valve="smc-vq2000").model
    full = model["piston.area_a"] * 6e5
    draws = np.random.default_rng(1).uniform(0.03, 0.25, 200_000) * full
    assert model.uncertainty[COULOMB] == pytest.approx(np.sqrt(np.mean((draws - model[COULOMB]) ** 2)), rel=0.01)
    C = "choked_flow.conductance_filling"
    assert model.uncertainty[C] == pytest.approx(0.1 / math.sqrt(3.0) * model[C], rel=1e-9)
    assert "piston.area_a" not in model.uncertainty


def test_a_figure_without_an_interval_is_exact() -> None:
    assert Figure(2.0, "m", 2.0, 2.0, "x").deviation == 0.0
    assert Figure(2.0, "m", 1.0, 3.0, "x").deviation == pytest.approx(1.0 / math.sqrt(3.0))


def test_every_value_that_is_no_default_names_its_source() -> None:
    for valve in ("smc-sy7000", "tel-regulator"):
        found = made(valve=valve, mounting="vertical")
        model = found.model
        changed = [n for n, value in model.parameters.items() if value != model.specification(n).default]
        assert set(changed) <= set(found.notes)
        assert found.notes[COULOMB].startswith(("[1]", "given"))
        assert "rule friction" in found.notes[COULOMB]
        assert "rule" not in found.notes["piston.area_a"]


def test_a_valve_of_a_data_sheet_is_a_proportional_one(tmp_path: Path) -> None:
    written(tmp_path)
    own = design(Wishes(cylinder="iso6432-25-200", valve="my-valve", supply="6barg", mass="2"), load_shelf([tmp_path]))
    said = design(
        Wishes(cylinder="iso6432-25-200", valve_flow="500 l/min", signal="0,5,10", supply="6barg", mass="2"),
        load_shelf(),
    )
    assert own.signal == said.signal == (10.0, 0.0)
    assert own.model["valve_null_offset.offset"] == -5.0
    assert any("closed at 5 V" in caution for caution in own.cautions)
    C = "choked_flow.conductance_filling"
    assert own.model[C] == pytest.approx(said.model[C])
    assert own.model["valve_spool_dynamics.angular_frequency"] == pytest.approx(2 * math.pi * 60)
    assert "valve_spool_dynamics" not in said.model.effects
    closed = own.model.outputs(own.model.state(p_a=4e5, p_b=4e5, x_s=0.0)[None], [5.0])["port_flow_a"][0]
    assert closed == 0.0


@pytest.mark.parametrize(
    ("said", "error"),
    [
        ({"valve": "smc-sy700"}, r"unknown valve or regulator 'smc-sy700'; did you mean smc-sy7000.*--parts FOLDER"),
        ({"valve": "iso6432-25"}, r"iso6432-25 is a cylinder; this takes a valve or regulator"),
        ({"valve": "festo-vppe"}, r"no flow of the valve is published here; give .*--valve-flow 'qn 700 l/min'"),
        ({"valve": "smc-vt307"}, r"no flow of the valve is published here; give .*--valve-flow 'qn 700 l/min'"),
        ({"cylinder": "iso15552-32"}, r"the stroke of the cylinder is missing; give"),
        ({"rod": "40"}, r"bore 32 mm, rod 40 mm .* make no cylinder"),
        ({"supply": "1bara"}, r"the supply is 1 bar absolute; it takes more than the atmosphere"),
        ({"supply": "160barg"}, r"161 bar absolute; .* up to 50 bar, of air.*oil moves.*--read-as no-command"),
        ({"mass": "0"}, r"the mass is 0 kg; it takes the moving mass, above 0"),
        ({"mounting": "120deg"}, r"the mounting is 120 deg; it takes -90 to 90"),
        ({"mass": "1e9"}, r"piston.mass is 1000000000.0 kg; allowed is"),
    ],
)
def test_what_makes_no_machine_is_refused_in_words(said: dict[str, str], error: str) -> None:
    with pytest.raises(UsageError, match=error):
        made(**said)


def test_valves_that_serve_one_chamber_are_on_off_valves_with_the_published_times() -> None:
    found = made(valve="smc-vq110u")
    model = found.model
    assert (model["on_off_valves.three_way"], model["on_off_valves.pulse_frequency"]) == (1.0, 50.0)
    assert (model["on_off_valves.switch_on"], model["on_off_valves.switch_off"]) == (0.0035, 0.002)
    assert model.uncertainty["on_off_valves.switch_on"] > 0.0
    assert "on_off_valves.pulse_frequency" not in model.uncertainty, "the driver's choice"
    assert any("pulse_frequency" in caution for caution in found.cautions)


def test_a_regulator_serves_each_chamber_with_the_published_response() -> None:
    found = made(valve="festo-vppe", valve_flow="C 2", supply="6barg")
    model = found.model
    assert model.inputs == ("U", "U_b")
    assert model["pressure_regulator.pressure_range"] == pytest.approx(6e5), "no range is published: the supply"
    assert model["pressure_regulator.angular_frequency"] == pytest.approx(2.67 / 0.075)
    assert model["pressure_regulator.dead_band"] == 0.001
    wide = made(valve="smc-itvh2020", valve_flow="C 2", supply="25barg").model
    assert wide["pressure_regulator.pressure_range"] == pytest.approx(2e6)
    assert 0.1 < stroke_times(model, found.signal[0])[0] < 2.0


@pytest.mark.parametrize(
    ("said", "commands"),
    [
        ({"valve_flow": "C 2"}, "10 V extends, -10 V retracts at full opening; closed at 0 V"),
        ({"valve_flow": "C 2", "signal": "0,5,10"}, "10 V extends, 0 V retracts at full opening; closed at 5 V"),
        ({"valve": "smc-sy7000"}, "above 1 V extends and below -1 V retracts, at full flow; closed at 0 V"),
        ({"valve": "smc-vq110u"}, "half of each period at 0 V; these valves never close both ways"),
        ({"valve": "festo-vppe", "valve_flow": "C 2"}, "0 to 10 V are 0 to 6 bar gauge in chamber a by valve/command"),
    ],
)
def test_each_kind_of_valve_says_what_its_commands_do(said: dict[str, str], commands: str) -> None:
    assert commands in made(**{"valve": None} | said).commands


def test_filling_and_exhaust_have_the_published_critical_ratios() -> None:
    model = made(valve="smc-51-sy540").model
    assert model["choked_flow.critical_ratio"] == pytest.approx(0.35)
    assert model["path_critical_ratios.exhaust_excess"] == pytest.approx(-0.12)
    assert "path_critical_ratios" not in made(valve="smc-sy5000").model.effects, "one figure for both"


def test_a_published_flow_gives_way_to_the_users() -> None:
    C = "choked_flow.conductance_filling"
    assert made(valve="airtac-4v210", valve_flow="C 0.2").model[C] == pytest.approx(0.2e-8, rel=0.01)
    one = made(valve="smc-vt307", valve_flow="C 0.2").model
    assert one[C] * np.arctan(one["arctan_flow.voltage_gain"] * 10.0) * 2.0 / np.pi == pytest.approx(0.2e-8)
    assert made(valve_flow="C 0.2").model["choked_flow.conductance_exhaust"] == pytest.approx(0.2e-8, rel=0.01)


def test_a_stroke_takes_as_long_as_its_machine_says() -> None:
    """Against a single run; the band holds the prediction, and gravity makes the way out the longer one."""
    found = made(mounting="vertical", valve="smc-vq2000")
    model = found.model
    state = model.state(y=-0.125, p_b=7e5)
    y = model.simulate(np.full(1000, 10.0), state)[:, model.states.index("y")]
    single = 1e-3 * (1 + int(np.argmax(y >= 0.125 - 0.02 * 0.25)))
    assert stroke_times(model, 10.0)[0] == pytest.approx(single, abs=1.5e-3)
    out, low, high = band(found, 10.0, 64)
    assert low < out < high < 2.0 * out
    assert stroke_times(model, 10.0)[0] != stroke_times(model, -10.0)[0]


def test_the_flow_at_full_signal_is_the_published_one_however_the_valve_opens() -> None:
    """A valve of 500 l/min (10 %) that opens with an argument of 0.5 to 20: strokes as long as its flow says."""
    found = made(valve=None, valve_flow="500 l/min")
    names = list(found.model.parameters)
    gain, size = (
        drawn(found, 200)[:, names.index(n)] for n in ("arctan_flow.voltage_gain", "choked_flow.conductance_filling")
    )
    full = size * np.arctan(gain * 9.8) * 2.0 / np.pi
    assert np.ptp(gain) > 1.5
    assert np.ptp(full) < 0.35 * full.mean()  # critical ratio and scatter, not the factor of three of C
    assert np.ptp(size) > 1.0 * full.mean()
    out, low, high = band(found, 10.0, 64)
    assert 0.8 * out < low < out < high < 1.5 * out


def test_an_on_off_valve_is_open_or_closed() -> None:
    """How a proportional valve opens says nothing of it: its flow is as sure as the published one."""
    found = made(valve="festo-mh2-ms1h", cylinder="iso6432-16-100", mass="0.5")
    uncertain = found.model.uncertainty
    size = "choked_flow.conductance_filling"
    assert "arctan_flow.voltage_gain" not in uncertain
    assert uncertain[size] < 0.1 * found.model[size]
    assert uncertain["on_off_valves.switch_on"] > 0.0
