"""The bytes of a file, unpacked where it is packed with gzip, up to a bound."""

import gzip
import itertools
import zlib
from pathlib import Path

from pneumo_ros.errors import DataError

MOST = 1 << 30  # bytes of an unpacked table: about 10 h of ten signals at 1 kHz as text
_PART = 1 << 20  # bytes read at once
GZIP = b"\x1f\x8b"


def content_of(path: Path) -> bytes:
    """The bytes in the file at `path`. Raises DataError when it cannot be read, is empty, or is larger than MOST."""
    try:
        with path.open("rb") as stream:
            packed = stream.read(2) == GZIP
        with gzip.open(path) if packed else path.open("rb") as stream:
            parts = itertools.takewhile(len, (stream.read(_PART) for _ in range(MOST // _PART + 1)))
            data = b"".join(parts)
    except FileNotFoundError as error:
        raise DataError(f"there is no {path}") from error
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise DataError(f"{path} is damaged: it cannot be unpacked ({error}); copy it again") from error
    except OSError as error:
        raise DataError(f"cannot read {path}: {error.strerror or error}") from error
    if len(data) > MOST:
        raise DataError(f"{path} holds more than {MOST >> 30} GiB; cut it into several tables")
    if not data.strip():
        raise DataError(f"{path} is empty")
    return data


def ending(path: Path) -> str:
    """The ending of a table's name in small letters, without that of gzip: `.csv` for `run.CSV.gz`."""
    name = path.name.lower().removesuffix(".gz")
    return Path(name).suffix


def table_name(path: Path) -> str:
    """Name of a table, for the recording made of it: that of its file without endings."""
    name = path.name[:-3] if path.name.lower().endswith(".gz") else path.name
    return Path(name).stem
