"""The current model fitted within what is known of its parameters, and within their ranges."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
from scipy.optimize import lsq_linear

from pneumo_ros.diagnose.basefit import Known, fit_base
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import OVERLAP
from pneumo_ros.plant import load_model

NAMES = tuple(
    f"{effect}.{key}"
    for effect, key in (
        ("viscous_friction", "coefficient"),
        ("asymmetric_viscous_friction", "coefficient_extension"),
        ("asymmetric_viscous_friction", "coefficient_retraction"),
    )
)
CENTRE, PRIOR = np.array([203.5, 0.0, 0.0]), np.array([6.0, 900.0, 1800.0])


def test_a_size_at_the_end_of_its_range_does_not_hold_what_trades_with_it() -> None:
    """Viscous friction of 160 and 230 N s/m by direction, of which 203 are known: neither part falls below zero."""
    axis = load_model("axis")
    model = axis.with_effects(
        [*axis.effects, "viscous_friction", "asymmetric_viscous_friction"],
        dict(zip(NAMES, (203.5, 30.0, 60.0), strict=True)),
    )
    speed = np.random.default_rng(3).uniform(-0.2, 0.2, 400)
    slopes = 10.0 * np.stack([speed, np.maximum(speed, 0.0), np.minimum(speed, 0.0)], axis=1)  # noise of 0.1 N
    measured = slopes @ np.array([160.0, 0.0, 70.0])
    columns = [list(model.parameters).index(name) for name in NAMES]
    evidence: Any = SimpleNamespace(
        names=("momentum 100 ms",),
        family=np.zeros(400, dtype=int),
        residuals=lambda model, values: measured - values[:, columns] @ slopes.T,
    )
    known = Known(NAMES, CENTRE, PRIOR, np.array([0.05, 0.15, 0.3]))
    found = fit_base(cast(Evidence, evidence), model, known)
    rows = np.concatenate([OVERLAP * slopes, np.diag(1.0 / PRIOR)])
    best = lsq_linear(rows, np.concatenate([OVERLAP * measured, CENTRE / PRIOR]), (0.0, np.inf)).x
    assert np.allclose([found[name] for name in NAMES], best, atol=0.05)
    assert abs(found[NAMES[0]] - 160.0) < 1.0
