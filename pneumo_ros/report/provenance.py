"""The origin of a report: files with sizes and hashes, versions, command line, date."""

import hashlib
import platform
import shlex
from collections.abc import Iterable, Sequence
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import pneumo_ros
from pneumo_ros.plant.machine_file import read_machine

_LIBRARIES = ("numpy", "scipy", "numba", "rosbags", "mcap", "plotly")


def provenance(
    bags: Iterable[str | Path], machine: str | None, arguments: Sequence[str], effects: Iterable[str | Path] = ()
) -> dict[str, Any]:
    """JSON: `files`, `versions`, `command` and `created` (UTC); `arguments` are those after the program's name.

    `machine`: None where it is no file.
    """
    found = [_file(path, "recording") for bag in bags for path in _files_of(Path(bag))]
    found += [] if machine is None else [_machine(machine)]
    found += [_file(Path(path), "effects") for path in effects]
    return {
        "files": found,
        "versions": {
            "pneumo_ros": pneumo_ros.__version__,
            "Python": platform.python_version(),
            **{name: _version(name) for name in _LIBRARIES},
            "system": platform.platform(),
        },
        "command": shlex.join(["pneumo", *arguments]),
        "created": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M:%S UTC"),
    }


def _files_of(bag: Path) -> list[Path]:
    """The files of a recording: itself, or those in its folder."""
    return sorted(path for path in bag.iterdir() if path.is_file()) if bag.is_dir() else [bag]


def _file(path: Path, role: str) -> dict[str, Any]:
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        while chunk := stream.read(1 << 20):
            digest.update(chunk)
    return {"file": str(path), "role": role, "bytes": path.stat().st_size, "sha256": digest.hexdigest()}


def _machine(name_or_path: str) -> dict[str, Any]:
    """A machine file, or a shipped one by its name."""
    data = read_machine(name_or_path)[1].encode("utf-8")
    return {
        "file": name_or_path,
        "role": "machine file",
        "bytes": len(data),
        "sha256": hashlib.sha256(data).hexdigest(),
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "-"
