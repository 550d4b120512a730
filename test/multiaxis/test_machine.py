"""Several axes in one kernel: each as by itself, and a supply line as one axis with a line of its own has it."""

import numpy as np
import pytest
from multiaxis.machines import LINE, two

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.multiaxis import Machine
from pneumo_ros.plant import load_model

VOLTS = np.zeros((1500, 2))
VOLTS[100:900, 0], VOLTS[300:1200, 1], VOLTS[1200:, 1] = 4.0, 3.0, -5.0


def test_axes_on_a_stiff_supply_move_as_each_alone() -> None:
    machine = two()
    states = machine.simulate(VOLTS, machine.state())
    for k, (axis, own) in enumerate(machine.split(states).items()):
        alone = machine.axes[axis]
        np.testing.assert_array_equal(own, alone.simulate(VOLTS[:, k], alone.state()))


def test_a_line_of_one_axis_is_the_effect_of_that_axis() -> None:
    axis = load_model("axis")
    own = axis.with_effects(
        [*axis.effects, "supply_pressure_droop"], {f"supply_pressure_droop.{key}": value for key, value in LINE.items()}
    )
    machine = Machine("one", {"elbow": axis}, LINE)
    expected = own.simulate(VOLTS[:, 0], own.state())
    found = machine.simulate(VOLTS[:, :1], machine.state())
    drop = expected[:, own.states.index("d_s")]
    assert drop.max() > 5e4  # Pa
    np.testing.assert_allclose(found[:, -1], drop, atol=1e-4 * drop.max())  # a step of 0.1 ms over 2 x 0.3 s is 1.7e-4
    np.testing.assert_allclose(found[:, 0], expected[:, 0], atol=5e-6)  # m, of 0.14


def test_one_axis_feels_what_the_other_draws() -> None:
    machine, stiff = two(LINE), two()
    shoulder_moves = VOLTS * [1.0, 0.0] + [0.0, 2.0]
    drop = machine.simulate(shoulder_moves, machine.state())[:, -1]
    alone = machine.simulate(VOLTS * 0.0 + [0.0, 2.0], machine.state())[:, -1]
    assert drop[400] > alone[400] + 2e4  # Pa
    slower = machine.split(machine.simulate(shoulder_moves, machine.state()))["elbow"][-1, 0]
    assert slower < stiff.split(stiff.simulate(shoulder_moves, stiff.state()))["elbow"][-1, 0] - 1e-3  # m


def test_names_have_the_prefix_of_their_axis() -> None:
    machine = two(LINE)
    assert machine.inputs == ("shoulder/U", "elbow/U")
    assert machine.states[0] == "shoulder/y"
    assert machine.states[-3:] == ("elbow/z", "elbow/drawn_mass", "d_s")


def test_what_does_not_fit_is_refused() -> None:
    machine = two(LINE)
    with pytest.raises(UsageError, match="did you mean elbow"):
        machine.axis("elbo")
    with pytest.raises(UsageError, match="elbow/U"):
        machine.simulate(np.zeros(5), machine.state())
    with pytest.raises(UsageError, match="state of elbow has shape"):
        machine.state({"elbow": np.zeros(3)})
    with pytest.raises(NumericalError, match=r"left the finite numbers at t = "):
        machine.simulate(np.zeros((5, 2)), np.full(len(machine.states), np.nan))
    force_driven = load_model("emps")
    with pytest.raises(UsageError, match="none of them draws air"):
        Machine("emps", {"x": force_driven}, LINE)
