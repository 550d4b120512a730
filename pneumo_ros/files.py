"""Writes files and folders completely or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pneumo_ros.errors import DataError, UsageError


def check_writable(path: str | Path) -> Path:
    """`path` as a Path; UsageError when no file can be written there. Call it before long work: no result is lost."""
    target = Path(path)
    folder = target.parent
    if not folder.is_dir():
        raise UsageError(f"cannot write {target}: there is no folder {folder}; type: mkdir -p {folder}")
    if target.is_dir():
        raise UsageError(f"cannot write {target}: it is a folder; give a file name, such as {target / 'result.json'}")
    if not os.access(folder, os.W_OK):
        raise UsageError(f"cannot write {target}: no permission to write in {folder}")
    return target


def write_whole(path: str | Path, content: str | bytes) -> None:
    """Write `content` (text as UTF-8) to `path`, replacing a file in one step: readers see the old one or the new one.

    Raises UsageError when no file can be written there, DataError when the disk is full or fails.
    """
    target = check_writable(path).resolve()  # a link stays a link
    try:
        _write(target, content.encode("utf-8") if isinstance(content, str) else content)
    except OSError as error:
        raise DataError(f"cannot write {path}: {error.strerror}; the file there is unchanged") from error


def _write(target: Path, data: bytes) -> None:
    if target.exists() and not target.is_file():  # a device or pipe, such as /dev/null, cannot be replaced
        target.write_bytes(data)
        return
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            os.fchmod(stream.fileno(), _usual_mode())
            os.fsync(stream.fileno())
        os.replace(name, target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def check_new_folder(path: str | Path) -> Path:
    """`path` as a Path; UsageError when it exists or when its folder is missing or cannot be written."""
    target = Path(path)
    if target.exists():
        raise UsageError(f"{target} exists; name another folder, or remove it first: rm -r {target}")
    return check_writable(target)


@contextmanager
def whole_folder(path: str | Path) -> Iterator[Path]:
    """Path of a folder to create and fill. It becomes `path` when the block ends without an error; else it is removed.

    Raises UsageError when `path` exists or cannot be created, DataError when the disk is full or fails.
    """
    target = check_new_folder(path)
    try:
        # The folder has its final name inside a temporary one: some files in a recording are named after it.
        around = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise DataError(f"cannot write {path}: {error.strerror}") from error
    try:
        yield around / target.name
        os.rename(around / target.name, target)
    except OSError as error:
        raise DataError(f"cannot write {path}: {error.strerror}") from error
    finally:
        shutil.rmtree(around, ignore_errors=True)


def yaml_number(value: float) -> str:
    """Shortest text that both YAML 1.1 and ROS read as the same double."""
    mantissa, e, exponent = repr(float(value)).partition("e")
    if "." not in mantissa:
        mantissa += ".0"
    return mantissa + (f"e{int(exponent):+03d}" if e else "")


def _usual_mode() -> int:
    """The permissions that a new file gets by default; those of temporary files let only the owner read."""
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
