"""Which packages must be installed, with advice for those that are missing; and a ROS domain for one process.

Imports only the standard library, so that it can report when everything else is missing.
"""

import importlib.util
import os
import socket
import sys
from collections.abc import Iterable

from pneumo_ros.errors import UsageError

WHEELS = ((3, 10), (3, 13))  # the Pythons rclpy wheels exist for
ROS_MODULES = (
    "rclpy",
    "diagnostic_msgs",
    "rcl_interfaces",
    "rosgraph_msgs",
    "sensor_msgs",
    "std_msgs",
    "std_srvs",
    "trajectory_msgs",
)
# import name -> package name of pip; that of Debian and Ubuntu, where they have one
LIBRARIES = {
    "numpy": ("numpy", "python3-numpy"),
    "scipy": ("scipy", "python3-scipy"),
    "numba": ("numba", "python3-numba"),
    "yaml": ("pyyaml", "python3-yaml"),
    "rosbags": ("rosbags", None),
    "mcap": ("mcap", None),
    "apsw": ("apsw", None),  # these three come with rosbags and mcap
    "lz4": ("lz4", None),
    "zstandard": ("zstandard", None),
    "threadpoolctl": ("threadpoolctl", "python3-threadpoolctl"),  # saves processor time only
    "plotly": ("plotly", "python3-plotly"),  # for reports only, and so is the next
    "matplotlib": ("matplotlib", "python3-matplotlib"),
    "dash": ("dash", None),  # for the workbench only, and so is the next
    "waitress": ("waitress", "python3-waitress"),
    "rich": ("rich", "python3-rich"),  # for pneumo view only
    "distributed": ("distributed", None),  # for sweeps over a Dask cluster only
    "pyarrow": ("pyarrow", None),  # for tables in Parquet only
    "argcomplete": ("argcomplete", "python3-argcomplete"),  # for the shell's completion only
    "pandas": ("pandas", "python3-pandas"),  # for to_dataframe only
    "mujoco": ("mujoco", None),  # for cylinders on arms of MuJoCo only
    "pinocchio": ("pin", None),  # for machine files that name a URDF only
}
OPTIONAL = (
    "threadpoolctl",
    "plotly",
    "matplotlib",
    "dash",
    "waitress",
    "rich",
    "distributed",
    "pyarrow",
    "argcomplete",
    "pandas",
    "mujoco",
    "pinocchio",
)
NEEDED = tuple(name for name in LIBRARIES if name not in OPTIONAL)
DOMAINS = range(1, 102)  # ports of higher domains overlap those that the system assigns to other programs


class MissingDependencyError(UsageError, ImportError):
    """A package that is not installed; the message is one sentence with the command that installs it."""


def missing(modules: Iterable[str]) -> list[str]:
    """The `modules` that Python cannot find. Nothing is imported."""
    return [name for name in modules if importlib.util.find_spec(name) is None]


def require_libraries(modules: Iterable[str] = NEEDED) -> None:
    """MissingDependencyError unless every one of the third-party `modules` is installed."""
    absent = missing(modules)
    if absent:
        raise MissingDependencyError(library_advice(absent))


def require_ros() -> None:
    """MissingDependencyError unless rclpy, the messages and the libraries of the nodes are installed."""
    absent = missing(ROS_MODULES)
    if absent:
        raise MissingDependencyError(ros_advice(absent, sys.version_info[:2], os.environ.get("ROS_DISTRO", "")))
    require_libraries()


def library_advice(absent: list[str]) -> str:
    """One sentence: what is missing and how to install it."""
    pip = " ".join(LIBRARIES.get(name, (name, None))[0] for name in absent)
    apt = [LIBRARIES.get(name, (name, None))[1] for name in absent]
    advice = f"{_listed(absent)} not installed in {sys.executable}; type: {sys.executable} -m pip install {pip}"
    if all(apt):
        advice += f" (or, on Debian and Ubuntu: sudo apt install {' '.join(str(name) for name in apt)})"
    return advice


def ros_advice(absent: list[str], python: tuple[int, int], distribution: str) -> str:
    """One sentence: which part of ROS 2 is missing and how to install it for this Python.

    `python` is (major, minor), `distribution` the value of ROS_DISTRO, empty when none is sourced.
    """
    first = f"{_listed(absent)} not installed for Python {python[0]}.{python[1]}"
    if distribution:
        packages = " ".join(f"ros-{distribution}-{name.replace('_', '-')}" for name in absent)
        return f"{first}, although ROS 2 {distribution} is sourced; type: sudo apt install {packages}"
    if not WHEELS[0] <= python <= WHEELS[1]:
        (_, low), (_, high) = WHEELS
        return (
            f"{first}, and its wheels exist for Python 3.{low} to 3.{high} only; make an environment with one of "
            "these (python3.12 -m venv .venv) or source a ROS 2 distribution (source /opt/ros/jazzy/setup.bash)"
        )
    return (
        f"{first}; type: pip install 'pneumo_ros[ros]' (x86_64 Linux), "
        "or source a ROS 2 distribution: source /opt/ros/jazzy/setup.bash"
    )


def _listed(names: list[str]) -> str:
    return f"{', '.join(names)} {'is' if len(names) == 1 else 'are'}"


class Domain:
    """A ROS domain that nothing else on this machine uses, reserved until `close`: its number and its environment.

    The reservation is a socket in Linux's abstract name space, which ends with the process. Nodes that were started
    without this class are recognised by the ports they listen on (RTPS 2.2, 9.6.1.1: one shared, two for the process
    of each node). Raises UsageError when all domains are in use.
    """

    def __init__(self, wanted: Iterable[int] = DOMAINS) -> None:
        for number in wanted:
            holder = _hold(number)
            if holder is None:
                continue
            if _listened_to(number):
                holder.close()
                continue
            self.number, self._holder = number, holder
            return
        raise UsageError("every ROS domain from 1 to 101 is in use on this machine; stop some ROS 2 programs")

    @property
    def environment(self) -> dict[str, str]:
        """Variables for nodes that see only each other: this domain, this machine, UDP."""
        return {
            "ROS_DOMAIN_ID": str(self.number),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        }

    def close(self) -> None:
        """Release the domain."""
        self._holder.close()


def _hold(number: int) -> socket.socket | None:
    holder = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        holder.bind(f"\0pneumo_ros/domain/{number}")
    except OSError:
        holder.close()
        return None
    return holder


def _listened_to(number: int) -> bool:
    base = 7400 + 250 * number
    return any(_taken(port) for port in (base, *range(base + 10, base + 26, 2)))


def _taken(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return True
    return False
