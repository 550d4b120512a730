"""`rosdep install`, as the manual says it: every key of package.xml is found and installed. It is only simulated.

rosdep reads its databases on the network; here they are files: the keys that its index has for Ubuntu, and a
distribution of the ROS packages. A key of package.xml that is not among them is misspelt, or has no package.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from manual.pages import ROOT, statements

PYTHON = [
    "numpy",
    "scipy",
    "numba",
    "yaml",
    "plotly",
    "matplotlib",
    "rich",
    "waitress",
    "argcomplete",
    "pandas",
    "pytest",
]
SYSTEM = [f"python3-{name}" for name in PYTHON]  # keys and Ubuntu's packages of the same name
RELEASED = [
    "rclpy", "diagnostic_msgs", "rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "std_msgs", "std_srvs",
    "trajectory_msgs", "launch", "launch_ros", "control_msgs", "controller_manager", "joint_state_broadcaster",
    "joint_state_publisher", "joint_state_topic_hardware_interface", "joint_trajectory_controller",
    "robot_state_publisher", "rviz2", "xacro",
]  # fmt: skip
LINE = next(one.text for one in statements(ROOT / "docs" / "nodes.md") if one.text.startswith("rosdep "))


def rosdep(line: str, place: Path) -> "subprocess.CompletedProcess[str]":
    """A command line of rosdep in the workspace, on Ubuntu and Jazzy, with the databases in `place`."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    here = {
        "ROSDEP_SOURCE_PATH": str(place / "sources"), "ROSDISTRO_INDEX_URL": (place / "index-v4.yaml").as_uri(),
        "ROS_HOME": str(place / "home"), "ROS_DISTRO": "jazzy", "ROS_OS_OVERRIDE": "ubuntu:24.04:noble",
    }  # fmt: skip
    return subprocess.run(
        ["bash", "-c", line], cwd=place / "ws", env=os.environ | here | {"PATH": path}, capture_output=True, text=True
    )


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Databases, as `rosdep update` has read them, and a workspace with this package."""
    pytest.importorskip("rosdep2", reason="rosdep; it comes with the extra 'dev'")
    place = tmp_path_factory.mktemp("rosdep")
    source = place / "ws" / "src" / "pneumo_ros"
    for folder in (source, place / "sources", place / "jazzy"):
        folder.mkdir(parents=True)
    shutil.copy(ROOT / "package.xml", source)
    (place / "sources" / "20-default.list").write_text(f"yaml {(place / 'base.yaml').as_uri()}\n")
    release = {
        "packages": RELEASED, "version": "1.0.0-1", "url": "https://ros.example/released.git",
        "tags": {"release": "release/jazzy/{package}/{version}"},
    }  # fmt: skip
    for name, content in {
        "base.yaml": {key: {"ubuntu": [key]} for key in SYSTEM},
        "index-v4.yaml": {
            "type": "index",
            "version": 4,
            "distributions": {"jazzy": {"distribution": ["jazzy/distribution.yaml"], "distribution_type": "ros2"}},
        },
        "jazzy/distribution.yaml": {
            "type": "distribution",
            "version": 2,
            "release_platforms": {"ubuntu": ["noble"]},
            "repositories": {"released": {"release": release}},
        },
    }.items():
        (place / name).write_text(yaml.safe_dump(content))
    done = rosdep("rosdep update", place)
    assert done.returncode == 0, done.stdout + done.stderr
    return place


def test_the_line_of_the_manual_installs_every_package(place: Path) -> None:
    done = rosdep(f"{LINE} --simulate --reinstall", place)  # what this machine has already counts too
    assert done.returncode == 0, done.stdout + done.stderr
    named = set(re.findall(r"^\s*(?:sudo -H )?apt-get install (\S+)", done.stdout, re.MULTILINE))
    assert named == {*SYSTEM, *(f"ros-jazzy-{name.replace('_', '-')}" for name in RELEASED)}
