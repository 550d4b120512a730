"""Effects added by name."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from pneumo_ros.api import notebook
from pneumo_ros.api.inputs import Given, Machine, Progress, machine, runs_of
from pneumo_ros.api.result import Result, Row, telling
from pneumo_ros.command.adding_json import adding_dict
from pneumo_ros.command.adding_text import headline, text
from pneumo_ros.command.console import plain
from pneumo_ros.command.roles import check_copies
from pneumo_ros.diagnose import adding
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import whole
from pneumo_ros.report.chart import Report
from pneumo_ros.runs.inputs import measuring
from pneumo_ros.units import LINE, writing
from pneumo_ros.wording.errors import steps


@dataclass(frozen=True)
class AddingResult(Result):
    """Effects added to a model and fitted: the error before and after, in noise floors.

    model: with the effects, refitted; detail: both models against the judged runs, in SI units.
    """

    model: Model = field(repr=False)
    detail: adding.Adding = field(repr=False)

    @property
    def errors(self) -> tuple[float, float, float]:
        """The typical error of the model as given, refitted, and with the effects, in noise floors."""
        return self.detail.errors

    def rows(self) -> list[Row]:
        """A row for each parameter of the added effects: value, standard deviation and 95 % interval in `unit`."""
        return [
            {
                "effect": one["effect"],
                "parameter": key,
                **{k: value[k] for k in ("value", "std", "low", "high", "unit")},
            }
            for one in self.as_dict()["added"]
            for key, value in one["parameters"].items()
        ]

    def __str__(self) -> str:
        with writing(self.data):
            return text(self.as_dict())

    def _repr_html_(self) -> str:
        with writing(self.data):
            data = self.as_dict()
            course = notebook.waterfall(steps([(one["model"], one["error"]) for one in data["course"]]))
            table = notebook.rows_table(self.rows(), "What was added")
            return notebook.page(headline(data), self.errors[2] <= self.errors[1], table, course)

    def _page(self, origin: dict[str, Any]) -> Report:
        from pneumo_ros.report.adding import adding_report

        data = self.as_dict()
        compared = plain(self.detail.after.as_dict() | {"refit": data["refit"], "added": data["added"]})
        return adding_report(self.detail, data | {"headline": headline(data)}, compared, origin)


@writing(LINE)
def add(
    effects: str | Sequence[str],
    recordings: Given,
    model: Machine = "axis",
    *,
    holdout: Given | None = None,
    horizon: float | None = None,
    progress: Progress | None = None,
) -> AddingResult:
    """Add `effects` by name to a model, refit it to `recordings`, and judge it on `holdout`, or on what was fitted.

    Arguments as for `diagnose`. Raises UsageError for an unknown effect, with the nearest names, for one that the
    model has or that cannot be fitted, and for a recording in both roles; DataError for one that cannot be used.
    """
    plant, names = machine(model), [effects] if isinstance(effects, str) else list(effects)
    adding.check_addable(plant, names)
    held = None if holdout is None else runs_of(holdout, plant)
    judged = {path.resolve() for path in held.paths} if held else set()
    fitted = runs_of(recordings, plant, without=judged)
    judging = held.runs if held else ()
    check_copies(fitted.runs, judging)
    chosen = measuring(plant, [*fitted.runs, *judging])
    found = adding.add(chosen, names, fitted.runs, judging, progress=telling(progress), horizon=horizon)
    notes, paths = (*fitted.notes, *(held.notes if held else ())), (*fitted.paths, *(held.paths if held else ()))
    return AddingResult(plain(adding_dict(found)), notes, paths, whole(plant, found.model), found)
