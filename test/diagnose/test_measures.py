"""The misfit that an effect removes, measured where it acts."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.measures import (
    FEWEST_WINDOWS,
    MATERIAL_FORCE,
    MOST_BLOCK,
    acting,
    explained,
    gains,
    texture,
    together,
    unexplained_force,
)

N, HERE = 4000, 200  # windows, and those in which the effect acts
NOISE = np.random.default_rng(0).normal(size=N)
EVIDENCE = cast(Evidence, SimpleNamespace(names=("chamber_a 200 ms",), family=np.zeros(N, dtype=np.int64)))


def breakaways(count: int, drive: float = 1.0) -> Evidence:
    """Breakaways known to 1 N on a machine whose drive force is `drive` [N]."""
    family, noise = np.zeros(count, dtype=np.int64), np.ones(count)
    return cast(Evidence, SimpleNamespace(names=("breakaway",), family=family, noise=noise, drive=drive))


def effect(windows: int = HERE, size: float = 1.5) -> np.ndarray:
    """The effect's part of the residual: hundreds of windows in a row, and hardly anything elsewhere."""
    added = np.full(N, 0.01)
    added[1000 : 1000 + windows] = size
    return added


def test_a_rare_effect_counts_where_it_acts() -> None:
    before = NOISE + effect()
    there = acting(before, NOISE)
    assert there.sum() == HERE
    assert gains(EVIDENCE, before, NOISE)["chamber_a"] < 0.12
    assert gains(EVIDENCE, before, NOISE, there)["chamber_a"] == pytest.approx(1.5**2 / (1.0 + 1.5**2), abs=0.1)
    assert explained(EVIDENCE, before, NOISE, there) > 0.8


@pytest.mark.parametrize(("force", "least", "most"), [(0.0, 0.0, 0.05), (0.5, 0.48, 0.52)])
def test_the_force_that_stays_unexplained_is_that_beyond_noise(force: float, least: float, most: float) -> None:
    """By the widest windows alone, which have the least noise; the chambers have none of it."""
    names = ("momentum 100 ms", "momentum 40 ms", "chamber_a 200 ms")
    family, noise = np.repeat(np.arange(3), N), np.repeat([0.1, 0.5, 1e-6], N)
    evidence = cast(Evidence, SimpleNamespace(names=names, family=family, noise=noise))
    residual = np.random.default_rng(1).normal(size=3 * N)
    residual[:N] += np.where(np.arange(N) % 2, force, -force) / 0.1
    residual[N:] *= 100.0
    assert least <= unexplained_force(evidence, residual) <= most
    gas = SimpleNamespace(names=names[2:], family=np.zeros(N, dtype=np.int64), noise=noise[:N])
    assert unexplained_force(cast(Evidence, gas), residual[:N]) == 0.0


def test_what_acts_but_explains_nothing_gains_nothing() -> None:
    wrong = NOISE - effect()  # the machine has no such effect
    assert gains(EVIDENCE, NOISE, wrong, acting(NOISE, wrong))["chamber_a"] < 0.0


def test_a_few_windows_say_nothing() -> None:
    before = NOISE + effect(FEWEST_WINDOWS - 1)
    assert gains(EVIDENCE, before, NOISE, acting(before, NOISE)) == {}
    assert explained(EVIDENCE, before, NOISE, acting(before, NOISE)) == 0.0


def test_a_dozen_breakaways_do() -> None:
    """They do not overlap as windows do."""
    slips = breakaways(12)
    after = np.random.default_rng(1).normal(0.0, 0.7, 12)
    assert explained(slips, after + 3.0, after, np.ones(12, dtype=bool)) > 0.8


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_one_block_alone_decides_nothing(sign: float) -> None:
    """However strong its evidence: three others of opposite sign outweigh it."""
    saved, deviations = together(sign * np.array([1000.0, -1.0, -1.0, -1.0]))
    assert saved == pytest.approx(sign * (MOST_BLOCK - 3.0))
    assert abs(deviations) <= 1.0


@pytest.mark.parametrize(("name", "least"), [("breakaway", 0.9), ("chamber_a 200 ms", 0.0)])
def test_breakaways_that_all_change_a_little_are_judged_together(name: str, least: float) -> None:
    """There are twenty of them at most, and their noise is generous: none changes by a quarter of it."""
    family, noise = np.zeros(20, dtype=np.int64), np.ones(20)
    evidence = cast(Evidence, SimpleNamespace(names=(name,), family=family, noise=noise))
    before, after = np.full(20, 0.95), np.full(20, 0.75)
    assert not acting(before, after).any()
    assert explained(evidence, before, after, acting(before, after)) == pytest.approx(least, abs=0.1)


def test_what_is_no_larger_than_a_texture_need_not_be_removed() -> None:
    before, after = np.full(20, 3.0), np.full(20, 2.0)  # N
    everywhere = np.ones(20, dtype=bool)
    machine = breakaways(20, drive=2.0 / MATERIAL_FORCE)
    assert explained(machine, before, after, everywhere) < 0.7
    assert explained(machine, before, after, everywhere, textured=True) == 1.0


def test_below_a_texture_there_is_nothing_to_remove() -> None:
    """However much of it goes, in units of the noise."""
    before, after = np.full(20, 100.0), np.full(20, 50.0)  # N
    everywhere = np.ones(20, dtype=bool)
    machine = breakaways(20, drive=200.0 / MATERIAL_FORCE)
    assert explained(machine, before, after, everywhere) > 0.7
    assert explained(machine, before, after, everywhere, textured=True) == 0.0


def test_a_kind_of_equation_without_a_row_has_no_texture() -> None:
    """Recordings without a breakaway: a median of nothing is no number, and warns."""
    family, noise = np.zeros(20, dtype=np.int64), np.ones(20)
    names = ("momentum 200 ms", "breakaway")
    evidence = cast(Evidence, SimpleNamespace(names=names, family=family, noise=noise, drive=1.0))
    found = texture(evidence)
    assert set(found) == {"momentum"}
    assert np.isfinite(found["momentum"])
