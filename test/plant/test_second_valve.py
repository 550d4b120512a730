"""A valve for each chamber: its own command, overlap and spool, and nothing of chamber a."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python
from plant.checks import check_documentation, check_equations_are_finite, check_units

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import mirrored, second_closed

LIMITS = {"second_valve.fill_limit": 0.78, "second_valve.empty_limit": 0.78}


def two(**values: float) -> Model:
    """The axis with a valve for each chamber, which overlap alike."""
    given = {f"second_valve.{key}": value for key, value in values.items()}
    return AXIS.with_effects([*AXIS.effects, "second_valve"], {**LIMITS, **given})


def test_it_is_a_sound_effect() -> None:
    effect = AXIS.library.find("second_valve")
    check_documentation(effect)
    check_units(effect)
    check_equations_are_finite(effect)


def test_valves_that_move_against_each_other_are_one_valve() -> None:
    volts = np.repeat([3.0, -2.0, 0.5, 6.0], 200)
    one = AXIS.simulate(volts, AXIS.state())
    both = np.column_stack([volts, mirrored(two(), volts)])
    model = two()
    pair = model.simulate(both, model.state())
    assert pair[:, :4] == pytest.approx(one[:, :4], rel=1e-9, abs=1e-9)
    assert model.inputs == ("U", "U_b")


def test_each_chamber_follows_its_own_command() -> None:
    model = in_python(two(offset=-5.0))
    held = [[0.0, 8.0], [0.0, 2.0], [3.0, 5.0], [3.0, 5.7]]
    seen = model.outputs(np.tile(model.state(p_a=3e5, p_b=3e5), (4, 1)), held)
    assert seen["port_flow_a"][:2] == pytest.approx([0.0, 0.0])
    assert seen["port_flow_b"][0] > 0.0 > seen["port_flow_b"][1]
    assert seen["port_flow_a"][2] > 0.0
    assert seen["port_flow_b"][2:] == pytest.approx([0.0, 0.0]), "closed at 5 V, and inside its overlap"
    assert second_closed(two(offset=-5.0)) == 5.0
    assert second_closed(AXIS) is None


def test_compiled_equals_python_to_the_bit() -> None:
    model = two(angular_frequency=200.0)
    held = np.column_stack([np.repeat([3.0, -3.0], 20), np.repeat([-1.0, 4.0], 20)])
    assert model.simulate(held, model.state()).tobytes() == in_python(model).simulate(held, model.state()).tobytes()


def test_one_command_for_two_valves_is_refused() -> None:
    with pytest.raises(UsageError, match="a row of 2 numbers for every sample: U, U_b"):
        two().simulate(np.zeros(5), two().state())
