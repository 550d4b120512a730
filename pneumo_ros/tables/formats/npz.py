"""NPZ and NPY files of numpy; pickled objects, which could run code, are refused."""

import io
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import table_of
from pneumo_ros.tables.table import Table


def read_npz(path: Path, data: bytes) -> Table:
    """The vectors of an NPZ file, or the columns of an NPY file. Raises DataError for a damaged file."""
    try:
        content = np.load(io.BytesIO(data), allow_pickle=False)
        values: dict[str, Any] = {"column": content} if isinstance(content, np.ndarray) else dict(content)
    except Exception as error:  # numpy and zipfile raise errors of many kinds on damaged files
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        raise DataError(f"cannot read {path} as a file of numpy: {reason}") from error
    if len(values) == 1 and next(iter(values.values())).dtype.names:  # one array of records: its fields are columns
        records = next(iter(values.values()))
        values = {name: records[name] for name in records.dtype.names}
    return table_of(path, values)
