"""The score of models: evidence of residuals with noise and a discrepancy that no model has."""

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.freedom import uneven
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.judging import judged
from pneumo_ros.diagnose.score import Scoring, log_prior, moved, occam, surprise
from pneumo_ros.plant import Model, load_model

Array = NDArray[np.float64]
HOP, N = 0.025, 8000
MODEL = load_model("axis")
LOAD = coordinates(MODEL.library.find("constant_load"))


def evidence(windows: int = N, name: str = "momentum 100 ms", runs: int = 1) -> Evidence:
    """The part of the evidence that scores read: one family of windows, of one newton of noise each."""
    each = windows // runs
    parts = {
        "names": (name,), "family": np.zeros(windows, dtype=np.int64), "noise": np.ones(windows),
        "drive": 1000.0, "runs": [SimpleNamespace(sample_time=1e-3)],
        "time": np.tile(HOP * np.arange(each), runs), "run": np.repeat(np.arange(runs), each),
    }  # fmt: skip

    def noise_of(model: Model) -> Array:
        """All of it is noise of the position, which the mass amplifies."""
        return np.full(windows, model["piston.mass"] / MODEL["piston.mass"])

    return cast(Evidence, SimpleNamespace(**parts, noise_of=noise_of, amplify=lambda _models: None))


def noise(seed: int, windows: int = N, scale: float = 1.0) -> Array:
    """Noise of overlapping windows: neighbours share half of it, every second one is independent."""
    white = np.random.default_rng(seed).normal(size=windows + 1)
    return scale * (white[1:] + white[:-1]) / np.sqrt(2.0)


def slow(seed: int, size: float, time: float = 1.0) -> Array:
    """A process of Ornstein and Uhlenbeck of this deviation and correlation time."""
    kept = np.exp(-HOP / time)
    steps = np.random.default_rng(seed).normal(size=N) * size * np.sqrt(1.0 - kept * kept)
    values = np.empty(N)
    values[0] = size * np.random.default_rng(seed + 1).normal()
    for k in range(1, N):
        values[k] = kept * values[k - 1] + steps[k]
    return values


def gained(without: Array, with_it: Array, scoring: Scoring | None = None) -> float:
    """Nats that training and held-out runs gain, with the same residuals in both."""
    scoring = scoring or Scoring(evidence(), evidence())
    return float(np.sum(scoring.at(MODEL, with_it, with_it).evidence - scoring.at(MODEL, without, without).evidence))


@pytest.mark.parametrize("seed", range(6))
def test_noise_of_another_scale_is_no_evidence(seed: int) -> None:
    """A model whose noise is computed half a thousandth too large explains nothing: candidates differ by less."""
    scoring = Scoring(evidence(), evidence())
    scoring.measure(MODEL, noise(seed), noise(seed))
    assert abs(gained(noise(seed), noise(seed, scale=0.9995), scoring)) < 3.0


@pytest.mark.parametrize("seed", range(6))
def test_one_noise_serves_all_models_that_are_compared(seed: int) -> None:
    """A fast discrepancy that fades is worth 30 nats a step, not 550 in the step where more noise explains it, too."""
    fast, quiet = slow(seed, 0.45, 0.03), noise(seed, scale=0.98)
    scoring = Scoring(evidence(), evidence())
    scoring.measure(MODEL, quiet + fast, quiet + fast)
    nats = [gained(quiet + fast, quiet + (1.0 - 0.03 * k) * fast, scoring) for k in range(11)]
    assert min(np.diff(nats)) > 10.0
    assert max(np.diff(nats)) < 70.0


def test_the_scale_of_the_noise_is_found_between_its_steps() -> None:
    """A ten-thousandth of noise less once was worth twelve nats, where the scale fell to its next step."""
    nats = [gained(noise(1), noise(1, scale=1.0 - 1e-4 * k)) for k in range(1, 40)]
    assert max(abs(np.diff(nats, prepend=0.0))) < 1.0


@pytest.mark.parametrize("seed", range(3))
def test_a_mass_that_amplifies_noise_is_judged_by_its_own_noise(seed: int) -> None:
    """A payload as heavy as the piston doubles the noise; it once was called worse by hundreds of nats."""
    heavy = MODEL.with_parameters({"piston.mass": 2.0 * MODEL["piston.mass"]})
    scoring, quiet, loud = Scoring(evidence(), evidence()), noise(seed), noise(seed, scale=2.0)
    change = scoring.at(heavy, loud, loud).evidence - scoring.at(MODEL, quiet, quiet).evidence
    assert abs(float(change.sum())) < 1e-6
    missed = scoring.at(heavy, loud, loud).evidence - scoring.at(MODEL, quiet + slow(seed, 2.0), quiet).evidence
    assert float(missed.sum()) > 100.0


