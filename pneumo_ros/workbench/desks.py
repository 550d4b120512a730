"""All desks of a server: one for each tab, by the identifier in its address."""

import re
import secrets
import tempfile
import threading
from pathlib import Path

from pneumo_ros.workbench.desk import Desk, Given

_MOST = 24  # desks; the least recently used one is closed first


class Desks:
    """Desks by identifier, in a temporary folder that `close` removes."""

    def __init__(self, given: Given) -> None:
        self.given = given
        self._root = tempfile.TemporaryDirectory(prefix="pneumo_workbench_")
        self._desks: dict[str, Desk] = {}
        self._ready = ""  # a desk that is prepared and not used yet
        self._lock = threading.Lock()

    def prepare(self) -> None:
        """Prepare a desk for the first visitor; raises what `Desk` raises."""
        self._ready = self._lay_out()

    def new(self) -> str:
        """Make a desk with the arguments of the command line; returns its identifier."""
        with self._lock:
            ready, self._ready = self._ready, ""
        return ready or self._lay_out()

    def _lay_out(self) -> str:
        name = secrets.token_hex(6)
        folder = Path(self._root.name).resolve() / name
        folder.mkdir()
        desk = Desk(folder, self.given)
        with self._lock:
            self._desks[name] = desk
            old = [n for n, d in self._desks.items() if not (d.job and d.job.running)][: len(self._desks) - _MOST]
            for one in old:
                self._desks.pop(one).close()
        return name

    def of(self, pathname: object) -> Desk:
        """The desk at /b/IDENTIFIER; KeyError when there is none."""
        match = re.fullmatch(r"/b/([0-9a-f]{12})", pathname if isinstance(pathname, str) else "")
        with self._lock:
            desk = self._desks.pop(match[1] if match else "")
            self._desks[match[1] if match else ""] = desk  # the most recent one comes last
            return desk

    def uploads(self, name: str) -> Path:
        """The folder for recordings dropped on a desk; KeyError when there is no such desk."""
        return self.of(f"/b/{name}").folder / "uploads"

    def close(self) -> None:
        """End all jobs and remove all files."""
        for desk in self._desks.values():
            desk.close()
        self._root.cleanup()
