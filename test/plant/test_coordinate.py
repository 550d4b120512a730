"""Machines that turn: the same equations by their own units, and nothing of a radius."""

import numpy as np
import pytest
from plant import checks
from plant.catalogue import AXIS, EFFECTS, LIBRARY, in_python
from plant.units import DimensionError, unit
from rig import oracle

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, Model, load_model, model_from_dict, save_model
from pneumo_ros.plant.coordinate import Scale, turned
from pneumo_ros.plant.machine_file import machine_text, parse_machine
from pneumo_ros.plant.signals import SIGNALS
from pneumo_ros.units import LINE, ROTARY, TURN, shown, unit_along, writing

VANE = load_model("vane")
SCALE = Scale(0.1, 2.0)
ROUND_BORE = {"chambers", "single_acting"}  # whose walls are those of a bore, as their docstrings say
every_effect = pytest.mark.parametrize("name", sorted(EFFECTS.keys() - ROUND_BORE))


@every_effect
def test_units_are_consistent_where_the_machine_turns(name: str) -> None:
    """No constant in an effect is a length or a force: those are parameters, which turn with the machine."""
    checks.check_units(EFFECTS[name], TURN)


@pytest.mark.parametrize("name", sorted(ROUND_BORE))
def test_what_needs_a_round_bore_says_so(name: str) -> None:
    with pytest.raises(DimensionError):
        checks.check_units(EFFECTS[name], TURN)
    assert "round bore" in (EFFECTS[name].__doc__ or "")


@pytest.mark.parametrize("name", SIGNALS)
def test_a_unit_turns_into_one_of_the_same_powers_of_force_and_length(name: str) -> None:
    row = SIGNALS[name]
    turns, (_, force, length) = unit_along(row.unit, TURN), ROTARY.get(row.unit, ("", 0, 0))
    expected = unit(row.unit) * unit("m") ** float(force - length)
    assert unit(turns).base == expected.base
    assert unit_along(row.unit, LINE) == row.unit


@pytest.mark.parametrize("name", sorted(EFFECTS))
def test_ranges_hold_those_of_a_line_at_any_radius_and_the_default(name: str) -> None:
    effect = EFFECTS[name]
    for key, one in turned(effect, SCALE).parameters.items():
        line = effect.parameters[key]
        power = (lambda row: row[1] - row[2])(ROTARY.get(line.unit, ("", 0, 0)))
        for radius in (0.01, 0.1, 1.0):
            low, high = line.low * radius**power, line.high * radius**power
            assert one.low <= low + 1e-9 * abs(low)
            assert one.high >= high - 1e-9 * abs(high)
        assert (one.unit == line.unit) == (line.unit not in ROTARY)
        assert one.optional == line.optional


def test_the_vane_is_that_of_the_second_simulator() -> None:
    """Which knows no units: its m are rad, its N are N m."""
    names = {"piston", "air", "rotary_vane", "dead_zone", "arctan_flow", "lugre_friction"}
    own = {n.partition(".")[2]: value for n, value in VANE.parameters.items() if n.partition(".")[0] in names}
    del own["wall_volume"]  # no heat passes a wall here
    voltage = np.repeat([3.0, -2.5, 0.0, 1.2], 150)
    start = {"p_a": 3e5, "p_b": 3e5}
    truth = oracle.simulate(own | {"drag_coefficient": 0.0}, voltage, start, 1e-3, rtol=1e-8)
    found = VANE.simulate(voltage, VANE.state(**start))
    assert np.ptp(truth[:, 0]) > 0.1
    for column, name in enumerate(("y", "v", "p_a", "p_b")):
        size = float(np.ptp(truth[:, column]))
        np.testing.assert_allclose(found[:, VANE.states.index(name)], truth[:, column], atol=2e-3 * size, err_msg=name)


def test_the_file_says_how_it_moves_and_is_read_as_it_was_written(tmp_path) -> None:
    text = machine_text(VANE)
    assert "coordinate: rotation" in text
    assert "# [kg m2]" in text
    assert "# [m3/rad]" in text
    save_model(VANE, tmp_path / "vane.yaml")
    again = load_model(tmp_path / "vane.yaml")
    assert (again.coordinate, again.parameters, again.actuator) == (TURN, VANE.parameters, VANE.actuator)
    assert model_from_dict(VANE.as_dict(), "again", Library()).coordinate == TURN
    assert "coordinate" not in AXIS.as_dict()


def test_what_is_made_of_it_turns_too() -> None:
    larger = VANE.with_effects([*VANE.effects, "viscous_friction"]).with_parameters({"piston.mass": 0.1})
    assert larger.coordinate == TURN
    assert larger.specification("viscous_friction.coefficient").unit == "N m s/rad"
    assert larger.measuring(("measured_supply",)).coordinate == TURN


def test_the_same_numbers_make_the_same_kernel() -> None:
    """A rack and pinion: two chambers, and a shaft in place of a rod."""
    shaft = model_from_dict({**AXIS.as_dict(), "coordinate": TURN}, "rack", Library())
    assert shaft.composition.text == AXIS.composition.text
    assert shaft.unit("m") == "rad"


