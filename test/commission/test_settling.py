"""Two estimates become one: its interval reaches both, and what predictions tell nothing of is not determined."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from pneumo_ros.commission import settling
from pneumo_ros.commission.information import knowledge
from pneumo_ros.commission.settling import _joined, settled
from pneumo_ros.plant import Model, load_model
from pneumo_ros.shooting.estimates import Estimate


def estimate(value: float, std: float) -> Estimate:
    """A static friction [N] known to 20 N before."""
    return Estimate(value, std, value - 1.96 * std, value + 1.96 * std, 35.0, 20.0)


def test_where_predictions_are_believed_they_give_the_value() -> None:
    found = _joined(estimate(32.0, 0.1), estimate(43.0, 0.2), believed=True)
    assert found.value == 43.0
    assert found.std == pytest.approx(math.hypot(0.2, 5.5, 0.043))


def test_where_they_are_not_the_interval_reaches_them_nevertheless() -> None:
    """Half of the difference would end at 98 % of the way, and mostly the predictions are nearer."""
    found = _joined(estimate(32.0, 0.1), estimate(41.0, 0.2), believed=False)
    assert found.value == 32.0
    assert found.low < 41.0 < found.high
    assert found.std == pytest.approx(math.hypot(0.1, 9.0, 0.032))


def test_what_predictions_tell_nothing_of_is_not_determined() -> None:
    along = estimate(0.5, 0.1)
    assert not _joined(along, estimate(0.5, math.inf), believed=True).determined
    assert _joined(along, estimate(0.5, 0.1), believed=True).determined


STATIC = "lugre_friction.static_friction"


@pytest.mark.parametrize(
    ("ends", "begins", "value"),
    [
        ([(111.0, 0.9), (112.0, 0.8)], [120.0], 111.0),  # at the noise at once
        ([(111.0, 5.0), (112.0, 0.9)], [120.0, 111.0], 112.0),
        ([(111.0, 5.0), (112.0, 9.0)], [120.0, 111.0], 120.0),  # never: the value along the motion
        ([(111.0, 5.0), (112.0, 4.0), (113.0, 3.0), (114.0, 0.9)], [120.0, 111.0, 112.0], 120.0),
    ],
)
def test_a_fit_above_the_noise_is_gone_on_with_about_the_data_sheet(
    monkeypatch: pytest.MonkeyPatch, ends: list[tuple[float, float]], begins: list[float], value: float
) -> None:
    """Each end: a static friction [N] and a cost over that of noise. Without centres, priors follow each fit."""
    sheet, begun = load_model("axis"), []

    def refit(model: Model, runs: Any, *, free: tuple[str, ...], priors: dict[str, float], centres: Any) -> Any:
        begun.append(model[STATIC])
        assert centres == {name: sheet[name] for name in free}
        found, cost = ends[len(begun) - 1]
        values = {name: Estimate(model[name], 0.1, 0.0, 0.0, sheet[name], priors[name]) for name in free}
        values[STATIC] = replace(values[STATIC], value=found)
        end = model.with_parameters({STATIC: found})
        return SimpleNamespace(model=end, estimates=values, costs=(125.0 * cost,), segments=1, left_out=0)

    monkeypatch.setattr(settling, "refit", refit)
    known = knowledge(sheet, ())
    along = {name: replace(one, value=120.0) if name == STATIC else one for name, one in known.estimates.items()}
    known = replace(known, model=sheet.with_parameters({STATIC: 120.0}), estimates=along)
    runs: list[Any] = [SimpleNamespace(signals=("position_m",), sample_time=2e-3)]
    assert settled(sheet, known, runs).estimates[STATIC].value == value
    assert begun == begins
