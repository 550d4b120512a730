"""The URDFs: xacro makes them, they are one tree with joints that slide, and ros2_control finds its topics."""

import math
from pathlib import Path
from xml.etree import ElementTree

import pytest

from pneumo_ros.control import Machine, ValveInverse
from pneumo_ros.control.motion.capability import Capability
from pneumo_ros.plant import load_model

xacro = pytest.importorskip("xacro", reason="comes with the dev extra, or with a ROS 2 distribution")
URDF = Path(__file__).parents[2] / "urdf"
CONFIG = Path(__file__).parents[2] / "config"
PLUGINS = {
    "JointStateTopicSystem": "joint_state_topic_hardware_interface/JointStateTopicSystem",
    "TopicBasedSystem": "topic_based_ros2_control/TopicBasedSystem",
}
JOINTS = {"axis.urdf.xacro": ["piston"], "pruning_arm.urdf.xacro": ["lift_piston", "reach_piston"]}


def made(file: str, **arguments: str) -> ElementTree.Element:
    """The robot that xacro makes of a file."""
    return ElementTree.fromstring(xacro.process_file(str(URDF / file), mappings=arguments).toxml())


@pytest.mark.parametrize("file", JOINTS)
def test_it_is_one_tree(file: str) -> None:
    robot = made(file)
    links = [link.get("name") for link in robot.findall("link")]
    children = [joint.find("child").get("link") for joint in robot.findall("joint")]
    parents = [joint.find("parent").get("link") for joint in robot.findall("joint")]
    assert len(set(links)) == len(links)
    assert len(set(children)) == len(children)
    assert set(links) - set(children) == {"base_link"}
    assert set(parents) <= set(links)


MACHINES = {
    "piston": "axis",
    "lift_piston": CONFIG / "arm" / "lift.yaml",
    "reach_piston": CONFIG / "arm" / "reach.yaml",
}


@pytest.mark.parametrize("file", JOINTS)
def test_joints_slide_as_far_and_as_fast_as_the_machine(file: str) -> None:
    slides = [joint for joint in made(file).findall("joint") if joint.get("type") == "prismatic"]
    assert [joint.get("name") for joint in slides] == JOINTS[file]
    for joint in slides:
        model = load_model(MACHINES[str(joint.get("name"))])
        machine = Machine.of(model.effects, model.parameters)
        limit = {key: float(value) for key, value in joint.find("limit").items()}
        assert (limit["lower"], limit["upper"]) == (-0.5 * machine.stroke, 0.5 * machine.stroke)
        force = (machine.supply_pressure - machine.atmospheric_pressure) * machine.area_a
        assert limit["effort"] == pytest.approx(force, rel=2e-3)
        top = Capability(machine, ValveInverse()).top_speed(1.0)
        assert limit["velocity"] == pytest.approx(top, rel=0.2)


def test_the_machines_of_the_arm_move_what_the_arm_weighs_and_can_lift_it() -> None:
    """The arm sank at 0 V, and no law could raise it, while each axis had the default machine without a load."""
    robot = made("pruning_arm.urdf.xacro")
    masses = {
        link.get("name"): float(link.find("inertial/mass").get("value"))
        for link in robot.findall("link")
        if link.find("inertial") is not None
    }
    above = {"reach_piston": ["reach_piston_rod", "shears"]}
    above["lift_piston"] = [*above["reach_piston"], "lift_piston_rod", "boom", "reach_piston_tube"]
    for joint, links in above.items():
        model = load_model(MACHINES[joint])
        assert model["piston.mass"] == pytest.approx(sum(masses[link] for link in links)), joint
        able = Capability(Machine.of(model.effects, model.parameters), ValveInverse())
        assert all(able.breakaway(side) < 0.5 * float(able.force(0.0, side)) for side in (1.0, -1.0))
    lift = load_model(MACHINES["lift_piston"])
    assert lift["constant_load.load"] == pytest.approx(9.81 * lift["piston.mass"], rel=1e-3)


@pytest.mark.parametrize("file", JOINTS)
def test_everything_that_moves_has_an_inertia_that_a_body_can_have(file: str) -> None:
    bodies = [link for link in made(file).findall("link") if link.find("inertial") is not None]
    assert len(bodies) >= 2
    for link in bodies:
        inertia = link.find("inertial").find("inertia")
        xx, yy, zz = (float(inertia.get(name)) for name in ("ixx", "iyy", "izz"))
        assert min(xx, yy, zz) > 0.0
        assert xx + yy >= zz
        assert yy + zz >= xx
        assert zz + xx >= yy


@pytest.mark.parametrize("file", JOINTS)
def test_tubes_and_rods_have_the_inertia_of_full_cylinders(file: str) -> None:
    """m r^2 / 2 about their axis, which is x, and m (3 r^2 + l^2) / 12 across it."""
    links = [link for link in made(file).findall("link") if (link.get("name") or "").endswith(("_tube", "_rod"))]
    assert len(links) == 2 * len(JOINTS[file])
    for link in links:
        shape, body = link.find("visual/geometry/cylinder"), link.find("inertial")
        r, length, m = float(shape.get("radius")), float(shape.get("length")), float(body.find("mass").get("value"))
        across = m * (3.0 * r**2 + length**2) / 12.0
        inertia = {key: float(value) for key, value in body.find("inertia").items()}
        assert [inertia[key] for key in ("ixx", "iyy", "izz")] == pytest.approx([0.5 * m * r**2, across, across])


@pytest.mark.parametrize("plugin", PLUGINS)
@pytest.mark.parametrize("file", JOINTS)
def test_each_cylinder_has_a_ros2_control_block_of_its_own(file: str, plugin: str) -> None:
    blocks = made(file, plugin=plugin).findall("ros2_control")
    assert len(blocks) == len(JOINTS[file])
    for block, name in zip(blocks, JOINTS[file], strict=True):
        hardware = block.find("hardware")
        given = {one.get("name"): one.text for one in hardware.findall("param")}
        place = "" if name == "piston" else f"/{name.removesuffix('_piston')}"
        assert hardware.find("plugin").text == PLUGINS[plugin]
        assert given == {
            "joint_commands_topic": f"{place}/joint_commands",
            "joint_states_topic": f"{place}/joint_states",
            "trigger_joint_command_threshold": "-1",
        }
        (joint,) = block.findall("joint")
        assert joint.get("name") == name
        assert [one.get("name") for one in joint.findall("command_interface")] == ["position", "velocity"]
        assert [one.get("name") for one in joint.findall("state_interface")] == ["position", "velocity", "effort"]


def test_names_are_arguments() -> None:
    robot = made("axis.urdf.xacro", joint="arm", namespace="cylinder_1", stroke="0.3")
    (joint,) = [joint for joint in robot.findall("joint") if joint.get("type") == "prismatic"]
    assert joint.get("name") == "arm"
    assert math.isclose(float(joint.find("limit").get("upper")), 0.15)
    assert robot.find("ros2_control/hardware/param").text == "/cylinder_1/joint_commands"
