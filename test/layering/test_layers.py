"""Dependencies point one way, only the nodes know ROS, and CONTRIBUTING says so."""

import ast
import re
import subprocess
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

from hiding import environment_without

import pneumo_ros

PACKAGE = Path(pneumo_ros.__file__).parent
CONTRIBUTING = Path(__file__).parents[2] / "CONTRIBUTING.md"
# modules below every room
BESIDE = {"blas", "errors", "nearest", "files", "heap", "environment", "measured", "units", "yaml_text", "__init__"}
ROS = {"rclpy", "ament_index_python", "launch", "launch_ros", "rosidl_runtime_py", "rosbag2_py"}
FILES = sorted(PACKAGE.rglob("*.py"))


def is_ros(module: str) -> bool:
    """Whether a top-level module comes with ROS: its libraries, and the packages of messages."""
    return module in ROS or module.endswith(("_msgs", "_srvs", "_interfaces"))


@cache
def imports(path: Path) -> frozenset[str]:
    """Absolute names of all modules a file imports, wherever in the file it does so."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import; write it in full"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(names)


def room_of(path: Path) -> str:
    """The room of a file: its top folder, or its own name."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported_rooms() -> dict[str, set[str]]:
    """The rooms that each room imports; a name that is not a room means the package itself."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in FILES:
        ours = {name.split(".")[1] for name in imports(path) if name.startswith("pneumo_ros.")}
        found[room_of(path)] |= ours - {room_of(path), "__version__"}
    return found


def table() -> dict[str, tuple[str, list[str]]]:
    """The rooms that CONTRIBUTING lists, in its order: the sentence of each, and the rooms it imports."""
    rows = re.findall(r"^\| `(\w+)` \| (.+) \| (.*) \|$", CONTRIBUTING.read_text(encoding="utf-8"), re.MULTILINE)
    return {room: (what, re.findall(r"\w+", below)) for room, what, below in rows}


def test_contributing_lists_every_room_with_its_sentence() -> None:
    rooms = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert set(table()) == rooms
    for room, (what, _) in table().items():
        docstring = ast.get_docstring(ast.parse((PACKAGE / room / "__init__.py").read_text(encoding="utf-8"))) or ""
        assert what == docstring.splitlines()[0], f"{room}: its docstring and CONTRIBUTING differ"


def test_imports_are_those_that_contributing_lists() -> None:
    order = list(table())
    for room, found in imported_rooms().items():
        if room == "__init__":  # `import pneumo_ros as pn` offers what that room does, once it is asked for
            assert found <= {*BESIDE, "api"}
        elif room in BESIDE:
            assert found <= BESIDE, f"{room} must not import {sorted(found - BESIDE)}"
        elif room != "__main__":
            listed = table()[room][1]
            assert found - BESIDE == set(listed), f"{room}: CONTRIBUTING and the files differ"
            assert all(order.index(below) < order.index(room) for below in listed), f"{room} imports what is above it"


def test_only_nodes_import_ros() -> None:
    for path in FILES:
        ros = sorted(name for name in imports(path) if is_ros(name.partition(".")[0]))
        assert not ros or room_of(path) == "ros", f"{path} imports {ros}"


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
    """`pneumo --help` answers at once, even with only Python installed."""
    program = (
        "import sys; from pneumo_ros.command.main import main; code = main(['--help']); "
        "print(sorted({'rclpy', 'numpy', 'scipy', 'numba', 'rosbags', 'mcap', 'yaml'} & set(sys.modules)), code)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "[] 0", done.stdout + done.stderr
