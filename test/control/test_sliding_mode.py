"""Sliding mode on the plant, and its boundary layer."""

import numpy as np
from control.following import STICKY, follow, law_for

from pneumo_ros.control.figures import arrivals, tracking
from pneumo_ros.control.reference import moves, sine


def test_it_follows_a_sine_on_the_machine_and_on_a_stickier_one() -> None:
    for plant in (None, STICKY):
        record = follow(law_for("sliding_mode"), sine(0.3, 0.05), 20.0, *([plant] if plant else []))
        assert tracking(record, 5.0).rms < 3e-3


def test_moves_end_and_the_piston_stays() -> None:
    ends = arrivals(follow(law_for("sliding_mode"), moves([0.0, 0.06, 0.0], 6.0, 1.0), 18.0), 6.0)
    assert max(end.error for end in ends) < 1e-3
    assert max(end.motion for end in ends) < 5e-5


def test_a_thin_boundary_layer_chatters() -> None:
    wide, thin = (
        follow(law_for("sliding_mode", layer=phi), sine(0.2, 0.08), 8.0).voltage[3000:] for phi in (8.0, 0.05)
    )
    assert np.abs(np.diff(thin)).sum() > 2.0 * np.abs(np.diff(wide)).sum()
