"""States that follow from the inputs alone: which they are, and that they run by themselves as in the whole machine."""

import numpy as np
import pytest
from plant.catalogue import AXIS

from pneumo_ros.plant import Model
from pneumo_ros.plant.commanded import readings_from, sources
from pneumo_ros.plant.effect import Effect, Parameter, State, parse_function
from pneumo_ros.plant.library import Library

PLAIN = [name for name in AXIS.effects if name != "dead_zone"]
FOUND = {
    ("on_off_valves",): ("body_a", "body_b", "level_a", "level_b", "wait_a", "wait_b"),
    ("pressure_regulator", "second_regulator"): ("r_a", "r_a_rate", "r_b", "r_b_rate"),
    ("valve_spool_dynamics", "command_delay"): ("x_s", "w_s", "sent_1", "sent_2", "sent_3"),
    ("second_valve",): ("x_b", "w_b"),
    ("valve_hysteresis",): ("seen",),
    ("line_delay",): (),  # its flows depend on the pressures
    ("friction_lag",): (),
}


def machine(*effects: str) -> Model:
    return AXIS.with_effects([*PLAIN, *effects])


@pytest.mark.parametrize("effects", FOUND, ids="+".join)
def test_states_that_the_command_alone_moves(effects: tuple[str, ...]) -> None:
    assert machine(*effects).composition.commanded == FOUND[effects]


def test_the_parameters_on_which_they_depend() -> None:
    regulators = machine("pressure_regulator", "second_regulator", "valve_null_offset").composition.commanding
    assert {name.partition(".")[2] for name in regulators} == {
        "pressure_range", "full_signal", "angular_frequency", "damping_ratio", "offset",
    }  # fmt: skip
    assert "pressure_regulator.band" not in regulators, "it acts on the flow only"


@pytest.mark.parametrize("effects", [e for e in FOUND if FOUND[e]], ids="+".join)
def test_alone_they_run_as_in_the_whole_machine(effects: tuple[str, ...]) -> None:
    model = machine(*effects)
    held = np.repeat(np.random.default_rng(0).uniform(-9.0, 9.0, (40, len(model.inputs))), 200, axis=0)
    whole = np.vstack([model.state(), model.simulate(held, model.state(), sample_time=1e-3, parts=10)])
    at, columns = np.array([0, 1, 7, 333, 800]), [model.states.index(s) for s in model.composition.commanded]
    out = np.empty((len(at), len(columns)))
    model.kernel.lead(model.state(), model.values, held, 0.0, 1e-4, 1, 10, at, out)
    np.testing.assert_array_equal(out, whole[at][:, columns])


def test_only_on_off_valves_need_short_steps() -> None:
    """A bristle is kept on its limit once per step, too, but moves with the piston."""
    assert [effects for effects in FOUND if machine(*effects).composition.jumping] == [("on_off_valves",)]
    assert not AXIS.composition.jumping


def test_a_machine_driven_by_a_force_has_none() -> None:
    """A measured force has noise, and is no command."""
    free = Model.build(["lugre_friction", "friction_lag"], {}, frame=("piston", "air"), defaults=True)
    assert free.composition.commanded == ()


def test_what_a_result_is_computed_from() -> None:
    """Through names in between, conditions, several targets and loops."""

    def law(p_a: float, voltage: float, share: float, other: float):  # type: ignore[no-untyped-def]
        first, second = voltage, p_a
        total = 0.0
        for k in range(3):
            total = total + k * share
        if other > 0.0:
            first = first + 1.0
        return first, second, total

    function = parse_function(law, "law")
    assert sources(function, "first") == {"voltage", "other"}
    assert sources(function, "second") == {"p_a"}
    assert sources(function, "total") == {"share"}


def test_what_a_reading_is_computed_from() -> None:
    """The play before the sensor by its own state, and nothing of the load behind another play."""
    play = AXIS.library.find("backlash")
    assert readings_from(play, ["y_measured"]) == {"y_measured", "play", "v", "gap"}
    assert readings_from(play, ["p_a_measured"]) == set()


def test_a_state_of_ones_own_is_found_by_its_source() -> None:
    class Driver(Effect):
        """A lag of the driver's current, which a pressure disturbs where `disturbed` is not 0."""

        disturbed = Parameter(0.0, "V/Pa", "influence of the pressure")

        current = State("V", "current")
        seen = State("V", "current with the disturbance")

        def equations(voltage, p_a, current, seen, disturbed):  # type: ignore[no-untyped-def] # noqa: N805
            der_current = 50.0 * (voltage - current)
            der_seen = 50.0 * (voltage + disturbed * p_a - seen)
            voltage = current
            return voltage, der_current, der_seen

    model = Model.build([*AXIS.effects, "driver"], dict(AXIS.parameters), library=Library([Driver]), defaults=True)
    assert model.composition.commanded == ("current",)
