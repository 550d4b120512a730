"""What every result has in common: its JSON, text, tables, charts and page."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

from pneumo_ros.command.console import plain
from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.files import write_whole
from pneumo_ros.nearest import unknown_name
from pneumo_ros.report.chart import Chart, HeatMap, Report
from pneumo_ros.report.provenance import provenance
from pneumo_ros.units import writing

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go
    from matplotlib.figure import Figure

Library = Literal["matplotlib", "plotly"]
Row = dict[str, Any]


@dataclass(frozen=True)
class Result:
    """A verb's answer: its JSON in `data`, its text by `print`, its table and pictures in a notebook.

    data: the JSON of the verb, in SI units; notes: sentences on what was found in the recordings; paths: of the
    recordings it is about.
    """

    data: dict[str, Any] = field(repr=False)
    notes: tuple[str, ...] = field(repr=False)
    paths: tuple[Path, ...] = field(repr=False)

    def as_dict(self) -> dict[str, Any]:
        """The JSON of the verb, of plain types: numbers that are not finite are None."""
        found: dict[str, Any] = plain(self.data)
        return found

    def rows(self) -> list[Row]:
        """The rows of the table, each with the same keys; units are in the keys or in a column `unit`."""
        raise NotImplementedError

    def to_dataframe(self) -> "pd.DataFrame":
        """The table as a pandas data frame; UsageError, with what to install, where pandas is not there."""
        return frame(self.rows())

    @cached_property
    def charts(self) -> dict[str, Chart | HeatMap]:
        """Every chart of the page, by name."""
        with writing(self.data):
            return {chart.name: chart for chart in self._page(_origin(())).charts()}

    @overload
    def plot(self, name: str | None = None, library: Literal["matplotlib"] = "matplotlib") -> "Figure": ...

    @overload
    def plot(self, name: str | None, library: Literal["plotly"]) -> "go.Figure": ...

    @overload
    def plot(self, name: str | None = None, *, library: Literal["plotly"]) -> "go.Figure": ...

    def plot(self, name: str | None = None, library: Library = "matplotlib") -> Any:
        """A chart as a figure of matplotlib or plotly; `name` is one of `charts`, None takes the first that matters.

        Raises UsageError for an unknown name, and where the library is not installed.
        """
        from pneumo_ros.api.figures import figure

        chosen = self._first() if name is None else name
        if chosen not in self.charts:
            raise UsageError(unknown_name("chart", chosen, self.charts))
        return figure(self.charts[chosen], library)

    def report(self, path: str | Path) -> None:
        """Write the page that --report writes: one HTML file, which opens without a network."""
        from pneumo_ros.report.page import page_html

        require_libraries(("plotly",))
        with writing(self.data):
            write_whole(path, page_html(self._page(_origin(self.paths))))

    def _page(self, origin: dict[str, Any]) -> Report:
        raise NotImplementedError

    def _first(self) -> str:
        """The chart that `plot` draws unless asked for another."""
        return next(iter(self.charts))


def _origin(paths: Sequence[Path]) -> dict[str, Any]:
    """Files that are still there, versions and date; the program was called from Python."""
    found: dict[str, Any] = plain(provenance([path for path in paths if path.exists()], None, ()))
    return found | {"command": "import pneumo_ros  # called from Python"}


def frame(rows: Sequence[Row]) -> "pd.DataFrame":
    """Rows as a data frame; UsageError where pandas is not installed."""
    require_libraries(("pandas",))
    import pandas as pd

    return pd.DataFrame(list(rows))


def telling(progress: Callable[[float, str], None] | None) -> Callable[[float, str], None]:
    """`progress`, or nothing."""
    return progress or (lambda share, text: None)
