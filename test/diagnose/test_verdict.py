"""The one rule for a verdict, on every kind of outcome: failures, misfits too small to matter, missed effects."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.compare.verdicts import EquationVerdict, SignalError
from pneumo_ros.diagnose.diagnosis import remains
from pneumo_ros.diagnose.outcome import Addition, Value
from pneumo_ros.diagnose.score import Score
from pneumo_ros.diagnose.verdict import driving, failing, material, missed, rises, verdict
from pneumo_ros.plant import load_model

FORCE, FLOW = 100.0, 1e-3  # N, kg/s, drive force and flow of the equations
MODEL = load_model("axis")
VISCOUS = Addition("viscous_friction", {}, (), 9.0, 1.0, 80.0, Score(900.0, 100.0))
SPOOL = replace(VISCOUS, effect="valve_spool_dynamics")
NOISE, SWING = 5e-6, 0.1  # m, of the position, and how far it swings to and fro with a period of 4 s


def compared(typical: float = 1.0, **left: tuple[float, float]) -> Comparison:
    """A comparison with these misfits in each equation, in its unit and over noise; predictions over noise."""
    flows = {f"port_flow_{chamber}": np.array([FLOW, -FLOW]) for chamber in "ab"}
    seen = {"drive": np.array([FORCE, -FORCE]) + 7.0, "force": np.array([7.0, 7.0]), **flows}
    position = SWING * np.sin(0.5 * np.pi * 0.01 * np.arange(2000))
    motion = SimpleNamespace(seen=seen, run=SimpleNamespace(judged={"position_m": position}, sample_time=0.01))
    error = {"position_m": SignalError(typical * NOISE, 1.0, 99.0, NOISE, typical)}
    equations = {
        name: EquationVerdict(rms, "N" if name == "momentum" else "kg/s", ratio, ratio <= 1.1)
        for name, (rms, ratio) in left.items()
    }
    bins = SimpleNamespace(centre=np.zeros(3), mean=np.zeros(3), below=np.zeros(3), above=np.zeros(3))
    along = SimpleNamespace(bins=bins, noise=np.ones(3), seconds=np.ones(3), explained_share=0.5)
    dependences = {name: {"position": along} for name in left}
    runs = [SimpleNamespace(motion=motion, error=error, windows=20)]
    found = {"equations": equations, "runs": runs, "dependences": dependences, "horizon": 1.0}
    return cast(Comparison, SimpleNamespace(**found))


def left(equation: str, rms: float, ratio: float) -> Comparison:
    """The same of one equation."""
    return compared(**{equation: (rms, ratio)})


def test_the_drive_force_and_the_drive_flow() -> None:
    assert driving(left("momentum", 1.0, 2.0), "momentum") == pytest.approx(FORCE, rel=1e-12)
    assert driving(left("chamber_b", 1.0, 2.0), "chamber_b") == pytest.approx(FLOW, rel=1e-12)


@pytest.mark.parametrize(
    ("equation", "first", "last", "matters"),
    [
        ("chamber_a", (7e-4, 160.0), (2e-5, 4.6), False),  # an inexact law of the added effect
        ("chamber_a", (7e-4, 160.0), (2e-4, 46.0), True),  # a twelfth of the first misfit, and a fifth of the flow
        ("chamber_a", (1.2e-5, 3.0), (8e-6, 2.0), True),  # nothing explained it
        ("momentum", (20.0, 400.0), (0.5, 10.0), False),  # less than the scatter of friction
        ("momentum", (20.0, 400.0), (2.0, 40.0), False),
        ("momentum", (20.0, 400.0), (6.0, 120.0), True),
    ],
)
def test_a_large_rest_is_no_inexact_law_however_much_more_was_there(
    equation: str, first: tuple[float, float], last: tuple[float, float], matters: bool
) -> None:
    assert material(equation, left(equation, *first), left(equation, *last)) is matters


QUIET = {"momentum": (0.04, 1.0), "chamber_a": (4e-6, 1.0)}
TEXTURE = QUIET | {"momentum": (0.5, 12.0)}  # half a per cent of the drive
LEAKING = QUIET | {"chamber_a": (7e-4, 160.0)}
RUBBING = QUIET | {"momentum": (8.0, 200.0)}
BOTH = {"momentum": (0.5, 50.0), "chamber_a": (1.2e-5, 3.0)}  # the largest excess over noise is too small to matter
FAR = 1500.0  # noise floors: 7.5 mm, more than a twentieth of what the position changes by within a second


@pytest.mark.parametrize(
    ("first", "last", "typical", "added", "word", "fails"),
    [
        (QUIET, QUIET, 1.0, [], "adequate", ()),
        (TEXTURE, TEXTURE, 1.2, [], "adequate", ()),
        (RUBBING, RUBBING, 50.0, [], "unknown_effect", ("momentum",)),
        (LEAKING, LEAKING, 1.0, [], "unknown_effect", ("chamber_a",)),
        (BOTH, BOTH, 1.0, [], "unknown_effect", ("chamber_a",)),
        (QUIET, QUIET, FAR, [], "unknown_effect", ()),
        (RUBBING, QUIET, 1.0, [VISCOUS], "effects_found", ("momentum",)),
        (RUBBING, TEXTURE, 1.2, [VISCOUS], "effects_found", ("momentum",)),
        (TEXTURE, QUIET, 1.0, [VISCOUS], "effects_found", ("momentum",)),
        (LEAKING, QUIET, 1.0, [SPOOL], "effects_found", ("chamber_a", "valve")),
        (RUBBING | {"chamber_a": LEAKING["chamber_a"]}, LEAKING, 90.0, [VISCOUS], "unknown_effect",
         ("momentum", "chamber_a")),
        (RUBBING, QUIET, FAR, [VISCOUS], "unknown_effect", ("momentum",)),
    ],
)  # fmt: skip
def test_no_verdict_is_good_while_an_equation_or_a_prediction_fails(
    first: dict[str, Any], last: dict[str, Any], typical: float, added: list[Addition], word: str, fails: tuple[str]
) -> None:
    before, after = compared(**first), compared(typical, **last)
    assert verdict(added, remains(before, after), missed(after)) == word
    assert failing(before, after, added, MODEL) == fails
    if not added:
        assert (word == "adequate") is not (bool(fails) or typical == FAR)


@pytest.mark.parametrize(
    ("values", "parts"),
    [
        ({"gap": 2e-4, "load_share": 0.0, "load_gap": 4e-4}, ("momentum", "sensor")),
        ({"gap": 0.0, "load_share": 0.3, "load_gap": 4e-4}, ("momentum",)),
    ],
)
def test_a_play_acts_in_the_sensor_only_where_it_lies_before_it(values: dict[str, float], parts: tuple[str]) -> None:
    before, after = compared(**RUBBING), compared(**QUIET)
    play = replace(VISCOUS, effect="backlash", parameters={k: Value(v, 0.1 * v, "m") for k, v in values.items()})
    assert failing(before, after, [play], MODEL) == parts


def test_an_equation_with_too_few_windows_for_bins_fails_nonetheless() -> None:
    """It was called adequate, at 133 noise floors, as no variable could be shown that the residual follows."""
    failed = compared(**RUBBING)
    failed.dependences["momentum"] = {}
    rest = remains(failed, failed)
    assert rest is not None
    assert (rest.equation, rest.against, rest.material) == ("momentum", "", True)
    assert failing(failed, failed, [], MODEL) == ("momentum",)
    assert verdict([], rest, missed(failed)) == "unknown_effect"


def test_what_is_missed_is_said_with_its_size() -> None:
    (one,) = missed(compared(FAR, **QUIET))
    assert one.sentence.startswith("predictions of the position on held-out recordings are off by 7.5 mm, 8 %")
    assert missed(compared(400.0, **QUIET)) == ()


@pytest.mark.parametrize(
    ("before", "after", "worse"), [(270.0, 476.0, True), (5.0, 5.01, True), (5.0, 5.0, False), (1.05, 1.06, False)]
)
def test_predictions_get_worse_unless_noise_explains_them(before: float, after: float, worse: bool) -> None:
    first, second = ({"position_m": np.full(40, np.log(error))} for error in (before, after))
    assert rises(first, second) is worse


def test_a_rise_within_the_scatter_of_windows_is_none() -> None:
    """Two of forty windows, in which a breakaway is predicted too early or too late."""
    before = np.full(40, np.log(2.0))
    after = before + np.where(np.arange(40) < 2, 1.5, 0.0)
    assert not rises({"position_m": before}, {"position_m": after})
    assert rises({"position_m": before}, {"position_m": before + 0.075})  # the same rise, in every window


def test_a_rise_in_one_of_four_recordings_is_none() -> None:
    """Windows of one recording are not independent; ten of each recording rise alike. By a tenth, one decides.

    Unless the others gain more: a leak of 1878 nats was refused, with which three of four are predicted far better.
    """
    recording = np.repeat(np.arange(4), 10)
    before = {"position_m": np.full(40, np.log(2.0))}
    in_one, in_all = ({"position_m": before["position_m"] + 0.05 * rises_in} for rises_in in (recording == 3, 1.0))
    assert rises(before, in_one)
    assert not rises(before, in_one, recording)
    assert rises(before, in_all, recording)
    much = {"position_m": before["position_m"] + 0.2 * (recording == 3)}
    assert rises(before, much, recording)
    others = {"position_m": much["position_m"] - 0.1 * (recording != 3)}
    assert not rises(before, others, recording)
    random = np.random.default_rng(1).normal(0.0, 1.0, 40) * (recording == 3)  # a few breakaways at another moment
    assert not rises(before, {"position_m": much["position_m"] + random}, recording)
