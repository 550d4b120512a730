"""Named arrays of a file as a table: the columns are those as long as most, single numbers are constants."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.table import Table

DEEPEST = 4  # levels of structures in structures
WIDEST = 64  # columns of a matrix that are taken one by one


def table_of(path: Path, values: Mapping[str, Any], notes: Sequence[str] = ()) -> Table:
    """The table in `values`: arrays, numbers, texts, and mappings of them, whose names are joined by dots.

    A matrix (n, k) gives the columns `name[0]` to `name[k-1]`. Raises DataError where there is no column of numbers.
    """
    arrays = dict(_flat(values, "", DEEPEST))
    lengths = Counter(len(one) for one in arrays.values() if one.ndim == 1 and len(one) > 1)
    if not lengths:
        raise DataError(f"{path} holds no columns: no list or array of at least two numbers")
    rows = max(lengths, key=lambda length: (lengths[length], length))
    columns, constants, texts, others = dict[str, Array](), dict[str, float](), list[str](), list[str]()
    for name, one in arrays.items():
        numeric = numbers(one.ravel())
        if one.ndim == 1 and len(one) == rows:
            if numeric is None:
                texts.append(name)
            else:
                columns[name] = numeric
        elif one.size == 1:
            if numeric is not None and np.isfinite(numeric[0]):
                constants[name] = float(numeric[0])
        else:
            others.append(f"{name} ({' x '.join(map(str, one.shape))})")
    if not columns:
        raise DataError(f"{path} holds no column of numbers; there is text in {', '.join(texts)}")
    if others:
        notes = [*notes, f"left out, as the columns have {rows} rows: {', '.join(others[:20])}"]
    return Table(path, columns, constants, tuple(texts), tuple(notes))


def numbers(cells: NDArray[Any]) -> Array | None:
    """`cells` (n,) as numbers: NaN where a cell is empty; dates as seconds since 1970. None for text."""
    if cells.dtype.kind in "biuf":
        return np.asarray(cells, dtype=np.float64)
    if cells.dtype.kind == "M":
        return _seconds(cells)
    if cells.dtype.kind not in "OUS":
        return None
    found = np.array([_number(cell) for cell in cells.tolist()])
    texts = np.array([np.isnan(value) and not _empty(cell) for value, cell in zip(found, cells.tolist(), strict=True)])
    if texts.any():
        return _dates(cells)
    return found if np.isfinite(found).any() else None


def _number(cell: Any) -> float:
    """The number in a cell; NaN where there is none."""
    try:
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return float("nan")


def _empty(cell: Any) -> bool:
    """Whether a cell says that there is no value."""
    return cell is None or (isinstance(cell, float)) or str(cell).strip().lower() in EMPTY


EMPTY = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a", "inf", "-inf"})


def _dates(cells: NDArray[Any]) -> Array | None:
    """Dates (ISO 8601) as seconds since 1970; None for other text."""
    try:
        return _seconds(np.array([str(cell).strip().removesuffix("Z") for cell in cells], dtype="datetime64[ns]"))
    except ValueError:
        return None


def _seconds(dates: NDArray[Any]) -> Array:
    """numpy's dates as seconds since 1970, NaN where there is none."""
    since = dates.astype("datetime64[ns]").astype(np.int64) / 1e9
    return np.where(np.isnat(dates), np.nan, since)


def _flat(values: Mapping[str, Any], prefix: str, depth: int) -> Iterator[tuple[str, NDArray[Any]]]:
    """Arrays and single values by their full names, each with one or no dimension."""
    for key, value in values.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            if depth:
                yield from _flat(value, f"{name}.", depth - 1)
            continue
        array = _array(value)
        if array is None:
            continue
        if array.dtype.names:
            if depth:
                yield from _flat({field: array[field] for field in array.dtype.names}, f"{name}.", depth - 1)
            continue
        yield from _split(name, np.atleast_1d(np.squeeze(array)))


def _array(value: Any) -> NDArray[Any] | None:
    """`value` as an array; None where it is none, such as lists of different lengths."""
    try:
        return np.asarray(value)
    except ValueError:
        return None


def _split(name: str, array: NDArray[Any]) -> Iterator[tuple[str, NDArray[Any]]]:
    """An array, or the columns of a matrix; the longer side of a matrix is time."""
    if array.ndim != 2 or min(array.shape) > WIDEST:
        yield name, array
        return
    matrix = array if array.shape[0] >= array.shape[1] else array.T
    yield from ((f"{name}[{k}]", matrix[:, k]) for k in range(matrix.shape[1]))
