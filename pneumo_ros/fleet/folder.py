"""Recordings in a folder, by machine and campaign."""

import hashlib
from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import NamedTuple

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.records import Bag

LAYOUT = "FOLDER/MACHINE/RECORDING, or FOLDER/MACHINE/CAMPAIGN/RECORDING"
MACHINE_FILE = "machine.yaml"  # in the folder of a machine: its own model
RIG_FILE = "rig.yaml"  # likewise: how it is wired, and its machine file where MACHINE_FILE is not there
_FILES = (".mcap", ".db3")


class Campaign(NamedTuple):
    """Recordings of one machine in one state; `start` [ns since the epoch] of the first."""

    machine: str
    name: str
    start: int
    paths: tuple[Path, ...]
    machine_file: Path | None
    rig_file: Path | None = None

    @property
    def key(self) -> str:
        """Its unique name in the folder."""
        return f"{self.machine}/{self.name}"

    @property
    def fingerprint(self) -> str:
        """Its key and a hash of its files' names, sizes and times: changed files are examined again."""
        digest = hashlib.sha256()
        for path in self.paths:
            for file in sorted(path.iterdir()) if path.is_dir() else (path,):
                seen = file.stat()
                digest.update(f"{path.name}/{file.name} {seen.st_size} {seen.st_mtime_ns}\n".encode())
        for own in (self.machine_file, self.rig_file):
            digest.update(own.read_bytes() if own else b"")
        return f"{self.key} {digest.hexdigest()[:16]}"

    @property
    def date(self) -> str:
        """Day and time of its first recording, UTC, in ISO 8601."""
        return datetime.fromtimestamp(self.start // 1_000_000_000, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def campaigns(folder: str | Path) -> tuple[list[Campaign], dict[str, str]]:
    """The campaigns in `folder`, by machine and time, and by path why recordings are skipped.

    A folder of recordings inside that of a machine is a campaign; those directly in the folder of a machine are one
    for each day, UTC. Raises UsageError when there is no folder, DataError when it holds no recordings in this layout.
    """
    root = Path(folder)
    if not root.is_dir():
        raise UsageError(f"there is no folder {root}; pneumo fleet takes {LAYOUT}")
    passed: dict[str, str] = {}
    found: list[Campaign] = []
    for machine in _folders(root):
        model, rig = (own if (own := machine / name).is_file() else None for name in (MACHINE_FILE, RIG_FILE))
        for name, paths in _groups(machine, passed):
            start = min(start for start, _ in paths)
            found.append(Campaign(machine.name, name, start, tuple(path for _, path in paths), model, rig))
    if not found:
        why = f"; the last one: {list(passed.values())[-1]}" if passed else ""
        raise DataError(f"{root} holds no recordings of machines; they are laid out as {LAYOUT}{why}")
    return sorted(found, key=lambda one: (one.machine, one.start, one.name)), passed


def _groups(machine: Path, passed: dict[str, str]) -> Iterator[tuple[str, list[tuple[int, Path]]]]:
    """Name, and recordings with their starts, of each campaign of a machine."""
    days: dict[str, list[tuple[int, Path]]] = {}
    for start, path in _started(machine, passed):
        day = datetime.fromtimestamp(start // 1_000_000_000, timezone.utc).strftime("%Y-%m-%d")
        days.setdefault(day, []).append((start, path))
    yield from days.items()
    for inner in _folders(machine):
        if not _is_recording(inner) and (paths := _started(inner, passed)):
            yield inner.name, paths


def _started(folder: Path, passed: dict[str, str]) -> list[tuple[int, Path]]:
    """The recordings directly in `folder`, each with the time of its first message [ns]."""
    found = []
    for path in sorted(folder.iterdir()):
        if path.suffix in _FILES if path.is_file() else path.is_dir() and _is_recording(path):
            try:
                first = next(Bag(path).messages(), None)
            except DataError as error:
                passed[str(path)] = str(error)
                continue
            if first is None:
                passed[str(path)] = f"{path} holds no messages"
            else:
                found.append((max(first.log_time, 0), path))
    return found


def _folders(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.is_dir() and not path.name.startswith("."))


def _is_recording(folder: Path) -> bool:
    """Whether a folder is one recording; several bare files with different names are separate recordings."""
    if (folder / "metadata.yaml").exists():
        return True
    files = [path.stem.rpartition("_")[0] or path.stem for path in folder.iterdir() if path.suffix in _FILES]
    return len(set(files)) == 1 and files[0] == folder.name