@pytest.mark.parametrize("seed", range(3))
def test_a_discrepancy_counts_in_the_noise_that_a_mass_amplifies(seed: int) -> None:
    """A load of the piston's mass that is there: all of its residual is twice as large, noise and rest alike."""
    heavy = MODEL.with_parameters({"piston.mass": 2.0 * MODEL["piston.mass"]})
    scoring, small = Scoring(evidence(), evidence()), noise(seed) + slow(seed, 0.5, 0.03)
    change = scoring.at(heavy, 2.0 * small, 2.0 * small).evidence - scoring.at(MODEL, small, small).evidence
    assert abs(float(change.sum())) < 1.0


@pytest.mark.parametrize("seed", range(3))
def test_a_scale_of_the_noise_that_only_a_candidate_found_is_no_merit_of_it(seed: int) -> None:
    """More noise and a fast discrepancy are nearly the same: 2 % more of it was worth hundreds of nats."""
    left, scoring = noise(seed), Scoring(evidence(), evidence())
    scoring.usual = {"momentum 100 ms": (0.5, 0.03, 0.9)}  # as the model without the candidate came upon it
    own = scoring.at(MODEL, left, left)
    other = replace(own, fit=(0.0 * left, 0.0 * left, np.zeros(0)), noise={"momentum 100 ms": (0.0, 0.03, 1.0)})
    assert float((scoring.in_noise_of([other], MODEL, own)[0].evidence - own.evidence).sum()) > 100.0


