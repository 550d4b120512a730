"""Forward kinematics of a URDF: poses of its links for given joint positions."""

from collections.abc import Mapping
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def poses(robot: ElementTree.Element, joints: Mapping[str, float]) -> dict[str, Array]:
    """Pose (4, 4) of every link in the frame of base_link; `joints` gives positions [m], those left out are 0."""
    found = {"base_link": np.eye(4)}
    waiting = list(robot.findall("joint"))
    while waiting:
        ready = [joint for joint in waiting if _link(joint, "parent") in found]
        assert ready, f"no chain to base_link: {[joint.get('name') for joint in waiting]}"
        for joint in ready:
            moved = _slide(joint, joints.get(str(joint.get("name")), 0.0))
            found[_link(joint, "child")] = found[_link(joint, "parent")] @ origin(joint) @ moved
            waiting.remove(joint)
    return found


def origin(element: ElementTree.Element) -> Array:
    """Transform (4, 4) that the <origin> in an element describes; the unit matrix where there is none."""
    found, transform = element.find("origin"), np.eye(4)
    if found is not None:
        transform[:3, :3] = _rotation(*_numbers(found.get("rpy", "0 0 0")))
        transform[:3, 3] = _numbers(found.get("xyz", "0 0 0"))
    return transform


def _rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll), the order of URDF."""
    (c_r, c_p, c_y), (s_r, s_p, s_y) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, c_r, -s_r], [0, s_r, c_r]])
    about_y = np.array([[c_p, 0, s_p], [0, 1, 0], [-s_p, 0, c_p]])
    about_z = np.array([[c_y, -s_y, 0], [s_y, c_y, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def _slide(joint: ElementTree.Element, position: float) -> Array:
    transform = np.eye(4)
    axis = joint.find("axis")
    if joint.get("type") == "prismatic" and axis is not None:
        transform[:3, 3] = position * _numbers(axis.get("xyz", "1 0 0"))
    return transform


def _link(joint: ElementTree.Element, side: str) -> str:
    found = joint.find(side)
    assert found is not None
    return str(found.get("link"))


def _numbers(text: str) -> Array:
    return np.array([float(number) for number in text.split()])
