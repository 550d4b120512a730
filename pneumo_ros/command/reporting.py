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
    from pneumo_ros.report.chart import Report


def add_report(parser: argparse.ArgumentParser) -> None:
    """--report and --figures."""
    parser.add_argument("--report", metavar="FILE.html", help="write one HTML page that opens without a network")
    parser.add_argument("--figures", metavar="FOLDER", help="write the figures as PNG and SVG into a new folder")


@dataclass(frozen=True)
class ReportJob:
    """Where report and figures go, None where they are not wanted; and the files they are about."""

    page: Path | None
    figures: Path | None
    bags: tuple[str, ...]
    machine: str
    effects: tuple[str, ...]

    def origin(self) -> dict[str, Any]:
        """JSON: the files with their hashes, the versions, the command line and the date."""
        from pneumo_ros.report.provenance import provenance

        return provenance(self.bags, self.machine, sys.argv[1:], self.effects)

    def publish(self, console: Console, make: "Callable[[dict[str, Any]], Report]") -> None:
        """Write what was asked for; `make` builds the report, if it is wanted, from its origin."""
        if self.page is None and self.figures is None:
            return
        report = make(self.origin())
        if self.page is not None:
            _write_page(report, self.page, console)
        if self.figures is not None:
            _write_figures(report, self.figures, console)


def _write_page(report: "Report", path: Path, console: Console) -> None:
    from pneumo_ros.report.page import page_html

    text = page_html(report)
    write_whole(path, text)
    console.note(f"Report written to {path} ({len(text.encode()) / 1e6:.1f} MB)")


def _write_figures(report: "Report", path: Path, console: Console) -> None:
    from pneumo_ros.report.drawing import draw_charts

    with whole_folder(path) as folder, console.progress("Drawing") as progress:
        folder.mkdir()
        count = draw_charts(report.charts(), folder, progress)
    console.note(f"{count} figures written to {path}, each as PNG and SVG")


def prepare_report(options: argparse.Namespace) -> ReportJob:
    """Check before any work that report and figures can be written, and that their libraries are installed."""
    if options.report is not None:
        require_libraries(("plotly",))
    if options.figures is not None:
        require_libraries(("matplotlib",))
    return ReportJob(
        page=None if options.report is None else check_writable(options.report),
        figures=None if options.figures is None else check_new_folder(options.figures),
        bags=tuple(bag for role in ("bags", "fit", "holdout") for bag in getattr(options, role, None) or ()),
        machine=str(options.model),
        effects=tuple(options.effects),
    )
