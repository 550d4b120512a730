"""Errors of predictions: step by step from the model as given to the final one, and signal by signal."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from pneumo_ros.compare.wording import SIGNALS, amount, times
from pneumo_ros.wording.naming import change
from pneumo_ros.wording.table import Table

UNNAMED = "friction refitted at breakaways"  # a step that adds and removes no effect


@dataclass(frozen=True)
class StepWords:
    """One model of the course: its name, its error in noise floors, and the change from the step before."""

    name: str
    error: float
    change: str  # '-89 %'; empty for the first step

    @property
    def text(self) -> str:
        """'9.1 x', '1.0 x  (-89 %)'."""
        return times(self.error) + (f"  ({self.change})" if self.change else "")


def steps(course: Sequence[tuple[str, float]]) -> tuple[StepWords, ...]:
    """The steps of a course (name, error in noise floors)."""
    changes = ["", *(change(before, after) for (_, before), (_, after) in pairwise(course))]
    named = [(name if name.strip(" +") else UNNAMED, error) for name, error in course]
    return tuple(StepWords(name, error, text) for (name, error), text in zip(named, changes, strict=True))


def steps_table(found: Sequence[StepWords], horizon: float) -> Table:
    """A row for each step; `horizon` is the length of the predicted windows [s]."""
    head = (f"Error over {horizon:g} s", "noise floors", "change")
    return Table("", head, tuple((one.name, times(one.error), one.change) for one in found), (1, 2))


def signals_table(errors: Mapping[str, Mapping[str, float | None]], heads: Mapping[str, str], what: str) -> Table:
    """A row for each signal: its noise, then its error and the ratio to the noise for each key of `heads`.

    errors: key -> signal -> rms in the signal's unit, with the key `noise` beside those of `heads`, which are in the
    order of the fits. The last column is the change between the last two. what: windows and recordings, for the title.
    """
    rows, keys, noise = [], list(heads), errors["noise"]
    for name in errors[keys[-1]]:
        row = [SIGNALS[name][0], amount(noise[name], name)]
        for key in keys:
            row += [amount(errors[key][name], name), times(_ratio(errors[key][name], noise[name]))]
        rows.append((*row, *(_change(errors[a][name], errors[b][name]) for a, b in list(pairwise(keys))[-1:])))
    columns = [word for head in heads.values() for word in (head, "/ noise")]
    head = ("signal", "noise", *columns, *(["change"] if len(keys) > 1 else []))
    return Table(f"Error by signal over {what}", head, tuple(rows), tuple(range(1, len(head))))


def _ratio(error: float | None, noise: float | None) -> float | None:
    return error / noise if error is not None and noise else None


def _change(before: float | None, after: float | None) -> str:
    return "" if before is None or after is None else change(before, after)
