"""Tables as text: CSV, TSV and the like, with comments, a line of names, and units in it or below it."""

from collections import Counter
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.columns import numbers, table_of
from pneumo_ros.tables.formats import text
from pneumo_ros.tables.formats.text import COMMENTS, Form
from pneumo_ros.tables.table import Table
from pneumo_ros.tables.units import find_unit

_MOST_HEADER = 500  # lines before the first row of numbers
_SPOILT = 0.1  # share of rows with another number of cells beyond which a table is refused


def read_delimited(path: Path, data: bytes) -> Table:
    """The table in the text `data` of the file at `path`. Raises DataError where there are no rows of numbers."""
    try:
        lines = text.decoded(data).splitlines()
        full = [line for line in lines if line.strip()]
        bare = [line for line in full if not line.lstrip().startswith(COMMENTS)]
        if not bare:
            raise DataError("it holds comments only")
        form = text.form_of(bare)
        begin = _first_row(full, form)
        rows = text.split([line for line in full[begin:] if not line.lstrip().startswith(COMMENTS)], form)
        width = Counter(map(len, rows)).most_common(1)[0][0]
        names = _names(full[:begin], form, width)
        columns, texts, notes = _columns(rows, names, form)
    except DataError as error:
        raise DataError(f"cannot read {path}: {error}") from error
    table = table_of(path, columns, notes)
    return Table(path, table.columns, table.constants, tuple(texts), table.notes)


def _first_row(lines: list[str], form: Form) -> int:
    """Place of the first row of numbers: as long as those below, and with no fewer numbers."""
    bare = [line for line in lines if not line.lstrip().startswith(COMMENTS)]
    middle = text.split(bare[len(bare) // 2 :][:20], form)
    width = Counter(map(len, middle)).most_common(1)[0][0]
    usual = min(_numeric(row, form) for row in middle if len(row) == width)
    for place, line in enumerate(lines[:_MOST_HEADER]):
        (row,) = text.split([line], form) or [[]]
        if not line.lstrip().startswith(COMMENTS) and len(row) == width and _numeric(row, form) >= max(usual, 1):
            return place
    raise DataError(
        f"no row of {width} cells with numbers is found in the first {_MOST_HEADER} lines ({form.words()}); a table "
        "has one row a line"
    )


def _numeric(row: list[str], form: Form) -> int:
    return sum(text.is_number(cell, form) for cell in row)


def _names(header: list[str], form: Form, width: int) -> list[str]:
    """Names of the columns: the last line of words above the numbers, with the units from a line below it."""
    found = [cells for line in header if (cells := _words(line, form, width)) is not None]
    names = found[-1] if found else [f"column {k + 1}" for k in range(width)]
    if len(found) > 1 and _are_units(names):
        names = [
            f"{name} ({unit.strip('()[]')})" if unit else name for name, unit in zip(found[-2], names, strict=True)
        ]
    names = [name or f"column {k + 1}" for k, name in enumerate(names)]
    seen = Counter[str]()
    for k, name in enumerate(names):
        seen[name] += 1
        names[k] = name if seen[name] == 1 else f"{name}.{seen[name]}"
    return names


def _words(line: str, form: Form, width: int) -> list[str] | None:
    """The cells of a header line, a comment or not, cut as the numbers or otherwise; None where they do not fit."""
    stripped = line.strip()
    mark = next((mark for mark in COMMENTS if stripped.startswith(mark)), "")
    for one in (form, *text.FORMS):
        (cells,) = text.split([stripped.removeprefix(mark).strip(" \t") if mark else line], one) or [[]]
        if len(cells) == width and any(cell and not text.is_number(cell, form) for cell in cells):
            return cells
    return None


def _are_units(cells: list[str]) -> bool:
    """Whether every cell of a header line is a unit or empty."""
    return all(not cell or find_unit(cell.strip("()[]")) is not None for cell in cells)


def _columns(rows: list[list[str]], names: list[str], form: Form) -> tuple[dict[str, Array], list[str], list[str]]:
    """Columns of numbers, the names of those with text, and a sentence on rows that were left out."""
    good = [row for row in rows if len(row) == len(names)]
    lost = len(rows) - len(good)
    if lost > _SPOILT * len(rows):
        raise DataError(f"{lost} of {len(rows)} rows have another number of cells than the {len(names)} of the others")
    if len(good) < 2:
        raise DataError(f"it holds {len(good)} rows of numbers; at least two are needed")
    columns, texts = dict[str, Array](), list[str]()
    for name, cells in zip(names, zip(*good, strict=True), strict=True):
        values = _values(cells, form)
        if values is None:
            texts.append(name)
        else:
            columns[name] = values
    first = next((k for k, row in enumerate(rows) if len(row) != len(names)), 0)
    notes = [f"{lost} of {len(rows)} rows have another number of cells (first: row {first + 1}); they are left out"]
    return columns, texts, notes if lost else []


def _values(cells: tuple[str, ...], form: Form) -> Array | None:
    """One column as numbers; None for text."""
    plain = [cell.replace(",", ".") for cell in cells] if form.decimal == "," else cells
    try:
        return np.array(plain, dtype=np.str_).astype(np.float64)
    except ValueError:
        values = numbers(np.array(plain, dtype=object))
        return np.full(len(cells), np.nan) if values is None and not any(cells) else values
