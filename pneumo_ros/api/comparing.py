"""A model against recordings."""

from dataclasses import dataclass, field
from typing import Any

from pneumo_ros.api import notebook
from pneumo_ros.api.inputs import Given, Machine, Progress, machine, runs_of
from pneumo_ros.api.result import Result, Row, telling
from pneumo_ros.command.console import plain
from pneumo_ros.command.verb.compare import comparison_text, equations_text, findings_text
from pneumo_ros.compare import compare as judging
from pneumo_ros.compare.findings import explained, verdict
from pneumo_ros.compare.moved import refit_dict
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import whole
from pneumo_ros.report.chart import Report
from pneumo_ros.runs.inputs import measuring
from pneumo_ros.shooting.refit import SEGMENT, refit
from pneumo_ros.units import LINE, writing


@dataclass(frozen=True)
class ComparisonResult(Result):
    """How much a model differs from recordings, in which equation and regime.

    model: as compared, refitted if that was asked; detail: the errors along every run, in SI units.
    """

    model: Model = field(repr=False)
    detail: judging.Comparison = field(repr=False)

    @property
    def explained(self) -> bool:
        """Whether sensor noise explains every equation and the typical prediction."""
        return explained(self.as_dict())

    def rows(self) -> list[Row]:
        """A row for each run and signal: rms over the windows, largest error and noise in `unit`, and their ratio."""
        found = list[Row]()
        for run in self.detail.runs:
            for name, error in run.error.items():
                found.append(
                    {
                        "run": run.name, "signal": name, "rms": error.rms, "max": error.max, "noise": error.noise,
                        "ratio_to_noise": error.ratio, "fit_percent": error.fit_percent, "free_run_rms": run.free[name],
                    }
                )  # fmt: skip
        return found

    def __str__(self) -> str:
        with writing(self.data):
            return "\n\n".join(
                (comparison_text(self.detail), equations_text(self.detail), findings_text(self.as_dict()))
            )

    def _repr_html_(self) -> str:
        with writing(self.data):
            table = notebook.rows_table(self.rows(), f"Errors over {self.detail.horizon:g} s, in SI units")
            return notebook.page(verdict(self.as_dict()), self.explained, table)

    def _page(self, origin: dict[str, Any]) -> Report:
        from pneumo_ros.report.comparison import comparison_report

        return comparison_report(self.as_dict(), self.detail, self.model, origin)


@writing(LINE)
def compare(
    recordings: Given,
    model: Machine = "axis",
    *,
    horizon: float | None = None,
    fit: Given | None = None,
    segment: float | None = None,
    progress: Progress | None = None,
) -> ComparisonResult:
    """Compare a model with recordings: errors per run and signal, and the equations that fail.

    `recordings`: paths, folders of recordings, or what `read` returns; one or several. `model`: a machine file, the
    name of a shipped one, or a Model. Each run is predicted in windows of `horizon` [s], by default of 1 s,
    or less where a run is shorter. `fit`: recordings to which the parameters of the model are fitted first, in segments
    of `segment` [s], by default of 0.5 s: long ones show slow laws. Raises UsageError for a horizon or segment that is
    no time and for recordings that hold no window of it, DataError for a recording that cannot be used.
    """
    if segment is not None and not (fit is not None and segment > 0.0):
        raise UsageError(f"segment is {segment:g}; it takes seconds above 0, and goes with fit=, recordings to fit")
    if horizon is not None and not horizon > 0.0:
        raise UsageError(f"horizon is {horizon:g}; it takes seconds above 0, such as horizon=1.0")
    tell, plant = telling(progress), machine(model)
    given = runs_of(recordings, plant)
    fitted = None if fit is None else runs_of(fit, plant)
    chosen, data = measuring(plant, [*given.runs, *(fitted.runs if fitted else ())]), dict[str, Any]()
    if fitted:
        found = refit(
            chosen, fitted.runs, segment=segment or SEGMENT, progress=lambda share, text: tell(0.5 * share, text)
        )
        chosen, data = found.model, {"refit": refit_dict(found, [one.name for one in fitted.runs])}
    begin = 0.5 if fitted else 0.0
    detail = judging.compare(chosen, given.runs, horizon, lambda share, text: tell(begin + (1 - begin) * share, text))
    notes, paths = (*given.notes, *(fitted.notes if fitted else ())), (*given.paths, *(fitted.paths if fitted else ()))
    return ComparisonResult(plain(detail.as_dict() | data), notes, paths, whole(plant, chosen), detail)
