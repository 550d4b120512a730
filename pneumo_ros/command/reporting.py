"""The options --report and --figures, and writing what they ask for once the results are there."""

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console
from pneumo_ros.environment import require_libraries
from pneumo_ros.files import check_new_folder, check_writable, whole_folder, write_whole

if TYPE_CHECKING:
    from pneumo_ros.diagnose.compare import Comparison
    from pneumo_ros.plant import Model
    from pneumo_ros.report.chart import Report


def add_report(parser: argparse.ArgumentParser) -> None:
    """--report and --figures."""
    parser.add_argument("--report", metavar="FILE.html", help="write one HTML page that opens without a network")
    parser.add_argument("--figures", metavar="FOLDER", help="write the figures as PNG and SVG into a new folder")


@dataclass(frozen=True)
class ReportJob:
    """Where report and figures go, or None; and which recordings they are about."""

    page: Path | None
    figures: Path | None
    bags: tuple[str, ...]
    machine: str
    effects: tuple[str, ...]

    def write(self, console: Console, comparison: "Comparison", result: dict[str, Any], model: "Model") -> None:
        """Write what was asked for of a comparison."""
        from pneumo_ros.report.comparison import comparison_report

        self.publish(console, lambda origin: comparison_report(result, comparison, model, origin))

    def origin(self) -> dict[str, Any]:
        """JSON: the files with their hashes, the versions, the command line and the date."""
        from pneumo_ros.report.provenance import provenance

        return provenance(self.bags, self.machine, sys.argv[1:], self.effects)

    def publish(self, console: Console, make: "Callable[[dict[str, Any]], Report]") -> None:
        """Write what was asked for of the report that `make` makes of its origin."""
        if self.page is None and self.figures is None:
            return
        report = make(self.origin())
        if self.page is not None:
            from pneumo_ros.report.page import page_html

            text = page_html(report)
            write_whole(self.page, text)
            console.note(f"Report written to {self.page} ({len(text.encode()) / 1e6:.1f} MB)")
        if self.figures is not None:
            from pneumo_ros.report.drawing import draw_charts

            with whole_folder(self.figures) as folder:
                folder.mkdir()
                count = draw_charts(report.charts(), folder)
            console.note(f"{count} figures written to {self.figures}, each as PNG and SVG")


def prepare_report(options: argparse.Namespace) -> ReportJob:
    """Check before any work that what the options ask for can be written, and that its libraries are there."""
    if options.report is not None:
        require_libraries(("plotly",))
    if options.figures is not None:
        require_libraries(("matplotlib",))
    return ReportJob(
        page=None if options.report is None else check_writable(options.report),
        figures=None if options.figures is None else check_new_folder(options.figures),
        bags=(*options.bags, *(getattr(options, "fit", None) or ())),
        machine=str(options.model),
        effects=tuple(options.effects),
    )
