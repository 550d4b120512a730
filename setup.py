"""Packaging for pip (`pip install .`, `pip install -e .`) and for colcon (ament_python): one file serves both."""

from pathlib import Path

from setuptools import find_packages, setup

NAME = "pneumo_ros"
HERE = Path(__file__).resolve().parent  # `colcon build --symlink-install` runs a link to this file from elsewhere

# Real rclpy without a ROS 2 distribution: x86_64 Linux, Python 3.10 to 3.13. On a distribution these come from
# apt, so they stay out of install_requires.
ROS_WHEELS = [
    "ros-kilted-rclpy",
    "ros-kilted-rmw-fastrtps-cpp",
    "ros-kilted-diagnostic-msgs",
    "ros-kilted-geometry-msgs",
    "ros-kilted-sensor-msgs",
    "ros-kilted-std-msgs",
    "ros-kilted-std-srvs",
    "ros-kilted-trajectory-msgs",
    "ros-rosgraph-msgs",
]
NEEDED = ["numpy", "scipy", "numba", "pyyaml", "rosbags>=0.11", "mcap", "apsw", "lz4", "zstandard", "threadpoolctl>=3"]
REPORT = ["plotly>=5"]  # the pages that --report writes
FIGURES = ["matplotlib>=3.5"]  # the files that --figures writes
WORKBENCH = ["dash>=4", *REPORT, "waitress>=2", "rich>=12"]  # the local page, and pneumo view
PARQUET = ["pyarrow>=14"]  # tables in Parquet, for pneumo import
DASK = ["distributed>=2024.1"]  # sweeps over a cluster
FRAMES = ["pandas>=1.5"]  # data frames of results, in Python
MUJOCO = ["mujoco>=3.1"]  # cylinders on arms
ARM = ["pin>=2.7"]  # Pinocchio: machine files that name a URDF
COMPLETION = ["argcomplete>=3"]  # for the script that pneumo completion writes
DOCS = ["sphinx>=7", "myst-parser>=2", "furo"]  # the manual
PEERS = ["pysindy>=2.1"]  # a method that benchmarks/bench_peers.py compares with
TEST = ["pytest>=7.4", "hypothesis>=6.80", "playwright", "xacro>=2.0", "nbclient>=0.8", "ipykernel>=6"]
TEST += ["fmpy>=0.3.20", "rumoca>=0.10"]  # importers of what pneumo export writes
TEST += ["rosdep>=0.25"]  # it reads package.xml
DEV = ["ruff>=0.9", "mypy>=1.13", "types-PyYAML", "pytest-xdist>=3"]
BUILD = ["setuptools>=64", "wheel", "colcon-core", "colcon-ros"]

CONFIG_FILES = ("yaml", "urdf", "rviz", "xml", "json")  # machines, controllers, layouts of other tools
OPTIONAL = [*REPORT, *FIGURES, *WORKBENCH, *DASK, *PARQUET, *FRAMES, *MUJOCO, *ARM, *COMPLETION]


def files(folder: str, pattern: str) -> list[str]:
    """Files under `folder` that match, without caches, relative to this file, as setup() wants them."""
    found = (path for path in Path(folder).glob(pattern) if path.is_file() and "__pycache__" not in path.parts)
    return sorted(map(str, found))


def shared(folder: str, pattern: str, target: str) -> list[tuple[str, list[str]]]:
    """data_files rows that keep the sub-folders of `folder` under share/pneumo_ros/`target`."""
    rows: dict[str, list[str]] = {}
    for name in files(folder, pattern):
        inner = Path(name).parent.relative_to(folder)
        rows.setdefault(str(Path("share") / NAME / target / inner), []).append(name)
    return sorted(rows.items())


setup(
    name=NAME,
    version="0.1.0",
    description="A pneumatic axis for ROS 2: simulate it, control it, record it, and find what its model is missing",
    long_description=(HERE / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    maintainer="pneumo_ros maintainers",
    maintainer_email="maintainers@pneumo-ros.example",
    license="Apache-2.0",
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    # Machine files and the like are read through importlib.resources, so they travel inside the package; share/ holds
    # the copy of the machine files that ROS users expect. An editable install has no share/.
    package_data={NAME: [str(Path(f).relative_to(NAME)) for f in files(NAME, "**/*") if not f.endswith(".py")]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        *(row for kind in CONFIG_FILES for row in shared(f"{NAME}/config", f"**/*.{kind}", "config")),
        *shared("launch", "**/*.launch.py", "launch"),
        *shared("urdf", "**/*.xacro", "urdf"),
    ],
    zip_safe=False,
    python_requires=">=3.10",
    install_requires=NEEDED,
    extras_require={
        "ros": ROS_WHEELS,
        "report": REPORT,
        "figures": FIGURES,
        "workbench": WORKBENCH,
        "dask": DASK,
        "parquet": PARQUET,
        "frames": FRAMES,
        "mujoco": MUJOCO,
        "arm": ARM,
        "completion": COMPLETION,
        "peers": PEERS,
        "docs": [*DOCS, *FIGURES],
        "test": TEST,
        "dev": [*OPTIONAL, *DOCS, *TEST, *DEV, *BUILD],
    },
    entry_points={
        "console_scripts": [
            "pneumo = pneumo_ros.command.main:main",
            "simulator = pneumo_ros.ros.simulator:main",
            "controller = pneumo_ros.ros.controller:main",
            "axis = pneumo_ros.ros.axis:main",
            "recorder = pneumo_ros.ros.recorder:main",
            "player = pneumo_ros.ros.player:main",
            "experiment = pneumo_ros.ros.experiment:main",
            "identification = pneumo_ros.ros.identification:main",
            "commission = pneumo_ros.ros.commission:main",
        ],
    },
)
