"""A table of texts, which terminal and page lay out differently."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Rows below a head; the first column names the rows, `numeric` columns align to the right."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: tuple[int, ...] = ()
