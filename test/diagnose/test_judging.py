"""Whether a size is stable when runs are left out, and large enough to matter."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from pneumo_ros.diagnose.candidate import MATERIAL, Candidate
from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.judging import magnitude, remaining, size_in, stable, undetermined
from pneumo_ros.diagnose.steps import Step, without
from pneumo_ros.plant import load_model

MODEL = load_model("axis")
LOAD = coordinates(MODEL.library.find("constant_load"))
RUNS, EACH = 4, 200
RUN = np.repeat(np.arange(RUNS), EACH)


def fitted(slope: list[float], truth: list[float]) -> tuple[BaseFit, Hypothesis]:
    """A load fitted to four runs: `slope` is its effect and `truth` its true value in each run."""
    rng = np.random.default_rng(0)
    C, y = np.array(slope)[RUN], np.array(truth)[RUN]
    residual = C * y + rng.normal(size=len(RUN))
    u = float(C @ residual / (C @ C))
    names, family = ("momentum 100 ms",), np.zeros(len(RUN), dtype=np.int64)
    evidence = SimpleNamespace(
        names=names, family=family, run=RUN, runs=tuple(SimpleNamespace(time=np.zeros(1)) for _ in range(RUNS))
    )
    none = np.empty((len(RUN), 0))
    base = BaseFit(MODEL, MODEL, (), np.empty(0), np.empty(0), cast(Evidence, evidence), residual, none)
    h = Hypothesis("constant_load", LOAD, np.array([u]), np.empty(0), residual - C * u, slopes=-C[:, None])
    return base, h


@pytest.mark.parametrize(
    ("slope", "truth", "expected"),
    [
        ([1.0] * 4, [2.0] * 4, True),
        ([1.0, 1.0, 1.0, 9.0], [0.0, 0.0, 0.0, 2.0], False),  # three runs determine it well, and it is zero there
        ([0.0, 0.0, 0.0, 9.0], [2.0] * 4, True),  # only one run reaches the place where it acts
        ([0.01, 0.01, 0.01, 9.0], [0.0, 0.0, 0.0, 2.0], True),  # it hardly acts in the others
    ],
)
def test_runs_speak_against_a_size_that_they_know(slope: list[float], truth: list[float], expected: bool) -> None:
    assert stable(*fitted(slope, truth)) is expected


@pytest.mark.parametrize(
    ("effect", "values", "material"),
    [
        ("pressure_sensor_offset", {"offset_a": 85.0, "offset_b": 19.0}, False),  # of a usual 5 kPa
        ("pressure_sensor_offset", {"offset_a": 85.0, "offset_b": -900.0}, True),
        ("valve_spool_dynamics", {"angular_frequency": 900.0}, False),  # hardly slower than the command
        ("valve_spool_dynamics", {"angular_frequency": 300.0}, True),
    ],
)
def test_sizes_are_given_in_usual_sizes(effect: str, values: dict[str, float], material: bool) -> None:
    given = {f"{effect}.{key}": value for key, value in values.items()}
    model = MODEL.with_effects([*MODEL.effects, effect], given)
    assert (size_in(model, effect) > MATERIAL) is material


def test_a_spool_damped_like_a_first_order_is_as_large_as_its_lag() -> None:
    own = coordinates(MODEL.library.find("valve_spool_dynamics"))
    ringing, lagging = (magnitude(own, np.array([own[0].u(400.0), own[1].u(zeta)])) for zeta in (0.5, 2.8))
    assert ringing == pytest.approx(magnitude(own, np.array([own[0].u(400.0), own[1].u(0.7)])))
    assert lagging == pytest.approx(4.0 * ringing)


@pytest.mark.parametrize(
    ("effect", "values", "std", "expected"),
    [
        ("asymmetric_friction", {"ratio": -0.027}, {"ratio": 0.029}, True),
        ("asymmetric_friction", {"ratio": -0.07}, {"ratio": 0.029}, False),
        ("asymmetric_friction", {"ratio": -0.027}, {"ratio": np.inf}, False),  # the data do not determine it
        (
            "leakage_to_atmosphere",  # of the other chamber
            {"conductance_a": 5e-10, "conductance_b": 1e-13},
            {"conductance_a": 1e-11, "conductance_b": 1e-11},
            False,
        ),
        (
            "valve_spool_dynamics",  # its damping is a shape
            {"angular_frequency": 960.0, "damping_ratio": 0.7},
            {"angular_frequency": 30.0, "damping_ratio": 0.01},
            True,
        ),
    ],
)
def test_a_size_within_its_deviations_of_zero_may_be_zero(
    effect: str, values: dict[str, float], std: dict[str, float], expected: bool
) -> None:
    model = MODEL.with_effects([*MODEL.effects, effect], {f"{effect}.{key}": x for key, x in values.items()})
    assert undetermined(model, effect, {f"{effect}.{key}": x for key, x in std.items()}) is expected


def test_a_round_whose_effect_vanished_says_so() -> None:
    h = Hypothesis("constant_load", LOAD, np.array([1.0]), np.empty(0), np.empty(0), t=50.0)
    candidate = Candidate(h, np.empty(0), {"momentum": 0.9}, 9.0, 1.0, True, 1.0, True, 0.0, 100.0)
    step = Step(MODEL, (candidate,), candidate, (), {}, {})
    assert without(step, ["spring_load"], "it is gone").added is candidate
    changed = without(step, ["constant_load"], "it is gone")
    assert changed.added is None
    assert changed.candidates[0].objections == ("it is gone",)


@pytest.mark.parametrize(
    ("gain", "rest", "objects"),
    [
        (0.46, 0.004, True),  # the data determine it: it is the inexact law of another effect
        (0.01, 0.004, False),  # they do not: base parameters can replace it
        (0.46, 0.3, False),
    ],
)
def test_an_effect_that_base_parameters_imitate_is_not_the_rest_of_another(
    gain: float, rest: float, objects: bool
) -> None:
    h = Hypothesis("constant_load", LOAD, np.ones(1), np.empty(0), np.empty(0), t=10.0, relief=6.0)
    candidate = Candidate(h, np.empty(0), {"chamber_a": gain}, 9.0, 1.0, True, 0.6, False, 0.0, 900.0, rest=rest)
    assert candidate.absorbed
    assert any("inexact law of an added effect" in words for words in candidate.objections) is objects


def test_what_is_left_is_counted_in_an_equation_where_it_helps() -> None:
    """A thousandth of a large misfit in another equation is chance."""
    candidate = Candidate(
        Hypothesis("line_delay", (), np.empty(0), np.empty(0), np.empty(0)), np.empty(0),
        {"momentum": 0.001, "chamber_a": 0.5}, 9.0, 1.0, True, 0.6, False, 0.0, 900.0,
    )  # fmt: skip
    first, now = {"momentum": 2e5, "chamber_a": 1000.0}, {"momentum": 1e5, "chamber_a": 4.0}
    assert remaining(candidate, first, now) == pytest.approx(0.004)


@pytest.mark.parametrize(("elsewhere", "objects"), [(frozenset({"chamber_a"}), False), (frozenset[str](), True)])
def test_what_explains_an_equation_does_no_harm_where_it_does_not_act(elsewhere: frozenset[str], objects: bool) -> None:
    """Pressure-dependent friction, next to a pressure sensor gain that had been misfitted to compensate for it."""
    h = Hypothesis("pressure_dependent_friction", (), np.empty(0), np.empty(0), np.empty(0), t=200.0)
    gain = {"momentum": 0.99, "chamber_a": -1.09}
    candidate = Candidate(h, np.empty(0), gain, 9.0, 1.0, True, 0.99, False, 0.0, 900.0, elsewhere=elsewhere)
    assert any("% larger" in words for words in candidate.objections) is objects


@pytest.mark.parametrize(
    ("name", "force", "objects"),
    [
        ("position_dependent_friction", 0.9, True),
        ("position_dependent_friction", 1.1, False),
        ("spring_load", 0.9, False),
    ],
)
def test_a_profile_of_a_texture_is_no_effect(name: str, force: float, objects: bool) -> None:
    """It must explain nearly all of a force below a hundredth of the drive force, because it can fit any force."""
    own = coordinates(MODEL.library.find(name))
    h = Hypothesis(name, own, np.full(len(own), 0.3), np.empty(0), np.empty(0), t=20.0)
    candidate = Candidate(h, np.empty(0), {"momentum": 0.2}, 9.0, 0.3, True, 0.66, True, 0.0, 900.0, force=force)
    assert any("misfit beyond noise" in words for words in candidate.objections) is objects
