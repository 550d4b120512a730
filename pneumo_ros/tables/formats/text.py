"""Text of a file: its encoding, and which letter separates the columns and which the decimals."""

import csv
import re
from typing import NamedTuple

from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import EMPTY

COMMENTS = ("#", "%", "//", ";;", "'")
_SAMPLE = 60  # lines from the middle of the file, where no header is
_MARKS = ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig"))
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$")


class Form(NamedTuple):
    """How lines are cut: `delimiter` "" means spaces."""

    delimiter: str
    decimal: str

    def words(self) -> str:
        """The form for a message."""
        names = {"\t": "tabs", "": "spaces", ",": "commas", ";": "semicolons", "|": "bars"}
        return f"columns by {names[self.delimiter]}, decimal {'comma' if self.decimal == ',' else 'point'}"


# In the order in which they are taken where several fit as well: `1,2` is two columns
FORMS = tuple(Form(delimiter, decimal) for delimiter, decimal in (
    ("\t", "."), ("\t", ","), (";", "."), (";", ","), (",", "."), ("|", "."), ("|", ","), ("", "."), ("", ","),
))  # fmt: skip


def decoded(data: bytes) -> str:
    """Text of a file: UTF-8, UTF-16 with its mark, or Latin-1, in which `µ` and `°` of older programs are written.

    Raises DataError for bytes that are no text.
    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    if b"\0" in data[:4096]:
        raise DataError("it holds binary data, not text")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def split(lines: list[str], form: Form) -> list[list[str]]:
    """The cells of each line, without the spaces around them. Raises DataError for quotes that do not end."""
    if not form.delimiter:
        return [line.split() for line in lines]
    try:
        rows = csv.reader(lines, delimiter=form.delimiter, skipinitialspace=True)
        return [[cell.strip() for cell in row] for row in rows]
    except csv.Error as error:
        raise DataError(f"its cells cannot be told apart: {error}") from error


def is_number(cell: str, form: Form) -> bool:
    """Whether a cell holds a number in this form."""
    return _NUMBER.match(plain(cell, form)) is not None


def plain(cell: str, form: Form) -> str:
    """A cell with the decimal point of Python."""
    return cell.replace(",", ".") if form.decimal == "," else cell


def form_of(lines: list[str]) -> Form:
    """The form in which most cells of the lines in the middle of a file are numbers, and the lines equally long."""
    middle = max(len(lines) // 2 - _SAMPLE // 2, 0)
    sample = lines[middle : middle + _SAMPLE]
    return max(FORMS, key=lambda form: (_fit(sample, form), -FORMS.index(form)))


def _fit(sample: list[str], form: Form) -> tuple[float, int]:
    """Share of cells that are numbers or empty in rows of the usual length, and that length."""
    rows = split(sample, form)
    lengths = [len(row) for row in rows]
    usual = max(set(lengths), key=lengths.count)
    cells = [cell for row in rows for cell in row if len(row) == usual]
    good = sum(is_number(cell, form) or cell.lower() in EMPTY for cell in cells)
    numeric = sum(is_number(cell, form) for cell in cells)
    return (round(good / len(cells) * lengths.count(usual) / len(rows), 2) if numeric else 0.0, usual)
