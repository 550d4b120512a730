"""Parquet files; they need pyarrow."""

import io
from pathlib import Path

from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import table_of
from pneumo_ros.tables.table import Table


def read_parquet(path: Path, data: bytes) -> Table:
    """The columns of a Parquet file. Raises DataError for a damaged file, MissingDependencyError without pyarrow."""
    require_libraries(("pyarrow",))
    from pyarrow.parquet import read_table

    try:
        content = read_table(io.BytesIO(data))
        columns = {name: content.column(name).to_numpy() for name in content.column_names}
    except Exception as error:  # pyarrow raises errors of many kinds on damaged files
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        raise DataError(f"cannot read {path} as Parquet: {reason}") from error
    return table_of(path, columns)
