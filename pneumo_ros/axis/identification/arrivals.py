"""Which recordings are there, and which of them are complete. No ROS.

A bag is complete when its writer has closed it: an MCAP file then ends with a summary, and the folder has its
metadata.yaml. A bag whose writer was killed is never closed; it counts as complete when it has not changed for a while.
"""

import struct
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from mcap.opcode import Opcode

from pneumo_ros.records.mcap_file import MAGIC

FILES = (".mcap", ".db3")
DEAD = 10.0  # s without a change after which the writer counts as dead
_FOOTER = struct.Struct("<BQQQI")  # opcode, length, start of the summary, start of its index, CRC

Print = tuple[tuple[str, int, int], ...]  # name, size and time of change of every file: differs when anything changed


@dataclass
class _Seen:
    mark: Print
    since: float


class Arrivals:
    """Looks at recordings again and again."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """`clock` returns the time [s]."""
        self._clock = clock
        self._seen: dict[Path, _Seen] = {}

    def look(self, named: Iterable[Path], folder: Path | None) -> tuple[dict[Path, Print], dict[Path, str]]:
        """Complete recordings, each with a mark that changes when it does, and sentences on those that are not.

        `named` are looked for where they are, others in `folder` and in the folders right below it.
        """
        ready: dict[Path, Print] = {}
        waiting: dict[Path, str] = {}
        for path in dict.fromkeys([*named, *(found(folder) if folder else ())]):
            mark = _mark(path)
            if not mark:
                waiting[path] = "does not exist yet" if not path.exists() else "holds no recording yet"
            elif self._complete(path, mark):
                ready[path] = mark
            else:
                waiting[path] = "is still being written"
        return ready, waiting

    def _complete(self, path: Path, mark: Print) -> bool:
        """Whether it has not changed since the last look, and is closed, or has not changed for long."""
        now, seen = self._clock(), self._seen.get(path)
        if seen is None or seen.mark != mark:
            self._seen[path] = _Seen(mark, now)
            return False
        return closed(path) or now - seen.since >= DEAD


def found(folder: Path) -> list[Path]:
    """Recordings in `folder` and in the folders right below it, by name; hidden ones are still being made."""
    if not folder.is_dir():
        return []
    entries = sorted(entry for entry in folder.iterdir() if not entry.name.startswith("."))
    bags = [entry for entry in entries if _is_recording(entry)]
    for deeper in (entry for entry in entries if entry.is_dir() and entry not in bags):
        bags += [entry for entry in sorted(deeper.iterdir()) if entry.name[0] != "." and _is_recording(entry)]
    return bags


def _is_recording(path: Path) -> bool:
    if path.is_dir():
        return any(entry.suffix in FILES for entry in path.iterdir())
    return path.suffix in FILES


def closed(path: Path) -> bool:
    """Whether the writer of the recording has closed it."""
    if path.is_dir():
        files = [entry for entry in path.iterdir() if entry.suffix in FILES]
        return (path / "metadata.yaml").exists() and all(map(closed, files))
    if path.suffix == ".mcap":
        return _has_summary(path)
    journals = (path.with_name(f"{path.name}-{kind}") for kind in ("wal", "journal"))
    return not any(journal.exists() and journal.stat().st_size for journal in journals)


def _has_summary(path: Path) -> bool:
    with path.open("rb") as stream:
        size = stream.seek(0, 2)
        if size < _FOOTER.size + 2 * len(MAGIC):
            return False
        stream.seek(-_FOOTER.size - len(MAGIC), 2)
        end = stream.read()
    opcode, length, summary, _, _ = _FOOTER.unpack_from(end)
    whole = opcode == Opcode.FOOTER and length == _FOOTER.size - 9 and end.endswith(MAGIC)
    return bool(whole and summary > 0)


def _mark(path: Path) -> Print:
    """Empty when there is no recording; a file that disappears meanwhile counts as changed."""
    try:
        files = sorted(path.iterdir()) if path.is_dir() else [path]
        states = [(file.name, file.stat()) for file in files if file.is_file()]
    except OSError:
        return ()
    if not any(Path(name).suffix in FILES for name, _ in states):
        return ()
    return tuple((name, state.st_size, state.st_mtime_ns) for name, state in states)
