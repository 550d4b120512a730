"""A table as it was published: columns of numbers, and single values beside them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.heading import stem

MOST_NAMES = 40  # columns that an error message lists


@dataclass(frozen=True)
class Table:
    """Columns (n,) by name, NaN where a cell holds no number; `constants` are the numbers given once.

    `texts` names the columns without numbers; `notes` are sentences on what was left out.
    """

    path: Path
    columns: Mapping[str, Array]
    constants: Mapping[str, float]
    texts: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def column(self, given: str) -> str:
        """Full name of a column, from itself, its name without unit, or another spelling of its letters.

        Raises UsageError for a name that fits none or several, with those that exist.
        """
        if given in self.columns:
            return given
        spellings: list[Callable[[str], str]] = [str.strip, stem, lambda name: stem(name).lower()]
        for spelling in spellings if stem(given) == given.strip() else spellings[:1]:
            fitting = [name for name in self.columns if spelling(name) == spelling(given)]
            if len(fitting) == 1:
                return fitting[0]
            if fitting:
                raise UsageError(
                    f"{self.path.name}: column '{given}' may be {' or '.join(fitting)}; give the whole name"
                )
        if given in self.texts:
            raise UsageError(f"{self.path.name}: column '{given}' holds text, not numbers; {self.listed()}")
        raise UsageError(f"{self.path.name}: {unknown_name('column', given, self.columns)}; {self.listed()}")

    def listed(self) -> str:
        """The columns in words, for a message."""
        names = list(self.columns)
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        return f"the table has: {', '.join(names[:MOST_NAMES])}{more}"
