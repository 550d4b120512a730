"""MAT-files of MATLAB and Octave, up to version 7; structures are unfolded.

scipy's reader can crash on a damaged file (segmentation fault), so it runs in a process of its own: this module.
"""

import io
import os
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import DEEPEST, table_of
from pneumo_ros.tables.table import Table

_NEW = b"MATLAB 7.3"
_HDF5 = b"\x89HDF\r\n"
_WITHIN = 120.0  # s; a table of 1 GB takes seconds
_MARK = "="  # before names on the way from one process to the other: numpy has a use for some names
_ROOT = Path(__file__).parents[3]


def read_matlab(path: Path, data: bytes) -> Table:
    """The vectors of a MAT-file as columns, its numbers as constants.

    Raises DataError for a damaged file, and for version 7.3, which is another format (HDF5).
    """
    if data.startswith((_NEW, _HDF5)):
        raise DataError(
            f"{path} is a MAT-file of version 7.3 (HDF5), which is not read. In MATLAB type: "
            f"load('{path.name}'); save('{path.stem}_v7.mat', '-v7')"
        )
    search = os.pathsep.join([str(_ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    try:
        done = subprocess.run(
            [sys.executable, "-m", __name__], input=data, capture_output=True, timeout=_WITHIN,
            env={**os.environ, "PYTHONPATH": search, "OPENBLAS_NUM_THREADS": "1"},
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise DataError(f"cannot read {path} as a MAT-file within {_WITHIN:g} s; write its columns to CSV") from error
    if done.returncode:
        lines = done.stderr.decode(errors="replace").strip().splitlines()
        reason = lines[-1][:200] if done.returncode > 0 and lines else "it is damaged"
        raise DataError(f"cannot read {path} as a MAT-file: {reason}")
    packed = np.load(io.BytesIO(done.stdout), allow_pickle=False)
    return table_of(path, {name.removeprefix(_MARK): values for name, values in packed.items()})


def unfolded(data: bytes) -> dict[str, NDArray[Any]]:
    """The arrays of numbers and texts in a MAT-file, those of structures by names joined with dots.

    Raises errors of many kinds on damaged files, or ends the process.
    """
    from scipy.io import loadmat

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # on variables that are given twice
        content = loadmat(io.BytesIO(data), squeeze_me=True, struct_as_record=False)
    found: dict[str, NDArray[Any]] = {}
    for name, value in content.items():
        if name[:2] != "__":
            _unfold(name, value, DEEPEST, found)
    return found


def _unfold(name: str, value: Any, depth: int, found: dict[str, NDArray[Any]]) -> None:
    """Put a value, or the fields of a structure, into `found`; `depth` levels of structures."""
    if isinstance(value, np.ndarray) and value.dtype == object and value.size == 1:
        value = value.item()
    fields = getattr(value, "_fieldnames", None)
    if fields is None:
        array = np.asarray(value)
        if array.dtype.kind in "biufU":
            found[name] = array
    elif depth:
        for field in fields:
            _unfold(f"{name}.{field}", getattr(value, field), depth - 1, found)


if __name__ == "__main__":
    arrays = unfolded(sys.stdin.buffer.read())
    packed = io.BytesIO()
    np.savez(packed, **{_MARK + name: values for name, values in arrays.items()})  # type: ignore[arg-type]
    sys.stdout.buffer.write(packed.getvalue())