def test_the_same_noise_is_no_gain() -> None:
    """Every candidate once lost five nats by the scale that it shares with the model without it."""
    left, scoring = noise(3, scale=1.03), Scoring(evidence(), evidence())
    scoring.usual = {"momentum 100 ms": (0.0, 0.03, 1.0)}
    own = scoring.at(MODEL, left, left)
    again = scoring.in_noise_of([own], MODEL, own)[0]
    assert again.evidence == pytest.approx(own.evidence, abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_held_out_recordings_have_a_discrepancy_of_their_own(seed: int) -> None:
    """A part of what they lack is explained; the rest is another effect, of which training has nothing."""
    scoring, few, effect, second = Scoring(evidence(), evidence(N // 4)), N // 4, slow(seed, 4.0), slow(seed + 10, 8.0)
    left = noise(seed + 20, few) + second[:few]
    before = scoring.at(MODEL, noise(seed) + 2.0 * effect, left + effect[:few])
    after = scoring.at(MODEL, noise(seed), left)
    together = float(after.evidence[1] - before.evidence[1])
    alone = scoring.heldout(MODEL, after, MODEL, before)
    assert together < 0.0 < alone
    assert scoring.heldout(MODEL, before, MODEL, after) < 0.0
    assert scoring.heldout(MODEL, after, MODEL, after) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_what_is_constant_beside_noise_is_seen(seed: int) -> None:
    """Two sets of 2000 independent windows: 0.2 noise deviations are worth 4000 x 0.02 nats."""
    nats = gained(noise(seed) + 0.2, noise(seed))
    assert 15.0 < nats < 120.0


@pytest.mark.parametrize("seed", range(6))
def test_the_same_beside_a_slow_discrepancy_is_not(seed: int) -> None:
    """A hundred correlation times: the thousands of windows count as few. What changes faster is still seen."""
    other = noise(seed) + slow(seed, 1.0)
    assert gained(other + 0.2, other) < 15.0
    assert gained(other + np.sin(15.0 * HOP * np.arange(N)), other) > 100.0


def test_a_discrepancy_that_is_removed_counts_by_its_time() -> None:
    """The faster it changes, the more independent parts it has."""
    fast, slower = (gained(noise(0) + slow(3, 3.0, time), noise(0)) for time in (0.2, 5.0))
    assert fast > 2.0 * slower > 100.0


def test_single_wild_windows_say_little() -> None:
    wild = noise(0)
    wild[4000] = 1e4
    assert 0.0 < gained(wild, noise(0)) < 50.0


@pytest.mark.parametrize("runs", [2, 8])
def test_one_long_run_counts_as_its_pieces(runs: int) -> None:
    whole, pieces = Scoring(evidence(), evidence()), Scoring(evidence(runs=runs), evidence(runs=runs))
    before, after = noise(0) + slow(3, 2.0), noise(0)
    one, many = gained(before, after, whole), gained(before, after, pieces)
    assert many == pytest.approx(one, rel=0.02)


def test_the_order_of_runs_does_not_matter() -> None:
    part = evidence(runs=4)
    turned = np.concatenate(np.split(np.arange(N), 4)[::-1])
    before, after = noise(0) + slow(3, 2.0), noise(0)
    one, other = (gained(before[k], after[k], Scoring(part, part)) for k in (np.arange(N), turned))
    assert one == pytest.approx(other, rel=0.01)


def test_breakaways_count_each() -> None:
    part = Scoring(evidence(40, "breakaway"), evidence(40, "breakaway"))
    spread = 0.5 * np.random.default_rng(0).normal(size=40)
    assert gained(spread + 2.0, spread, part) > 40.0
    assert abs(gained(spread, spread[::-1], part)) < 1e-9


def fitted(count: int, slope: float, shift: float = 0.0) -> tuple[BaseFit, Hypothesis, Hypothesis]:
    """A base with one parameter, nothing, and a candidate of `count` coordinates of equal slopes."""
    rng = np.random.default_rng(0)
    part = evidence()
    base = BaseFit(
        MODEL, MODEL, ("piston.mass",), np.ones(1), np.array([shift]), part, noise(0),
        rng.normal(size=(N, 1)),
    )  # fmt: skip
    nothing = Hypothesis("", (), np.empty(0), np.zeros(1), noise(0))
    slopes = slope * rng.normal(size=(N, count))
    return (
        base,
        nothing,
        Hypothesis("constant_load", LOAD * count, np.zeros(count), np.zeros(1), noise(0), slopes=slopes),
    )


def test_free_coordinates_cost_by_their_number_and_by_how_well_they_are_known() -> None:
    one, many = (occam(*fitted(count, 1.0)[::2]) for count in (1, 25))
    assert one == pytest.approx(0.5 * np.log(1.0 + 0.36 * N), rel=0.05)
    assert many == pytest.approx(25.0 * one, rel=0.05)
    assert occam(*fitted(1, 0.0)[::2]) == pytest.approx(0.0)


def known(*shift: float, bends: int = 0, uneven: int = 0) -> float:
    """Nats that base parameters lose which moved by as many deviations."""
    n, none = len(shift), np.empty(0)
    names = tuple(f"{k}" for k in range(n))
    base = BaseFit(
        MODEL, MODEL, names, np.ones(n), np.zeros(n), cast(Evidence, None), none, none, bends, uneven
    )  # fmt: skip
    return surprise(base, np.array(shift))


def test_one_wrong_parameter_is_more_probable_than_two_that_moved_together() -> None:
    # a wrong line in the file, however wrong: not more than an effect must gain
    assert known(10.0, 0.0) == pytest.approx(8.0, abs=0.01)
    assert known(7.0, -7.0) == pytest.approx(16.0, abs=0.01)
    assert known(0.5) == pytest.approx(0.5 * 0.5**2, rel=0.01)


def test_a_point_of_a_profile_is_no_line_of_the_file() -> None:
    """A tight spot of ten textures is an effect: in single 9140 such points hid 5 % of friction for 8 nats each."""
    assert known(10.0, 10.0, bends=1, uneven=1) == pytest.approx(8.0 + 50.0, abs=0.01)
    assert known(10.0, 1.0, 10.0, bends=2, uneven=1) == pytest.approx(8.0 + 0.5 + 8.0, abs=0.01)


def test_base_parameters_that_return_to_what_is_known_of_them_are_evidence() -> None:
    base, nothing, h = fitted(1, 1.0, shift=3.0)
    back = np.array([-3.0])
    assert surprise(base, nothing.shift) + log_prior(base, back, h) == pytest.approx(4.5, abs=0.05)
    h.u = np.array([2.0])
    assert surprise(base, nothing.shift) + log_prior(base, back, h) == pytest.approx(2.5, abs=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_base_parameters_are_fitted_with_the_correlation_of_what_no_model_has(seed: int) -> None:
    """A slow discrepancy hides what a parameter does to least squares; to the evidence it does not."""
    part, shape = evidence(), np.sin(15.0 * HOP * np.arange(N))
    drift = slow(seed, 4.0)
    slopes = (shape + drift / 4.0)[:, None]  # what it does resembles the drift, too
    base = BaseFit(MODEL, MODEL, ("piston.mass",), np.ones(1), np.zeros(1), part, noise(0), slopes)
    residual = noise(seed) + drift + 0.5 * shape
    plain = -np.linalg.solve(slopes.T @ slopes + np.eye(1), slopes.T @ residual)
    scoring, fits = Scoring(part, part), (base, base)
    begin = moved((residual, residual, np.zeros(1)), fits, plain)
    best = scoring.best(MODEL, fits, [begin])
    found, (train, held, shift) = best.evidence, best.fit
    assert abs(shift[0] + 0.5) < 0.5 * abs(plain[0] + 0.5)
    assert float(found[0]) > float(scoring.at(MODEL, *begin[:2]).evidence[0]) + 50.0
    assert train == pytest.approx(residual + slopes @ shift)
    assert held == pytest.approx(train)


@pytest.mark.parametrize("seed", range(3))
def test_of_several_starts_the_best_counts(seed: int) -> None:
    """Windows of two kinds ask for a parameter 30 deviations apart: a climb ends at the kind that is nearer."""
    part, slopes = evidence(name="breakaway"), np.ones((N, 1))
    few = np.random.default_rng(seed).random(N) < 0.3
    base = BaseFit(MODEL, MODEL, ("a",), np.ones(1), np.zeros(1), part, noise(0), slopes)
    scoring, fits = Scoring(part, part), (base, base)
    near = noise(seed, scale=0.3) + 3.0 * few, noise(seed + 1, scale=0.3) + 3.0 * few, np.zeros(1)
    far = moved(near, fits, np.array([-3.0]))
    one, other, both = (scoring.best(MODEL, fits, starts) for starts in ([near], [far], [far, near]))
    assert float(one.evidence.sum()) > float(other.evidence.sum()) + 20.0
    assert both.evidence == pytest.approx(one.evidence)


def test_what_training_hardly_determines_decides_nothing_on_held_out_runs() -> None:
    """As the friction at a place that training passed once: its value there is chance, and no error of the model."""
    part, here = evidence(), np.zeros((N, 1))
    once, often = here.copy(), here.copy()
    once[:20], often[:4000] = 1.0, 1.0
    train_fit, held_fit = (
        BaseFit(MODEL, MODEL, ("a",), np.ones(1), np.zeros(1), part, noise(0), s) for s in (once, often)
    )
    scoring, fits = Scoring(part, part), (train_fit, held_fit)
    without = noise(1), noise(2), np.zeros(1)
    chance = without[0] - 0.5 * once[:, 0], without[1], np.zeros(1)  # an effect that meets the few windows by chance
    alone, beside = (scoring.best(MODEL, fits, [one]).evidence for one in (without, chance))
    plain = (
        scoring.at(MODEL, *moved(chance, fits, np.array([0.5]))[:2]).evidence[1]
        - scoring.at(MODEL, *without[:2]).evidence[1]
    )
    assert plain < -20.0
    assert abs(beside[1] - alone[1]) < 5.0


@pytest.mark.parametrize("seed", range(3))
def test_held_out_runs_with_more_that_no_model_has_still_support_an_effect(seed: int) -> None:
    """As pulses of force that nobody recorded: training alone is explained to its noise, and held-out runs are not."""
    part, shape, slopes = evidence(), 3.0 * np.sin(20.0 * HOP * np.arange(N)), np.zeros((N, 1))
    base = BaseFit(MODEL, MODEL, ("a",), np.ones(1), np.zeros(1), part, noise(0), slopes)
    beside = noise(seed), noise(seed + 1) + slow(seed, 10.0), np.zeros(1)
    without = beside[0] + shape, beside[1] + shape, np.zeros(1)
    scoring = Scoring(part, part)
    found = [scoring.best(MODEL, (base, base), [one]).evidence for one in (without, beside)]
    assert min(found[1] - found[0]) > 0.0


def test_a_profile_is_no_worse_for_places_that_training_did_not_pass() -> None:
    """Friction along the stroke, found where training went: held-out runs go farther, and must not lose by it."""
    profile = "position_dependent_friction"
    whole = MODEL.with_effects([*MODEL.effects, profile], {f"{profile}.knot_12": 0.0})
    part, place = evidence(), (np.arange(N) // 200) % 25
    passed = 30.0 * np.eye(25)[place]  # deviations of the noise by a usual size of each point
    here, beyond = passed * (place < 12)[:, None], passed
    plain = BaseFit(MODEL, whole, ("a",), np.ones(1), np.zeros(1), part, np.zeros(N), np.zeros((N, 1)))
    true, found = np.linspace(0.5, 2.0, 25), coordinates(MODEL.library.find(profile))[:12]
    base = uneven(replace(plain, residual=noise(0) - here @ true), {profile: 0.1 * here})
    held = uneven(replace(plain, residual=noise(1) - beyond @ true), {profile: 0.1 * beyond})
    u, nothing = np.where(np.arange(25) < 12, true, 0.0), Hypothesis("", (), np.empty(0), np.zeros(26), base.residual)
    h = Hypothesis(profile, found, u[:12], np.zeros(26), base.residual + here @ u, slopes=here[:, :12])
    one = judged(base, held, [h], [held.residual + beyond @ u], nothing, first=True)[0]
    assert one.score.held > one.score.train > 100.0  # more places, more evidence
