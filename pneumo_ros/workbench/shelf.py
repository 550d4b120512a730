"""The recordings of one desk: with different names, read, cut, and assigned to fit or hold-out."""

import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from pneumo_ros.errors import UsageError
from pneumo_ros.reading.read import ReadOptions
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import parse_words
from pneumo_ros.workbench.bags import ROLES, Bag, Role, found_bags, problem_of, read


class Shelf:
    """Recordings in order; `changed` is called when something about them has changed.

    Paths below `folder` are relative to it; `atmosphere` [Pa] is added to gauge pressures.
    """

    def __init__(self, folder: Path, how: ReadOptions, atmosphere: float, changed: Callable[[], None]) -> None:
        self.folder, self.how, self.atmosphere = folder, how, atmosphere
        self.bags: tuple[Bag, ...] = ()
        self._changed, self._lock = changed, threading.RLock()

    def take(self, paths: Iterable[str | Path]) -> None:
        """Add recordings to the desk; those that cannot be read hold the reason."""
        have = {self.path(bag) for bag in self.bags}
        new = [bag for bag in found_bags(paths, self.folder) if self.path(bag) not in have]
        seen = [replace(bag, problem=problem_of(self.path(bag), self.how, self.atmosphere)) for bag in new]
        with self._lock:
            taken = {bag.name for bag in self.bags}
            self.bags += tuple(replace(b, name=f"{b.name} ({b.path})") if b.name in taken else b for b in seen)
            self._changed()

    def read_as(self, text: str) -> None:
        """Read all recordings again as the words of --read-as say; UsageError for unknown words."""
        how = replace(self.how, words=parse_words(text))
        seen = tuple(replace(b, problem=problem_of(self.path(b), how, self.atmosphere)) for b in self.bags)
        with self._lock:
            self.how, self.bags = how, seen
            self._changed()

    def path(self, bag: Bag) -> Path:
        """The path of a recording."""
        return (self.folder / bag.path).resolve()

    def recording(self, bag: Bag) -> Recording:
        """The content of a usable bag."""
        return read(self.path(bag), self.how, self.atmosphere)

    def bag(self, name: str | None) -> Bag | None:
        """The usable recording of that name, else the first one; None when there is none."""
        usable = [bag for bag in self.bags if not bag.problem]
        return next((bag for bag in usable if bag.name == name), usable[0] if usable else None)

    def set_role(self, name: str, role: str) -> None:
        """Fit a recording, hold it out or leave it out."""
        if role not in ROLES:
            raise UsageError(f"'{role}' is no role; known are {', '.join(ROLES)}")
        chosen: Role = role
        self._change(name, lambda bag: replace(bag, role=chosen))

    def cut(self, name: str, begin: float, end: float) -> None:
        """Leave seconds of a recording out."""
        if not begin < end:
            raise UsageError("zoom to the part to cut first: drag across the plot")
        span = (round(max(begin, 0.0), 3), round(end, 3))
        self._change(name, lambda bag: replace(bag, cuts=tuple(sorted({*bag.cuts, span}))))

    def uncut(self, name: str, span: tuple[float, float]) -> None:
        """Remove a cut."""
        self._change(name, lambda bag: replace(bag, cuts=tuple(cut for cut in bag.cuts if cut != span)))

    def _change(self, name: str, edit: Callable[[Bag], Bag]) -> None:
        with self._lock:
            self.bags = tuple(edit(bag) if bag.name == name else bag for bag in self.bags)
            self._changed()
