"""Friction and flow coefficients from constant-voltage recordings."""

from dataclasses import dataclass, field
from typing import Any

from pneumo_ros.api import notebook
from pneumo_ros.api.inputs import Given, Machine, Progress, machine, runs_of
from pneumo_ros.api.result import Result, Row, telling
from pneumo_ros.command.console import plain
from pneumo_ros.command.identification_text import headline, text
from pneumo_ros.identify import campaign
from pneumo_ros.identify.summary import summary
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import whole
from pneumo_ros.report.chart import Report
from pneumo_ros.runs.inputs import check_driven, measuring
from pneumo_ros.units import LINE, writing


@dataclass(frozen=True)
class IdentificationResult(Result):
    """Friction and flow coefficients with their intervals, and the static map that they come from.

    model: the identified machine; detail: the evidence, with every stretch of constant velocity, in SI units.
    """

    model: Model = field(repr=False)
    detail: campaign.Identification = field(repr=False)

    @property
    def undetermined(self) -> dict[str, str]:
        """Parameters that the recordings do not determine, each with the reason; they kept their values."""
        return self.detail.undetermined

    def rows(self) -> list[Row]:
        """A row for each parameter: value before and after, and 95 % interval in `unit`."""
        keys = ("before", "value", "low", "high", "unit", "determined", "meaning")
        found = self.as_dict()["parameters"]
        return [{"parameter": name, **{key: one[key] for key in keys}} for name, one in found.items()]

    def __str__(self) -> str:
        with writing(self.data):
            return text(self.as_dict(), verbose=False)

    def _repr_html_(self) -> str:
        with writing(self.data):
            table = notebook.rows_table(self.rows(), "Identified parameters, with 95 % intervals")
            return notebook.page(headline(self.as_dict()), not self.undetermined, table)

    def _page(self, origin: dict[str, Any]) -> Report:
        from pneumo_ros.report.identification import identification_report

        return identification_report(self.as_dict(), self.model, origin)


@writing(LINE)
def identify(recordings: Given, model: Machine = "axis", *, progress: Progress | None = None) -> IdentificationResult:
    """Identify friction and flow coefficients from constant-voltage `recordings`, with 95 % intervals.

    Arguments as for `compare`. Raises UsageError for a model without LuGre friction, DataError when the recordings
    hold too few stretches of constant velocity or nothing that drives the piston.
    """
    plant = machine(model)
    given = runs_of(recordings, plant)
    chosen = measuring(plant, given.runs)
    check_driven(chosen, given.runs)
    found = campaign.identify(chosen, given.runs, progress=telling(progress))
    after = whole(plant, found.model)
    return IdentificationResult(plain(summary(found, given.runs)), given.notes, given.paths, after, found)
