"""What a model lacks."""

import math
import time
from dataclasses import dataclass, field
from typing import Any

from pneumo_ros.api import notebook
from pneumo_ros.api.inputs import Given, Machine, Progress, machine, runs_of
from pneumo_ros.api.result import Result, Row, telling
from pneumo_ros.command.console import plain
from pneumo_ros.command.diagnosis_json import diagnosis_dict
from pneumo_ros.command.diagnosis_text import text
from pneumo_ros.command.patience import deadline
from pneumo_ros.command.roles import check_copies
from pneumo_ros.command.suggesting import cannot_say, suggested
from pneumo_ros.command.verb.diagnose import search_time
from pneumo_ros.diagnose.adding import estimates_along
from pneumo_ros.diagnose.diagnosis import conclude
from pneumo_ros.diagnose.outcome import UNKNOWN, Addition, Outcome
from pneumo_ros.diagnose.search import Search
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import whole
from pneumo_ros.report.chart import Report
from pneumo_ros.runs.inputs import measuring
from pneumo_ros.units import LINE, writing
from pneumo_ros.wording.additions import additions_table
from pneumo_ros.wording.diagnosis import DiagnosisWords
from pneumo_ros.wording.diagnosis import diagnosis as words


@dataclass(frozen=True)
class DiagnosisResult(Result):
    """Which physical effects a model lacks, confirmed on recordings that were not fitted.

    model: the improved machine; outcome: everything that was found, with every candidate that was tried.
    """

    model: Model = field(repr=False)
    outcome: Outcome = field(repr=False)

    @property
    def verdict(self) -> str:
        """ "adequate", "effects_found" or "unknown_effect"."""
        return self.outcome.verdict

    @property
    def added(self) -> tuple[Addition, ...]:
        """The effects that were added, each with its parameters in SI units, and its rivals."""
        return self.outcome.added

    @property
    def failing(self) -> tuple[str, ...]:
        """What fails before anything is added: momentum, chamber_a, chamber_b, valve, sensor."""
        return self.outcome.failing

    @property
    def words(self) -> DiagnosisWords:
        """The diagnosis in sentences and tables."""
        with writing(self.data):
            return words(self.as_dict())

    @property
    def headline(self) -> str:
        """The verdict in a sentence, with the held-out error."""
        return self.words.headline

    def rows(self) -> list[Row]:
        """A row for each candidate, the best first: nats, held-out error in noise floors, and why it was not added."""
        return [
            {
                "effect": one["effect"], "added": one["added"], "nats": one["score"]["nats"],
                "heldout_nats": one["score"]["heldout_nats"], "holdout_error": one["holdout_error"],
                "equation": one["equation"], "size": one["size"], "objections": "; ".join(one["objections"]),
            }
            for one in self.as_dict()["candidates"]
        ]  # fmt: skip

    def __str__(self) -> str:
        with writing(self.data):
            return text(self.as_dict())

    def _repr_html_(self) -> str:
        with writing(self.data):
            said = self.words
            rivals = [notebook.paragraph(one.rivals) for one in said.added]
            tables = (notebook.table(additions_table(said.added)), *rivals, notebook.waterfall(said.steps))
            sentences = [notebook.paragraph(one) for one in (*said.notes, *said.remains, said.experiment)]
            return notebook.page(said.headline, self.verdict != UNKNOWN, *tables, *sentences)

    def _page(self, origin: dict[str, Any]) -> Report:
        from pneumo_ros.report.diagnosis import diagnosis_report

        return diagnosis_report(self.outcome, self.as_dict(), plain(self.outcome.after.as_dict()), origin)

    def _first(self) -> str:
        return "waterfall"


@writing(LINE)
def diagnose(
    recordings: Given,
    holdout: Given,
    model: Machine = "axis",
    *,
    horizon: float | None = None,
    within: float = math.inf,
    progress: Progress | None = None,
) -> DiagnosisResult:
    """Find which effects a model lacks, add those that the held-out recordings confirm, and refit.

    `recordings` are fitted, `holdout` never; both as for `compare`. A recording of a folder that is held out is not
    fitted. `horizon` [s] of predictions (None: 1 s, or less where a run is shorter); `within` [s] of real time, the
    best answer by then. Raises UsageError without recordings of both roles, or where one is in both; DataError for a
    recording that cannot be used.
    """
    end, tell, plant = time.monotonic() + within, telling(progress), machine(model)
    if not within > 0.0:
        raise UsageError(f"within is {within:g}; it takes seconds above 0, such as within=60")
    held = runs_of(holdout, plant)
    judged = {path.resolve() for path in held.paths}
    fitted = runs_of(recordings, plant, without=judged)
    check_copies(fitted.runs, held.runs)
    chosen = measuring(plant, [*fitted.runs, *held.runs])
    search = Search(chosen, fitted.runs, held.runs, lambda share, doing: tell(0.8 * share, doing), horizon)
    outcome = conclude(search, search.run(deadline(search_time(search, end))), tell)
    estimates = estimates_along(search.fitter, outcome.model)
    data = diagnosis_dict(outcome, estimates, suggested(outcome, chosen.name)) | {"cannot_say": cannot_say(outcome)}
    notes, paths = (*fitted.notes, *held.notes), (*fitted.paths, *held.paths)
    return DiagnosisResult(plain(data), notes, paths, whole(plant, outcome.model), outcome)
