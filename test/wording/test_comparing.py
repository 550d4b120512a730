"""A comparison on one page: the rows that fail, and what to do next."""

from typing import Any

import pytest
from report.pages import compared, result_of

from pneumo_ros.wording.comparing import failing_table, next_step


def result(equation: bool | None, ratio: float, **more: Any) -> dict[str, Any]:
    """The part of the JSON of `compare` that decides: one equation, and the typical window of one signal."""
    run = {"windows": 9, "error": {"position_m": {"typical_ratio_to_noise": ratio}}}
    return {"equations": {"momentum": {"explained_by_noise": equation}}, "runs": [run]} | more


@pytest.mark.parametrize(
    ("found", "step"),
    [
        (result(False, 1.0), "diagnose"),
        (result(False, 9.0, refit={}), "diagnose"),
        (result(True, 9.0), "refit"),
        (result(None, 9.0), "refit"),
        (result(True, 9.0, refit={}), "diagnose"),  # parameters alone did not help
        (result(True, 1.0), "use"),
    ],
)
def test_what_to_do_next(found: dict[str, Any], step: str) -> None:
    assert next_step(found) == step


def test_every_row_fails_and_says_where() -> None:
    """Friction that is too low: the momentum fails, and the chambers do not."""
    data = result_of(compared()[1])
    rows = {row[0]: row for row in failing_table(data).rows}
    assert rows["momentum"][1].startswith("fails: ")
    assert rows["momentum"][3] != "-"
    assert "chamber a" not in rows
    assert rows["position"][1].startswith("is off by ")
    assert all(len(row) == len(failing_table(data).head) for row in rows.values())
