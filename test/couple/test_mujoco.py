"""Cylinders on an arm of MuJoCo, against small steps and against the plant."""

from typing import Any

import numpy as np
import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

mujoco = pytest.importorskip("mujoco", reason="comes with the mujoco extra")
from pneumo_ros.couple.mujoco import Cylinders, Mount  # noqa: E402

SLIDE = """<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody><body>
<joint name="rod" type="slide" axis="1 0 0"/><geom size="0.05" mass="5"/></body></worldbody></mujoco>"""
ARM = """<mujoco><option timestep="{step}" integrator="implicitfast"/><worldbody>
<site name="base" pos="0.05 0 0.3"/><body pos="0 0 1"><joint name="shoulder" type="hinge" axis="0 1 0" damping="0.5"/>
<geom type="capsule" fromto="0 0 0 0.7 0 0" size="0.03" mass="8"/><site name="clevis" pos="0.3 0 -0.04"/></body>
</worldbody><tendon><spatial name="lift"><site site="base"/><site site="clevis"/></spatial></tendon></mujoco>"""


def made(text: str) -> tuple[Any, Any]:
    """Model and data, with the tendons' lengths known."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def test_a_mass_on_a_slide_moves_as_the_plant_does() -> None:
    axis = load_model("axis")
    model, data = made(SLIDE)
    cylinders = Cylinders(model, data, {"one": Mount(axis, joint="rod")})
    volts = 3.0 * np.sin(3.0 * np.arange(1500) * 1e-3)
    expected = axis.simulate(volts, axis.state())
    for k, voltage in enumerate(volts):
        cylinders.step({"one": float(voltage)})
        assert data.qpos[0] == pytest.approx(expected[k, 0], abs=1e-4)  # dt v/2
    assert float(np.ptp(expected[:, 0])) > 0.05
    assert cylinders.by_name["one"].mass == pytest.approx(5.0)


def lifted(step: float, seconds: float = 1.5) -> tuple[np.ndarray, Any]:
    """Rod positions every 10 ms of an arm that its cylinder carries, and the cylinder."""
    model, data = made(ARM.format(step=step))
    mount = Mount(load_model("axis"), tendon="lift", length=float(data.ten_length[0]))
    cylinders = Cylinders(model, data, {"lift": mount})
    one = cylinders.by_name["lift"]
    one.cylinder.pressurise(5.5e5, 2.0e5)
    found, every = [], round(0.01 / step)
    for k in range(round(seconds / step)):
        cylinders.step({"lift": 2.5 if k * step > 0.3 else 0.0})
        if k % every == 0:
            found.append(one.position)
    return np.array(found), one


def test_large_steps_give_the_arm_the_motion_of_small_ones() -> None:
    exact, _ = lifted(5e-5)
    assert float(np.ptp(exact)) > 0.02
    for step, most in ((1e-3, 1.5e-4), (2e-3, 4e-4)):
        found, one = lifted(step)
        assert float(np.sqrt(np.mean((found - exact) ** 2))) < most
        inertia = 8.0 * 0.7**2 / 3.0  # kg m2, of a rod about its end; the jacobian is its lever
        assert one.mass == pytest.approx(inertia / float(one.jacobian[0]) ** 2, rel=0.05)


def test_two_sites_carry_a_cylinder_as_the_tendon_between_them_does() -> None:
    axis, found = load_model("axis"), []
    for place in ({"tendon": "lift"}, {"sites": ("base", "clevis")}):
        model, data = made(ARM.format(step=1e-3))
        mount = Mount(axis, length=float(data.ten_length[0]), **place)  # type: ignore[arg-type]
        cylinders = Cylinders(model, data, {"lift": mount})
        cylinders.by_name["lift"].cylinder.pressurise(5.5e5, 2.0e5)
        for _ in range(300):
            cylinders.step({"lift": 2.5})
        one = cylinders.by_name["lift"]
        found.append((float(data.qpos[0]), one.position, one.mass, *one.cylinder.pressures))
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_forces_from_outside_are_kept_and_seen() -> None:
    model, data = made(SLIDE)
    cylinders = Cylinders(model, data, {"one": Mount(load_model("axis"), joint="rod")})
    data.qfrc_applied[0] = 50.0  # below the static friction of 100 N
    for _ in range(300):
        cylinders.step({})
    assert data.qfrc_applied[0] == 50.0
    assert abs(data.qpos[0]) < 2e-4
    data.qfrc_applied[0] = 150.0
    for _ in range(300):
        cylinders.step({})
    assert data.qpos[0] > 2e-3


def test_mistakes_are_named() -> None:
    axis = load_model("axis")
    model, data = made(ARM.format(step=1e-3))
    for mount, words in (
        (Mount(axis, tendon="lft"), "unknown tendon 'lft'; did you mean lift"),
        (Mount(axis, joint="shoulder"), "joint shoulder does not slide"),
        (Mount(axis), "takes one of tendon, joint and sites; it has none"),
        (Mount(axis, joint="shoulder", sites=("base", "clevis")), "it has joint and sites"),
        (Mount(axis, sites=("base", "clvis")), "unknown site 'clvis'; did you mean clevis"),
        (Mount(axis.with_parameters({"piston.stroke": 0.1}), tendon="lift"), "outside of its stroke"),
    ):
        with pytest.raises(UsageError, match=words):
            Cylinders(model, data, {"one": mount})
    cylinders = Cylinders(model, data, {"one": Mount(axis, tendon="lift", length=float(data.ten_length[0]))})
    with pytest.raises(UsageError, match="unknown cylinder 'two'"):
        cylinders.step({"two": 1.0})
    stages = mujoco.MjModel.from_xml_string(SLIDE.replace("<option", '<option integrator="RK4"'))
    with pytest.raises(UsageError, match="integrator='implicitfast'"):
        Cylinders(stages, mujoco.MjData(stages), {"one": Mount(axis, joint="rod")})
