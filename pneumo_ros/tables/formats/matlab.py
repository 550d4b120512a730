"""MAT-files of MATLAB and Octave, up to version 7; structures are unfolded."""

import io
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import DEEPEST, table_of
from pneumo_ros.tables.table import Table

_NEW = b"MATLAB 7.3"
_HDF5 = b"\x89HDF\r\n"


def read_matlab(path: Path, data: bytes) -> Table:
    """The vectors of a MAT-file as columns, its numbers as constants.

    Raises DataError for a damaged file, and for version 7.3, which is another format (HDF5).
    """
    if data.startswith((_NEW, _HDF5)):
        raise DataError(
            f"{path} is a MAT-file of version 7.3 (HDF5), which is not read. In MATLAB type: "
            f"load('{path.name}'); save('{path.stem}_v7.mat', '-v7')"
        )
    from scipy.io import loadmat

    try:
        content = loadmat(io.BytesIO(data), squeeze_me=True, struct_as_record=False)
    except Exception as error:  # scipy raises errors of many kinds on damaged files
        raise DataError(f"cannot read {path} as a MAT-file: {_brief(error)}") from error
    return table_of(path, {name: _plain(value, DEEPEST) for name, value in content.items() if name[:2] != "__"})


def _plain(value: Any, depth: int) -> Any:
    """A MATLAB structure as a mapping; `depth` levels of them."""
    fields = getattr(value, "_fieldnames", None)
    if fields is None:
        one = isinstance(value, np.ndarray) and value.dtype == object and value.size == 1
        return _plain(value.item(), depth - 1) if one and depth else value
    return {name: _plain(getattr(value, name), depth - 1) for name in fields} if depth else {}


def _brief(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0][:200]
