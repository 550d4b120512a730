"""Residuals over variables: every plot that is drawn shows something, and the text names what is not drawn."""

import pytest
from identify.making import own
from report.pages import result_of

from pneumo_ros.compare.compare import compare
from pneumo_ros.report.chart import Section
from pneumo_ros.report.equations import equations_section


def momentum_of(seconds: float) -> tuple[Section, dict[str, dict[str, list[float]]]]:
    """The report's part on the momentum of a machine with too little friction, and its numbers by variable."""
    model, _, run = own("sweep", seconds=seconds)
    result = result_of(compare(model.with_parameters({"lugre_friction.coulomb_friction": 60.0}), [run]))
    (part,) = [one for one in equations_section(result).parts if one.identifier == "equation-momentum"]
    return part, result["equations"]["momentum"]["against"]


@pytest.mark.parametrize("seconds", [2.0, 3.0, 6.0])
def test_a_short_recording_has_fewer_bins_not_empty_plots(seconds: float) -> None:
    part, against = momentum_of(seconds)
    assert len(part.charts) == len(against) == 7
    for found in against.values():
        assert 2 <= len(found["at"]) < 12
        assert min(found["seconds"]) > 0.1


def test_a_recording_of_too_few_windows_is_not_drawn_and_the_text_says_so() -> None:
    part, against = momentum_of(1.5)
    assert len(against) == 7
    assert part.charts == ()
    assert "Too few windows for a plot against velocity" in part.body
