"""Recordings dropped on the page: file by file into the desk's folder, and nowhere else."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

from flask import Flask, Response, request
from werkzeug.exceptions import RequestEntityTooLarge

from pneumo_ros.errors import UsageError
from pneumo_ros.tables.reading import READERS

LARGEST = 2 * 1024**3  # bytes of one file
_MOST = 8 * 1024**3  # bytes of all files of a desk
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+ -]{0,120}")
KINDS = (".mcap", ".db3", ".yaml")  # files of recordings
TABLES, MACHINES = "tables_to_import", "machine_files"  # folders of uploads that hold no recordings
TABLE_KINDS = tuple(kind + packed for kind in READERS for packed in ("", ".gz"))
_CHUNK = 1 << 20


def place(folder: Path, given: str) -> Path:
    """The path for a file that the browser calls `given`: `folder/NAME` or `folder/RECORDING/NAME`.

    UsageError for names that are not plain, for kinds that are no part of a recording, and for paths outside
    `folder`.
    """
    parts = [part for part in given.replace("\\", "/").split("/") if part]
    kept = parts[-2:]  # a recording is a folder of files; folders above it are dropped
    if not kept or any(not _NAME.fullmatch(part) or part.endswith(".") for part in kept):
        raise UsageError(f"'{given[:80]}' is no plain file name; use letters, digits, and . _ + -")
    tables = kept[0] == TABLES and len(kept) == 2
    if not kept[-1].lower().endswith(tuple(TABLE_KINDS) if tables else KINDS):
        what, allowed = ("table that is read", TABLE_KINDS) if tables else ("part of a recording", KINDS)
        raise UsageError(f"{kept[-1]} is no {what}; these are: {', '.join(allowed)}")
    target = folder.joinpath(*kept).resolve()
    if not target.is_relative_to(folder.resolve()):
        raise UsageError(f"'{given[:80]}' lies outside the folder for recordings")
    return target


def accept_uploads(server: Flask, folder_of: Callable[[str], Path]) -> None:
    """PUT /upload/DESK/PATH stores a file; KeyError of `folder_of`: there is no such desk."""

    def store(desk: str, name: str) -> Response:
        try:
            folder = folder_of(desk)
            target = place(folder, name)
            _check_room(folder, request.content_length)
        except KeyError:
            return Response("there is no such desk; open the page again", 404)
        except UsageError as problem:
            return Response(str(problem), 400)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            _write(target)
        except OSError as problem:  # for example, the disk is full
            return Response(f"{target.name} cannot be kept: {problem.strerror}; open it by name: pneumo workbench", 507)
        return Response("", 204)

    server.config["MAX_CONTENT_LENGTH"] = LARGEST
    server.add_url_rule("/upload/<desk>/<path:name>", "upload", store, methods=["PUT"])


def _check_room(folder: Path, length: int | None) -> None:
    if length is None:
        raise UsageError("the browser does not say how long the file is")
    if length > LARGEST:
        raise RequestEntityTooLarge
    used = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    folder.mkdir(parents=True, exist_ok=True)
    if used + length > _MOST or length > 0.9 * shutil.disk_usage(folder).free:
        raise UsageError("there is no room for more recordings; open them by name: pneumo workbench BAG...")


def _write(target: Path) -> None:
    """The body of the request, in pieces: it may be larger than the memory."""
    part = target.with_name(f".{target.name}.part")
    try:
        with part.open("wb") as stream:
            while piece := request.stream.read(_CHUNK):
                stream.write(piece)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)
