"""Missing software gives one sentence with the remedy, and programs get a ROS domain of their own."""

import socket
import subprocess
import sys
from pathlib import Path

import pytest
from hiding import environment_without

from pneumo_ros.environment import Domain, library_advice, missing, require_ros, ros_advice
from pneumo_ros.errors import UsageError

NODES = ("simulator", "controller", "axis", "recorder", "player", "experiment", "identification", "commission")


def test_nothing_is_missing_here() -> None:
    require_ros()


def test_missing_modules_are_found_without_importing() -> None:
    assert missing(["json", "no_such_module"]) == ["no_such_module"]


def test_advice_fits_the_place() -> None:
    plain = ros_advice(["rclpy"], (3, 11), "")
    assert "pip install 'pneumo_ros[ros]'" in plain
    too_new = ros_advice(["rclpy"], (3, 14), "")
    assert "Python 3.10 to 3.13 only" in too_new
    assert "pip install 'pneumo_ros[ros]'" not in too_new
    distribution = ros_advice(["trajectory_msgs", "std_srvs"], (3, 12), "jazzy")
    assert "sudo apt install ros-jazzy-trajectory-msgs ros-jazzy-std-srvs" in distribution
    assert all("\n" not in text for text in (plain, too_new, distribution))


@pytest.mark.parametrize(("python", "wheels"), [((3, 9), False), ((3, 10), True), ((3, 13), True), ((3, 14), False)])
def test_wheels_are_offered_to_the_pythons_that_have_them(python: tuple[int, int], wheels: bool) -> None:
    assert ("pip install 'pneumo_ros[ros]'" in ros_advice(["rclpy"], python, "")) == wheels


def test_advice_names_packages_as_pip_and_apt_do() -> None:
    assert "-m pip install pyyaml (or, on Debian and Ubuntu: sudo apt install python3-yaml)" in library_advice(["yaml"])
    assert "apt" not in library_advice(["numba", "rosbags"]), "rosbags is in no distribution"


@pytest.mark.parametrize("node", NODES)
@pytest.mark.parametrize(
    ("hidden", "help_"), [("rclpy", "pip install 'pneumo_ros[ros]'"), ("numba", "-m pip install numba")]
)
def test_a_node_without_its_libraries_says_one_sentence(node: str, hidden: str, help_: str, tmp_path: Path) -> None:
    environment = environment_without(tmp_path, hidden)
    environment.pop("ROS_DISTRO", None)
    done = subprocess.run(
        [sys.executable, "-m", f"pneumo_ros.ros.{node}"], env=environment, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("pneumo_ros: error: ")
    assert done.stderr.count("\n") == 1
    assert help_ in done.stderr


def test_importing_the_nodes_without_ros_is_an_import_error(tmp_path: Path) -> None:
    program = "try:\n    import pneumo_ros.ros\nexcept ImportError as error:\n    print('caught', error)"
    environment = environment_without(tmp_path, "rclpy")
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=60)
    assert done.stdout.startswith("caught rclpy"), done.stderr


def test_two_programs_never_share_a_domain() -> None:
    one, other = Domain(), Domain()
    assert one.number != other.number
    one.close()
    other.close()


def test_a_closed_domain_is_free_again() -> None:
    one = Domain()
    one.close()
    again = Domain([one.number])
    assert again.number == one.number
    again.close()


@pytest.mark.parametrize("offset", [0, 10, 12, 24])
def test_a_domain_somebody_listens_in_is_left_alone(offset: int) -> None:
    free = Domain()
    free.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("", 7400 + 250 * free.number + offset))
        with pytest.raises(UsageError, match="in use"):
            Domain([free.number])


def test_nodes_of_a_domain_see_only_this_machine() -> None:
    domain = Domain()
    assert domain.environment["ROS_DOMAIN_ID"] == str(domain.number)
    assert domain.environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    domain.close()
