"""package.xml, setup.py and the change log agree, and name everything that the code needs."""

import ast
import importlib
import importlib.util
import re
import sys
from pathlib import Path
from typing import Any
from unittest import mock
from xml.etree import ElementTree

import pytest

import pneumo_ros
from pneumo_ros.environment import LIBRARIES, ROS_MODULES

ROOT = Path(__file__).parents[2]
PACKAGE_XML = ElementTree.parse(ROOT / "package.xml").getroot()
# import name -> rosdep key, where pip and rosdep use different names
ROSDEP = {name: f"python3-{name}" for name in (
    "numpy", "scipy", "numba", "yaml", "plotly", "matplotlib", "rich", "waitress",
    "argcomplete", "pandas",
)}  # fmt: skip
# rosbags, mcap and dash have no rosdep key; the former two bring three more; sweeps do without a cluster, most imports
# without Parquet; without threadpoolctl a diagnosis only takes longer
BY_PIP_ONLY = {
    "rosbags", "mcap", "apsw", "lz4", "zstandard", "dash", "distributed", "pyarrow", "mujoco", "pinocchio",
    "threadpoolctl",
}  # fmt: skip
WITHOUT_WHEELS = {"control_msgs"}  # without it there is no action; the rest works
# always installed with the other, in its version
PART_OF = {"builtin_interfaces": "std_msgs", "llvmlite": "numba", "flask": "dash", "werkzeug": "dash"}


def setup_arguments() -> dict[str, Any]:
    """The arguments that setup.py passes to setuptools."""
    specification = importlib.util.spec_from_file_location("setup_under_test", ROOT / "setup.py")
    assert specification is not None
    assert specification.loader is not None
    with mock.patch("setuptools.setup") as call, pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        specification.loader.exec_module(importlib.util.module_from_spec(specification))
    return dict(call.call_args.kwargs)


SETUP = setup_arguments()


def text_of(tag: str) -> str:
    """Text of the only element `tag` of package.xml."""
    (element,) = PACKAGE_XML.findall(tag)
    return (element.text or "").strip()


def third_party_imports() -> set[str]:
    """Top-level modules that the package imports and that are neither its own nor Python's."""
    names = set()
    for path in Path(pneumo_ros.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                names.add((node.module or "").partition(".")[0])
    return names - set(sys.stdlib_module_names) - {"pneumo_ros"}


def test_names_and_versions_agree() -> None:
    assert PACKAGE_XML.get("format") == "3"
    assert text_of("name") == SETUP["name"] == pneumo_ros.__name__
    assert text_of("version") == SETUP["version"] == pneumo_ros.__version__
    assert text_of("license") == SETUP["license"] == "Apache-2.0"
    assert PACKAGE_XML.find("maintainer").get("email") == SETUP["maintainer_email"]
    assert text_of("export/build_type") == "ament_python"


def test_the_newest_entry_of_the_change_log_is_this_version() -> None:
    log = (ROOT / "CHANGELOG.rst").read_text(encoding="utf-8")
    newest = re.search(r"^(Forthcoming|(\d+\.\d+\.\d+) \(\d{4}-\d\d-\d\d\))\n-+$", log, re.MULTILINE)
    assert newest is not None
    assert newest[1] == "Forthcoming" or newest[2] == pneumo_ros.__version__


def test_email_is_one_colcon_accepts() -> None:
    catkin_pkg = pytest.importorskip("catkin_pkg.package", reason="comes with the dev extra")
    package = catkin_pkg.parse_package(str(ROOT / "package.xml"), warnings=(warnings := []))
    package.validate(warnings=warnings)
    assert warnings == []


def test_everything_imported_is_declared() -> None:
    declared = {element.text for tag in ("depend", "exec_depend") for element in PACKAGE_XML.findall(tag)}
    extras = SETUP["extras_require"]
    asked = [*SETUP["install_requires"], *extras["report"], *extras["figures"], *extras["workbench"], *extras["dask"]]
    asked += [*extras["parquet"], *extras["completion"], *extras["frames"], *extras["mujoco"], *extras["arm"]]
    required = {re.split(r"[<>=]", name)[0] for name in asked}
    for name in third_party_imports():
        name = PART_OF.get(name, name)
        if name in LIBRARIES:
            assert LIBRARIES[name][0] in required
            assert name in BY_PIP_ONLY or ROSDEP[name] in declared
        else:
            assert name in declared, f"package.xml lacks <exec_depend>{name}</exec_depend>"
            if name in WITHOUT_WHEELS:
                continue
            wheels = {wheel.removeprefix("ros-kilted-").removeprefix("ros-") for wheel in extras["ros"]}
            # rcl_interfaces comes with rclpy's wheel
            assert name.replace("_", "-") in wheels | {"rcl-interfaces"}, f"extra [ros] lacks {name}"
            assert name in ROS_MODULES, f"environment.ROS_MODULES lacks {name}"


def test_ros_wheels_are_not_required() -> None:
    assert not [name for name in SETUP["install_requires"] if name.startswith("ros-")]


def test_every_executable_has_its_function() -> None:
    for point in SETUP["entry_points"]["console_scripts"]:
        module, _, function = point.partition(" = ")[2].partition(":")
        assert callable(getattr(importlib.import_module(module), function)), point


def test_setup_cfg_holds_only_where_executables_go() -> None:
    assert (ROOT / "setup.cfg").read_text(encoding="utf-8").split() == [
        "[develop]",
        "script_dir=$base/lib/pneumo_ros",
        "[install]",
        "install_scripts=$base/lib/pneumo_ros",
    ]


def test_config_is_found_at_the_top_too() -> None:
    assert (ROOT / "config" / "axis.yaml").samefile(ROOT / "pneumo_ros" / "config" / "axis.yaml")
