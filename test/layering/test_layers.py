"""Dependencies point one way, and only the nodes know ROS."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from hiding import environment_without

import pneumo_ros

PACKAGE = Path(pneumo_ros.__file__).parent
ROOT = {
    "errors",
    "nearest",
    "files",
    "environment",
    "yaml_text",
    "__init__",
}  # beneath every room; they import each other only

# What each room may import besides itself and the modules above
ALLOWED = {
    "plant": set(),
    "records": set(),
    "control": set(),
    "config": set(),
    "sweep": set(),
    "fleet": {"sweep", "discover", "diagnose", "identify", "plant", "records", "control"},
    "identify": {"plant", "records", "control"},
    "diagnose": {"identify", "plant", "records", "control"},
    "experiment": {"identify", "plant", "records", "control"},
    "discover": {"diagnose", "identify", "plant", "records", "control"},
    "report": {"fleet", "discover", "diagnose", "identify", "plant", "records", "control"},
    "workbench": {"report", "discover", "experiment", "diagnose", "identify", "plant", "records", "control"},
    "ros": {"discover", "experiment", "diagnose", "identify", "plant", "records", "control"},
    "command": {
        "workbench",
        "fleet",
        "sweep",
        "report",
        "discover",
        "experiment",
        "diagnose",
        "identify",
        "plant",
        "records",
        "control",
    },
    "__main__": {"command"},
}
ROS = {"rclpy", "ament_index_python", "launch", "launch_ros", "rosidl_runtime_py", "rosbag2_py"}


def is_ros(module: str) -> bool:
    """Whether a top-level module comes with ROS: its libraries, and the packages of messages."""
    return module in ROS or module.endswith(("_msgs", "_srvs", "_interfaces"))


def imports(path: Path) -> set[str]:
    """Absolute names of all modules a file imports, wherever in the file it does so."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import; write it in full"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


FILES = sorted(PACKAGE.rglob("*.py"))


def room_of(path: Path) -> str:
    """The part of the package a file belongs to: its top folder, or its own name."""
    first = path.relative_to(PACKAGE).parts[0]
    return first.removesuffix(".py")


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_a_file_imports_only_what_lies_below_it(path: Path) -> None:
    room = room_of(path)
    allowed = ROOT if room in ROOT else ROOT | {room} | ALLOWED[room]
    ours = {name.split(".")[1] for name in imports(path) if name.startswith("pneumo_ros.")}
    ours.discard("__version__")
    assert ours <= allowed, f"{room} must not import {sorted(ours - allowed)}"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_only_nodes_import_ros(path: Path) -> None:
    ros = sorted(name for name in imports(path) if is_ros(name.partition(".")[0]))
    assert not ros or room_of(path) == "ros", f"imports {ros}"


def test_every_room_has_its_rule() -> None:
    rooms = {room_of(path) for path in FILES} - ROOT
    assert rooms <= set(ALLOWED), f"say in ALLOWED what these may import: {sorted(rooms - set(ALLOWED))}"


def test_physics_recordings_and_verbs_run_without_ros(tmp_path: Path) -> None:
    """With rclpy and the messages hidden from Python, everything but the nodes still imports."""
    modules = [
        ".".join(("pneumo_ros", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")
        for path in FILES
        if room_of(path) not in ("ros", "__main__")
    ]
    program = f"import importlib\nfor module in {modules!r}:\n    importlib.import_module(module)"
    environment = environment_without(tmp_path, *ROS)
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


def test_importing_the_package_and_help_load_nothing_slow() -> None:
    """`pneumo --help` answers at once, and even where nothing but Python is installed."""
    program = (
        "import sys; from pneumo_ros.command.main import main; code = main(['--help']); "
        "print(sorted({'rclpy', 'numpy', 'scipy', 'numba', 'rosbags', 'mcap', 'yaml'} & set(sys.modules)), code)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "[] 0", done.stdout + done.stderr
