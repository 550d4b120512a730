"""Results as they come, a line of JSON each: an interrupted sweep goes on from what it had."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from pneumo_ros.errors import DataError, UsageError


class Journal:
    """Results by key, in memory and in a file. A context manager.

    The file belongs to one sweep, named by `purpose`: what was computed for another one, of other code or with other
    options, is not taken for a result of this one. A last line that was cut off is dropped.
    """

    def __init__(self, path: str | Path, purpose: Mapping[str, Any]) -> None:
        """Open or begin the file.

        Raises UsageError when it belongs to another sweep, DataError when it is damaged or cannot be used.
        """
        self.path = Path(path)
        self.results: dict[str, Any] = {}
        heading = json.dumps({"sweep": purpose}, sort_keys=True)
        try:
            whole = self._read(heading)
            self._file = self.path.open("r+b" if whole else "wb")
            self._file.truncate(whole)
            self._file.seek(whole)
            if not whole:
                self._write(heading)
        except OSError as error:
            raise DataError(f"cannot use {path} for results: {error.strerror}") from error

    def put(self, key: str, result: Any) -> None:
        """Keep a result that JSON can hold; it is on the disk when this returns. Raises DataError when that is full."""
        try:
            self._write(json.dumps({"key": key, "result": result}))
        except OSError as error:
            raise DataError(f"cannot write {self.path}: {error.strerror}; the results before are in it") from error
        self.results[key] = result

    def close(self) -> None:
        """End the file."""
        self._file.close()

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _write(self, line: str) -> None:
        self._file.write(line.encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def _read(self, heading: str) -> int:
        """Take the results that are there; how many bytes of the file are whole lines of this sweep."""
        data = self.path.read_bytes() if self.path.exists() else b""
        whole = 0
        for number, line in enumerate(data.splitlines(keepends=True)):
            if not line.endswith(b"\n"):
                break
            if number == 0 and line.decode("utf-8", "replace").rstrip("\n") != heading:
                raise UsageError(f"{self.path} holds results of another sweep; name another file, or remove it")
            if number:
                try:
                    one = json.loads(line)
                    self.results[one["key"]] = one["result"]
                except (ValueError, KeyError, TypeError, RecursionError) as error:
                    raise DataError(f"{self.path}, line {number + 1}, is no result; remove the line") from error
            whole += len(line)
        # a first line that is not whole: of a sweep that was cut at once, or of something else
        if data and not whole and not heading.startswith(data.decode("utf-8", "replace")):
            raise UsageError(f"{self.path} is no file of results; name another one")
        return whole
