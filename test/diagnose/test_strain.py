"""Effects that base parameters imitate; these are moved back to their known values."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.strain import followed
from pneumo_ros.plant import Model, load_model

N = 600
RNG = np.random.default_rng(2)
NOISE, OPENING, BEND = RNG.normal(size=N), RNG.normal(size=N), RNG.normal(size=N)
LIMIT, OFFSET = "dead_zone.right_limit", "valve_null_offset.offset"
MODEL = load_model("axis")
FOUND = MODEL.with_effects([*MODEL.effects, "valve_null_offset"], {OFFSET: 0.15})


def evidence() -> Evidence:
    """The part of it that is read: one family, blocks of ten."""
    names, family, block = ("chamber_a 40 ms",), np.zeros(N, dtype=np.int64), np.arange(N) // 10
    return cast(Evidence, SimpleNamespace(names=names, family=family, block=block))


def fit(model: Model, names: tuple[str, ...], offset: float, slopes: list[np.ndarray]) -> BaseFit:
    """A model that leaves noise and the error of an added effect's law; the last parameter can bend that law."""
    count, bend = len(names), 0.1
    far = np.array([offset, *np.zeros(count)])
    columns = np.stack([*slopes, bend * BEND], axis=1)
    prior = np.array([*np.full(count, 0.03), bend])
    return BaseFit(model, model, (*names, "added 0"), prior, far, evidence(), NOISE + 0.1 * BEND, columns, bends=1)


class Played:
    """A fitter with known refits."""

    train = held = evidence()

    def fits(self, model: Model, bent: list[str]) -> tuple[BaseFit, BaseFit]:
        assert bent == ["payload_mass"]  # not the law of the judged effect
        found = fit(model, (LIMIT, OFFSET), 0.0, [OPENING, OPENING])
        return found, found

    def added(self, model: Model) -> list[str]:
        return ["payload_mass"]

    def extended(self, model: Model, h: Hypothesis) -> Model:
        return FOUND

    def refit(self, model: Model, iterations: int, share: float = 0.0) -> Model:
        return model

    def deviations(self, model: Model) -> dict[str, float]:
        return {LIMIT: 0.01, OFFSET: 0.01}


def test_it_is_judged_with_laws_as_free_as_without_it() -> None:
    base: Any = fit(MODEL, (LIMIT,), 7.0, [OPENING])  # seven deviations from the known value
    own = coordinates(MODEL.library.find("valve_null_offset"))
    idle = coordinates(MODEL.library.find("viscous_friction"))[:1]  # as a parameter of another form of an effect
    seen = Hypothesis("valve_null_offset", (*own, *idle), np.ones(2), np.zeros(2), NOISE, relief=20.0)
    (found,), (held,) = followed(cast(Fitter, Played()), base, [seen], 0.0, [])
    assert found.name == "valve_null_offset"
    assert found.coordinates == own
    assert found.relief == pytest.approx(24.5, abs=0.1)
    assert found.t == pytest.approx(15.0)
    for left in (found.residual, held):  # the bend is removed from its place
        assert abs(float(left @ BEND) / N) < 0.02
        assert float(left @ left) / N == pytest.approx(float(NOISE @ NOISE) / N, rel=0.02)
