"""What `pneumo diagnose` found, as plain text."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.command.console import table_text
from pneumo_ros.wording.additions import additions_table
from pneumo_ros.wording.candidates import refused_table
from pneumo_ros.wording.diagnosis import DiagnosisWords, diagnosis
from pneumo_ros.wording.errors import steps_table


def text(result: Mapping[str, Any]) -> str:
    """The whole answer; `result` is the verb's JSON."""
    said = diagnosis(result)
    parts = (
        said.headline,
        "\n".join(said.notes),
        table_text(said.equations),
        added(said),
        "\n".join(said.doing),
        table_text(steps_table(said.steps, said.horizon)),
        table_text(said.signals),
        table_text(refused_table(said.candidates)),
        "\n".join(said.remains),
        "\n".join(part for part in (said.moved, table_text(said.moved_table)) if part),
        said.experiment,
    )
    return "\n\n".join(part for part in parts if part)


def added(said: DiagnosisWords) -> str:
    """A row for each parameter of the added effects, and the effects they cannot be distinguished from."""
    rivals = [one.rivals for one in said.added if one.rivals]
    return "\n".join([table_text(additions_table(said.added)), *rivals])
