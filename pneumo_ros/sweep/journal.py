"""Results as lines of JSON: an interrupted sweep continues from them."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from pneumo_ros.errors import DataError, UsageError


class Journal:
    """Results by key, in memory and in a file. A context manager.

    The file belongs to one sweep, named by `purpose`: results of another sweep, with other code or options, are
    refused. An incomplete last line is dropped.
    """

    def __init__(self, path: str | Path, purpose: Mapping[str, Any]) -> None:
        """Open or create the file.

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
        """Save a JSON-compatible result; it is on the disk on return. Raises DataError when the disk is full."""
        try:
            self._write(json.dumps({"key": key, "result": result}))
        except OSError as error:
            raise DataError(f"cannot write {self.path}: {error.strerror}; earlier results are saved") from error
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
        """Read the results; returns how many bytes of the file are complete lines of this sweep."""
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
        # an incomplete first line: of this sweep, interrupted at once, or of another file
        if data and not whole and not heading.startswith(data.decode("utf-8", "replace")):
            raise UsageError(f"{self.path} is no file of results; name another one")
        return whole
