"""An arm as control laws know it: the plant's own mass and load, fed forward by each law that inverts the machine."""

import numpy as np
import pytest

from pneumo_ros.control import LAWS, Machine, Setpoint, ValveInverse
from pneumo_ros.control.closed_loop import closed_loop
from pneumo_ros.control.machine import ARM
from pneumo_ros.control.motion import Trajectory, Waypoint
from pneumo_ros.control.motion.capability import Capability
from pneumo_ros.plant import Model, Stepper, load_model

BOOM = {  # as config/arm/lever.yaml has it from its URDF, rounded
    "arm_load.mass_0": 124.67, "arm_load.mass_1": 55.44, "arm_load.mass_2": 18.18, "arm_load.mass_3": 4.97,
    "arm_load.mass_4": 1.51, "arm_load.mass_5": 0.43, "arm_load.energy_1": 35.66, "arm_load.energy_2": 1.64,
    "arm_load.energy_3": -0.05,
}  # fmt: skip
CYLINDER = {
    "piston.mass": 1.5, "piston.area_a": 1.25664e-3, "piston.area_b": 1.05558e-3, "piston.stroke": 0.25,
    "chambers.volume_a": 1.8708e-4, "chambers.volume_b": 1.6195e-4,
    "lugre_friction.static_friction": 60.0, "lugre_friction.coulomb_friction": 40.0,
    "quadratic_drag.coefficient": 800.0,
}  # fmt: skip


def boom() -> Model:
    """A cylinder that turns a boom."""
    axis = load_model("axis")
    return axis.with_effects([*axis.effects, "arm_load"], BOOM).with_parameters(CYLINDER)


def at_middle(model: Model) -> Machine:
    """The same with mass and load as they are at mid stroke."""
    here = Machine.of(model.effects, model.parameters).terms(0.0, 0.0)
    fixed = {name: value for name, value in model.parameters.items() if name not in ARM}
    return Machine.of(model.effects, fixed | {"piston.mass": here.mass, "constant_load.load": here.load})


@pytest.mark.parametrize(("y", "v"), [(0.0, 0.0), (-0.11, 0.4), (0.09, -0.7), (0.125, 0.2)])
def test_it_is_the_plants_arm(y: float, v: float) -> None:
    model = boom()
    machine = Machine.of(model.effects, model.parameters)
    mass, load, slope = machine.terms(y, v)
    plain = model.with_parameters(dict.fromkeys(BOOM, 0.0))
    with_arm, without = (one.outputs(one.state(y=y, v=v)[None]) for one in (model, plain))
    assert mass == pytest.approx(1.5 + float(with_arm["added_mass"][0]))
    assert load == pytest.approx(float(with_arm["force"][0] - without["force"][0]))
    step = 1e-6
    numeric = (machine.terms(y + step, v).load - machine.terms(y - step, v).load) / (2.0 * step)
    assert slope == pytest.approx(numeric, rel=1e-5)


def test_a_machine_without_an_arm_is_as_before() -> None:
    machine = Machine(mass=5.0, mass_added=2.0, load=30.0)
    assert machine.terms(0.1, 0.5) == (7.0, 30.0, 0.0)
    assert (machine.moving_mass, machine.opposing(1.0), machine.opposing(-1.0)) == (7.0, 30.0, -30.0)


def test_a_motion_must_lift_the_arm_where_it_is_heaviest() -> None:
    model = boom()
    machine = Machine.of(model.effects, model.parameters)
    loads = [machine.terms(y, 0.0).load for y in np.linspace(-0.125, 0.125, 41)]
    assert machine.opposing(1.0) == pytest.approx(max(loads))
    assert machine.opposing(-1.0) == pytest.approx(-min(loads))
    able = Capability(machine, ValveInverse())
    assert able.breakaway(1.0) == pytest.approx(60.0 + max(loads))


def error(model: Model, law: str, gains: dict[str, float], known: Machine) -> float:
    """rms error [m] of moves to and fro over most of the stroke, after the first one."""
    way = [Waypoint(t, y, 0.0, 0.0) for t, y in ((1.2, 0.08), (1.6, 0.08), (2.8, -0.08), (3.2, -0.08), (4.4, 0.08))]
    load, p_b = Machine.of(model.effects, model.parameters).terms(-0.08, 0.0).load, 3e5
    rod = 1e5 * (model["piston.area_a"] - model["piston.area_b"])
    p_a = (load + rod + model["piston.area_b"] * p_b) / model["piston.area_a"]
    plant = Stepper(model, model.state(y=-0.08, p_a=p_a, p_b=p_b), sample_time=1e-3)
    one = LAWS[law](gains, ValveInverse(0.78, 0.78), known)
    record = closed_loop(plant, one, Trajectory(Setpoint(-0.08), 0.0, way), 4400)
    return float(np.sqrt(np.mean((record.states[1200:, 0] - record.reference[1200:]) ** 2)))


@pytest.mark.parametrize(
    ("law", "gains", "share"),
    [
        ("cascade", {"damping": 4000.0, "force_rate": 90.0, "position_rate": 25.0}, 0.6),
        ("pva", {}, 0.5),
        ("sliding_mode", {}, 1.0),
    ],
)
def test_a_law_that_knows_the_arm_follows_better(law: str, gains: dict[str, float], share: float) -> None:
    model = boom()
    before = error(model, law, gains, at_middle(model))
    assert error(model, law, gains, Machine.of(model.effects, model.parameters)) < share * before
