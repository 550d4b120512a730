"""Link positions of every URDF, compared with positions computed by hand."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from urdf.kinematics import origin, poses

xacro = pytest.importorskip("xacro", reason="comes with the dev extra, or with a ROS 2 distribution")
URDF = Path(__file__).parents[2] / "urdf"
ROBOTS = sorted(path.name for path in URDF.glob("*.urdf.xacro"))
HALF = 1.0  # m, half of the stroke: the range of every joint is -HALF to HALF

# link -> position [m] of its frame with all joints at 0: a cylinder's tip is one stroke (2 m) before the rod's frame,
# which at 0 lies in the middle of the tube
EXPECTED = {
    "axis.urdf.xacro": {"piston_tube": (0, 0, 0.05), "piston_rod": (0, 0, 0.05), "piston_tip": (2, 0, 0.05)},
    "pruning_arm.urdf.xacro": {
        "lift_piston_tube": (0, 0, 1.2), "lift_piston_rod": (0, 0, 1.2), "lift_piston_tip": (0, 0, 3.2),
        "boom": (0, 0, 3.2), "reach_piston_tube": (1.2, 0, 3.28), "reach_piston_rod": (1.2, 0, 3.28),
        "reach_piston_tip": (3.2, 0, 3.28), "shears": (3.2, 0, 3.28),
    },
}  # fmt: skip


def made(file: str) -> ElementTree.Element:
    """The robot that xacro makes of a file."""
    return ElementTree.fromstring(xacro.process_file(str(URDF / file)).toxml())


def test_every_robot_has_its_positions_here() -> None:
    assert sorted(EXPECTED) == ROBOTS


@pytest.mark.parametrize("file", ROBOTS)
def test_links_stand_where_they_were_mounted(file: str) -> None:
    found = poses(made(file), {})
    assert set(found) - {"base_link"} == set(EXPECTED[file])
    for link, position in EXPECTED[file].items():
        assert found[link][:3, 3] == pytest.approx(position, abs=1e-12), link


def test_the_lift_moves_up_and_the_reach_moves_out() -> None:
    robot = made("pruning_arm.urdf.xacro")
    shears = poses(robot, {"lift_piston": -0.5, "reach_piston": 0.25})["shears"]
    assert shears[:3, 3] == pytest.approx((3.45, 0, 2.78), abs=1e-12)
    assert shears[:3, :3] == pytest.approx(np.eye(3), abs=1e-12)


@pytest.mark.parametrize("position", [-HALF, 0.0, HALF])
@pytest.mark.parametrize("file", ROBOTS)
def test_links_and_their_masses_stay_above_the_floor(file: str, position: float) -> None:
    robot = made(file)
    slides = [str(joint.get("name")) for joint in robot.findall("joint") if joint.get("type") == "prismatic"]
    found = poses(robot, dict.fromkeys(slides, position))
    for link in robot.findall("link"):
        pose = found[str(link.get("name"))]
        frames = [pose, *(pose @ origin(part) for name in ("visual", "inertial") for part in link.findall(name))]
        assert min(frame[2, 3] for frame in frames) >= 0.0, link.get("name")


@pytest.mark.parametrize("file", ROBOTS)
def test_mass_and_collision_are_where_a_link_is_seen(file: str) -> None:
    """All bodies here are uniform, so that the centre of mass is the centre of the drawn shape."""
    for link in made(file).findall("link"):
        visual = link.find("visual")
        if visual is None or link.get("name") == "base_link":
            continue
        middle = origin(visual)[:3, 3]
        for name in ("inertial", "collision"):
            part = link.find(name)
            assert part is not None, f"{link.get('name')} has no {name}"
            assert origin(part)[:3, 3] == pytest.approx(middle), f"{link.get('name')}: {name}"
