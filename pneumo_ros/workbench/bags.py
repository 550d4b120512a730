"""Recordings on a desk: their names, whether they are fitted or held out, and the parts cut from them."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Literal

from pneumo_ros.errors import PneumoError
from pneumo_ros.reading.read import ReadOptions, corrected_recording
from pneumo_ros.records import Recording
from pneumo_ros.records.folders import recordings_in

Role = Literal["fit", "hold", "out"]
ROLES: dict[Role, str] = {"fit": "fit", "hold": "hold out", "out": "leave out"}
_HELD = "hold"  # names of recordings to hold out begin with it
_KEPT = 32  # recordings in memory: 10 minutes at 1 kHz take 40 MB


def reading_options(how: ReadOptions) -> list[str]:
    """--namespace, --joint and --read-as of the verbs, as words of a command line."""
    given = {"--namespace": how.namespace, "--joint": how.joint, "--read-as": ",".join(how.words)}
    return [word for key, value in given.items() if value for word in (key, value)]


@dataclass(frozen=True)
class Bag:
    """One recording: its path for the verbs, its role in a fit, and the seconds cut from it."""

    name: str
    path: str
    role: Role
    cuts: tuple[tuple[float, float], ...] = ()
    problem: str = ""  # why it cannot be used; empty when it can

    def cut_options(self) -> list[str]:
        """The cuts as words of a command line."""
        return [word for begin, end in self.cuts for word in ("--cut", f"{self.path}:{begin:g}-{end:g}")]


def found_bags(paths: Iterable[str | Path], folder: Path | None = None) -> list[Bag]:
    """A bag for every recording named, or in a folder named; paths below `folder` are relative to it."""
    found: dict[Path, Bag] = {}
    for given in paths:
        for path in recordings_in(Path(given)) or [Path(given)]:
            whole = path.resolve()
            shown = whole.relative_to(folder) if folder and whole.is_relative_to(folder) else whole
            name = whole.stem if whole.suffix in (".mcap", ".db3") else whole.name
            found.setdefault(whole, Bag(name, str(shown), "hold" if name.startswith(_HELD) else "fit"))
    return _told_apart(list(found.values()))


def _told_apart(bags: list[Bag]) -> list[Bag]:
    """Add the folder to names that several bags have."""
    names = [bag.name for bag in bags]
    return [Bag(f"{Path(b.path).parent.name}/{b.name}", b.path, b.role) if names.count(b.name) > 1 else b for b in bags]


def read(path: Path, how: ReadOptions, atmosphere: float) -> Recording:
    """The recording at `path`, kept in memory until its file changes; `atmosphere` [Pa] is added to gauge pressures.

    Raises DataError when it cannot be read.
    """
    newest = max((inner.stat().st_mtime_ns for inner in [path, *path.glob("*")]), default=0) if path.exists() else 0
    return _read(path, newest, how, atmosphere)


@lru_cache(_KEPT)
def _read(path: Path, newest: int, how: ReadOptions, atmosphere: float) -> Recording:
    return corrected_recording(path, how, atmosphere)


def problem_of(path: Path, how: ReadOptions, atmosphere: float) -> str:
    """Why a recording cannot be read; empty when it can."""
    try:
        read(path, how, atmosphere)
    except PneumoError as error:
        return str(error)
    return ""
