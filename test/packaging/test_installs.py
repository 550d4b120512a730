"""The same tree installs with pip and with colcon, and what is installed runs."""

import os
import shlex
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

import pneumo_ros

ROOT = Path(__file__).parents[2]
CONFIG = sorted(path.relative_to(ROOT / "pneumo_ros") for path in (ROOT / "pneumo_ros" / "config").rglob("*.[yrxj]*"))
LAUNCH = sorted(path.name for path in (ROOT / "launch").glob("*.launch.py"))
URDF = sorted(path.name for path in (ROOT / "urdf").glob("*.xacro"))
EXECUTABLES = (
    "pneumo",
    "simulator",
    "controller",
    "axis",
    "recorder",
    "player",
    "experiment",
    "identification",
    "commission",
)
pytestmark = pytest.mark.check
# A child must find its own libraries, not those of this session's environment
CLEAN = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "LD_LIBRARY_PATH", "AMENT_PREFIX_PATH")}


def run(*command: str | Path, folder: Path) -> str:
    """Output of a command that must succeed."""
    done = subprocess.run([str(part) for part in command], cwd=folder, env=CLEAN, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the checkout, so that no build writes into it."""
    target = tmp_path_factory.mktemp("tree") / "src" / "pneumo_ros"
    unwanted = shutil.ignore_patterns(".*", "*.egg-info", "__pycache__", "build", "install", "log", "demo_output")
    shutil.copytree(ROOT, target, symlinks=True, ignore=unwanted)
    return target


@pytest.fixture(scope="module")
def wheel(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel pip builds."""
    folder = tmp_path_factory.mktemp("wheel")
    arguments = ("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, tree)
    run(sys.executable, "-m", "pip", *arguments, folder=folder)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_carries_machine_files_and_share(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    share = f"pneumo_ros-{pneumo_ros.__version__}.data/data/share"
    assert CONFIG
    assert LAUNCH
    assert URDF
    assert {path.suffix for path in CONFIG} == {".yaml", ".rviz", ".xml", ".json"}
    for path in CONFIG:
        assert f"pneumo_ros/{path}" in names
        assert f"{share}/pneumo_ros/{path}" in names
    for launch in LAUNCH:
        assert f"{share}/pneumo_ros/launch/{launch}" in names
    for urdf in URDF:
        assert f"{share}/pneumo_ros/urdf/{urdf}" in names
    assert f"{share}/pneumo_ros/package.xml" in names
    assert f"{share}/ament_index/resource_index/packages/pneumo_ros" in names
    assert "pneumo_ros/py.typed" in names
    assert any(name.endswith("LICENSE") for name in names)


def test_the_wheel_carries_the_whole_package_and_nothing_else(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    present = (path for path in (ROOT / "pneumo_ros").rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    assert {str(path.relative_to(ROOT)) for path in present} <= names
    assert {name.partition("/")[0].partition("-")[0] for name in names} == {"pneumo_ros"}


def test_the_source_archive_makes_the_same_wheel(tree: Path, wheel: Path, tmp_path: Path) -> None:
    run(sys.executable, "setup.py", "-q", "sdist", "-d", tmp_path, folder=tree)
    (archive,) = tmp_path.glob("*.tar.gz")
    arguments = ("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", tmp_path, archive)
    run(sys.executable, "-m", "pip", *arguments, folder=tmp_path)
    (again,) = tmp_path.glob("*.whl")
    assert set(zipfile.ZipFile(again).namelist()) == set(zipfile.ZipFile(wheel).namelist())


def test_the_wheel_runs_away_from_the_checkout(wheel: Path, tmp_path: Path) -> None:
    arguments = ("install", "--no-deps", "--no-index", "--target", tmp_path / "site", wheel)
    run(sys.executable, "-m", "pip", *arguments, folder=tmp_path)
    program = f"""
import sys
sys.path.insert(0, {str(tmp_path / "site")!r})
import pneumo_ros
assert pneumo_ros.__file__.startswith({str(tmp_path)!r}), pneumo_ros.__file__
from pneumo_ros.plant import load_model
print(load_model("axis").effects)
"""
    assert "lugre_friction" in run(sys.executable, "-c", program, folder=tmp_path)


@pytest.fixture(scope="module", params=["copied", "symlinked"])
def workspace(request: pytest.FixtureRequest, tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A colcon workspace in which the package is built."""
    folder = tmp_path_factory.mktemp(request.param)
    colcon = Path(sys.executable).with_name("colcon")
    if not colcon.exists():
        pytest.skip("colcon is not installed; it comes with the dev extra")
    options = ("--symlink-install",) if request.param == "symlinked" else ()
    run(colcon, "--log-base", "log", "build", "--base-paths", tree, *options, folder=folder)
    return folder


def sourced(workspace: Path, command: str) -> str:
    """Output of a shell command after sourcing the workspace."""
    if " " in str(workspace):
        pytest.skip("the setup.sh that colcon writes does not stand a space in its path")
    return run("/bin/sh", "-c", f". ./install/setup.sh && {command}", folder=workspace)


def test_colcon_puts_executables_where_ros2_run_looks(workspace: Path) -> None:
    folder = workspace / "install" / "pneumo_ros" / "lib" / "pneumo_ros"
    assert {path.name for path in folder.iterdir()} == set(EXECUTABLES)
    assert all(os.access(path, os.X_OK) for path in folder.iterdir())


def test_colcon_puts_data_where_ros2_looks(workspace: Path) -> None:
    share = workspace / "install" / "pneumo_ros" / "share"
    assert (share / "ament_index" / "resource_index" / "packages" / "pneumo_ros").exists()
    assert (share / "pneumo_ros" / "package.xml").exists()
    assert all((share / "pneumo_ros" / path).exists() for path in CONFIG)
    assert all((share / "pneumo_ros" / "launch" / launch).exists() for launch in LAUNCH)
    assert all((share / "pneumo_ros" / "urdf" / urdf).exists() for urdf in URDF)


def test_what_colcon_built_runs(workspace: Path) -> None:
    python = shlex.quote(sys.executable)
    where = sourced(workspace, f"{python} -c 'import pneumo_ros; print(pneumo_ros.__file__)'")
    assert str(workspace) in where, "the checkout was imported instead"
    assert "lugre_friction" in sourced(workspace, f"{python} install/pneumo_ros/lib/pneumo_ros/pneumo effects")
