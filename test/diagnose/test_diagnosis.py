"""What remains after a diagnosis: a small rest of what was explained, or too much for that."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.compare.verdicts import EquationVerdict
from pneumo_ros.diagnose.diagnosis import driving, material

FORCE, FLOW = 100.0, 1e-3  # N, kg/s, what drives the equations


def left(equation: str, rms: float, ratio: float) -> Comparison:
    """A comparison that leaves so much in an equation, in its unit and over noise."""
    flows = {f"port_flow_{chamber}": np.array([FLOW, -FLOW]) for chamber in "ab"}
    seen = {"drive": np.array([FORCE, -FORCE]) + 7.0, "force": np.array([7.0, 7.0]), **flows}
    unit = "N" if equation == "momentum" else "kg/s"
    found = {equation: EquationVerdict(rms, unit, ratio, False)}
    runs = [SimpleNamespace(motion=SimpleNamespace(seen=seen))]
    return cast(Comparison, SimpleNamespace(equations=found, runs=runs))


def test_forces_and_flows_are_told_from_what_drives_them() -> None:
    assert driving(left("momentum", 1.0, 2.0), "momentum") == pytest.approx(FORCE, rel=1e-12)
    assert driving(left("chamber_b", 1.0, 2.0), "chamber_b") == pytest.approx(FLOW, rel=1e-12)


@pytest.mark.parametrize(
    ("equation", "first", "last", "matters"),
    [
        ("chamber_a", (7e-4, 160.0), (2e-5, 4.6), False),  # the shape of what was added
        ("chamber_a", (7e-4, 160.0), (2e-4, 46.0), True),  # a twelfth of what was there, and a fifth of the flow
        ("chamber_a", (1.2e-5, 3.0), (8e-6, 2.0), True),  # nothing explained it
        ("momentum", (20.0, 400.0), (0.5, 10.0), False),  # less than friction repeats to
        ("momentum", (20.0, 400.0), (2.0, 40.0), False),
        ("momentum", (20.0, 400.0), (6.0, 120.0), True),
    ],
)
def test_much_is_no_shape_however_much_more_was_there(
    equation: str, first: tuple[float, float], last: tuple[float, float], matters: bool
) -> None:
    assert material(equation, left(equation, *first), left(equation, *last)) is matters
