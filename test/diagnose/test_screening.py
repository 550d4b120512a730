"""The first ranking of candidates."""

from functools import cache

import numpy as np
from identify.making import POSITION_NOISE, PRESSURE_NOISE, voltage

from pneumo_ros.diagnose.basefit import unaided
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.screening import screen
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run

AMPLIFYING = ("payload_mass", "load_compliance", "position_sensor_delay")


@cache
def screened() -> tuple[float, list[Hypothesis]]:
    """The first ranking on a machine that lacks nothing, and the log likelihood of its model."""
    model, rng = load_model("axis"), np.random.default_rng(3)
    time = np.arange(8001) * 1e-3
    held = np.repeat(voltage("sweep", time)[:-1], PARTS)
    start = model.state(p_a=3e5, p_b=3.9e5)
    y, p_a, p_b = np.vstack([start, model.simulate(held, start, sample_time=1e-3, parts=PARTS)])[:, [0, 2, 3]].T
    y = y + rng.normal(0.0, 4.0 * POSITION_NOISE, len(time))
    p_a, p_b = (p + rng.normal(0.0, PRESSURE_NOISE, len(time)) for p in (p_a, p_b))
    run = Run("sweep", 1e-3, y, p_a, p_b, held, np.ones(len(time), dtype=bool), False)
    fitter = Fitter(model, [run], [run])
    base = fitter.ranking_fit(fitter.refit(model))
    return unaided(base).likelihood, screen(base)


def test_no_size_leaves_its_range() -> None:
    for h in screened()[1]:
        for c, u in zip(h.coordinates, h.u, strict=True):
            assert c.low <= c.value(float(u)) <= c.high


def test_a_point_of_a_profile_that_is_hardly_passed_stays_near_zero() -> None:
    """Without its prior, noise in a few windows makes such a point several usual sizes large."""
    profile = next(h for h in screened()[1] if h.name == "position_dependent_friction")
    assert len(profile.u) > 3
    assert float(np.max(np.abs(profile.u))) < 1.0


def test_an_effect_does_not_explain_noise_by_a_negative_size() -> None:
    """A negative mass would lower the noise of the acceleration, with hundreds of log likelihood."""
    nothing, ranked = screened()
    gain = {h.name: h.likelihood - nothing for h in reversed(ranked)}
    assert max(gain[name] for name in AMPLIFYING) < 6.0