def test_priors_follow_from_torque_and_stroke() -> None:
    small = {"piston.area_a": 5.4e-7, "piston.area_b": 5.4e-7, "rotary_vane.volume_a": 1.7e-6}
    tenth = model_from_dict(VANE.with_parameters(small).as_dict(), "small", Library())
    for name in ("coulomb_friction", "bristle_stiffness"):
        sizes = [one.specification(f"lugre_friction.{name}").default for one in (VANE, tenth)]
        assert sizes[0] / sizes[1] == pytest.approx(100.0)
    assert Scale.of({"piston.stroke": 2.0, "lugre_friction.static_friction": 0.03}, actuated=False).force == 2e-4
    motor = {"dc_motor.force_per_volt": 0.1, "dc_motor.source_voltage": 12.0}
    assert Scale.of(motor, actuated=False).force == pytest.approx(5e-3)
    assert Scale.of({"piston.stroke": "four"}, actuated=True) == Scale()


def test_a_usual_size_that_only_a_range_gives_is_one_of_every_radius() -> None:
    """A tenth of 40 per metre of stiffness at 10 mm; the range allowed is that of 1 m, a hundred times as wide."""
    larger = VANE.with_effects([*VANE.effects, "spring_load"])
    assert larger.specification("spring_load.progression").high == pytest.approx(20.0)
    assert larger.usual_size("spring_load.progression") == pytest.approx(0.04)


def test_friction_by_load_is_of_one_usual_size_at_the_usual_force_of_every_machine() -> None:
    """Its growth q: q F is the usual rise k of 0.1 on a line, and where the torque is a tenth of the force."""
    effects = [*AXIS.effects, "load_dependent_friction"]
    line = AXIS.with_effects(effects).usual_size("load_dependent_friction.growth")
    assert line * AXIS["lugre_friction.static_friction"] == pytest.approx(0.1)
    vane = VANE.with_effects([*VANE.effects, "load_dependent_friction"])  # of 0.1 N m where the other has 1 N
    assert vane.usual_size("load_dependent_friction.growth") * 0.1 == pytest.approx(line)


def test_a_mass_along_a_line_has_at_least_a_gram() -> None:
    for model, least in ((AXIS, 1e-3), (VANE, 1e-7)):
        assert model.specification("piston.mass").low == pytest.approx(least)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"coordinate": "rotatoin"}, "unknown coordinate 'rotatoin'; did you mean rotation"),
        ({"coordinate": 3}, "'coordinate' is 3; it takes translation or rotation"),
        ({"coordinate": LINE}, "its part 'rotary_vane' is one for 'coordinate: rotation', and the file says transl"),
    ],
)
def test_a_wrong_coordinate_is_refused(change: dict[str, object], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        model_from_dict({**VANE.as_dict(), **change}, "vane", Library())


def test_a_vane_without_the_key_turns_and_one_that_sweeps_unequal_volumes_is_cautioned() -> None:
    without = {key: value for key, value in VANE.as_dict().items() if key != "coordinate"}
    assert model_from_dict(without, "vane", Library()).coordinate == TURN
    assert not VANE.cautions()
    unequal = VANE.with_parameters({"piston.area_b": 3e-5})
    assert any("sweeps equal volumes" in one for one in unequal.cautions())


def test_errors_have_its_units() -> None:
    with pytest.raises(UsageError, match=r"piston.mass is -1.0 kg m2; allowed is 1e-07 to 10000"):
        VANE.with_parameters({"piston.mass": -1.0})
    with pytest.raises(UsageError, match=r"initial y is 3 rad, outside the stroke of -2.355 to 2.355 rad"):
        VANE.state(y=3.0)
    with pytest.raises(UsageError, match=r"tuning plans in m and N; vane turns, in rad and N m"):
        VANE.require_metres("tuning")
    AXIS.require_metres("tuning")


def test_texts_are_in_the_units_of_the_machine_while_it_is_written_of() -> None:
    assert shown("mm") == "mm"
    with writing(TURN):
        assert (shown("mm"), shown("N"), shown("kg/s")) == ("mrad", "N m", "kg/s")
        with writing({"coordinate": LINE}):
            assert shown("N") == "N"
    assert shown("N") == "N"


def test_a_file_of_several_axes_may_have_one_that_turns() -> None:
    from pneumo_ros.multiaxis.machine_file import machine_from_dict
    from pneumo_ros.multiaxis.machine_file import machine_text as text_of_axes

    given = {"axes": ["slide", "wrist"], "slide": AXIS.as_dict(), "wrist": VANE.as_dict()}
    machine = machine_from_dict(given, "arm", Library())
    assert [one.coordinate for one in machine.axes.values()] == [LINE, TURN]
    assert text_of_axes(machine).count("coordinate: rotation") == 1


def test_plain_python_runs_it() -> None:
    voltage = np.repeat([3.0, -3.0], 20)
    start = VANE.state(p_a=3e5, p_b=3e5)
    np.testing.assert_allclose(in_python(VANE).simulate(voltage, start), VANE.simulate(voltage, start), rtol=1e-9)


def test_effects_of_a_line_are_not_touched() -> None:
    assert LIBRARY.find("viscous_friction").parameters["coefficient"].unit == "N s/m"
    assert isinstance(VANE, Model)
    assert parse_machine(machine_text(AXIS), "axis", Library()).coordinate == LINE
