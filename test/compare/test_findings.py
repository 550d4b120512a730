"""The printed findings for recordings whose hidden effect is known."""

import pytest
from identify.making import own, rig

from pneumo_ros.command.console import plain
from pneumo_ros.compare.compare import compare
from pneumo_ros.compare.findings import Finding, explained, findings, verdict
from pneumo_ros.compare.wording import amount, number, percent, times
from pneumo_ros.plant import load_model


def told(effect: str, size: float) -> tuple[dict[str, Finding], str]:
    """Findings on two runs of a rig that hides an effect, and the verdict."""
    model, _, run = rig("train_sweep", effect=effect, size=size)
    runs = [run, rig("train_steps", effect=effect, size=size)[2]]
    result = plain(compare(model, runs).as_dict())
    return {one.target: one for one in findings(result)}, verdict(result)


@pytest.fixture(scope="module")
def viscous() -> tuple[dict[str, Finding], str]:
    return told("viscous_friction", 180.0)


def test_missing_friction_is_found_in_the_momentum_and_follows(
    viscous: tuple[dict[str, Finding], str],
) -> None:
    found, sentence = viscous
    assert found["momentum"].level == "bad"
    assert any(detail.startswith("follows: velocity") for detail in found["momentum"].details)
    assert found["chamber_a"].level == found["chamber_b"].level == "good"
    assert "momentum fails" in sentence
    assert "chamber" not in sentence


def test_the_worst_intervals_name_their_run(viscous: tuple[dict[str, Finding], str]) -> None:
    (worst,) = [detail for detail in viscous[0]["position_m"].details if detail.startswith("worst: ")]
    assert "train_sweep" in worst or "train_steps" in worst


def test_a_leak_is_found_in_the_chambers_and_not_in_the_momentum() -> None:
    found, sentence = told("cross_piston_leakage", 3e-10)
    assert found["momentum"].level == "good"
    assert {found["chamber_a"].level, found["chamber_b"].level} == {"bad"}
    assert "chamber a and chamber b fail" in sentence
    assert any("pressure a - b" in detail for detail in found["chamber_a"].details)


def test_the_true_machine_is_praised_in_one_sentence() -> None:
    model, _, run = own("sweep", seconds=8.0)
    result = plain(compare(model, [run]).as_dict())
    assert all(one.level == "good" for one in findings(result) if one.target != "position_m")
    assert verdict(result).startswith("Noise explains")


def compared(equation: bool | None, *ratios: float) -> dict[str, object]:
    """The part of the JSON of `compare` that decides: one equation, and the typical window of each signal."""
    error = {f"signal_{i}": {"typical_ratio_to_noise": ratio} for i, ratio in enumerate(ratios)}
    return {"equations": {"momentum": {"explained_by_noise": equation}}, "runs": [{"windows": 9, "error": error}]}


def test_noise_explains_what_the_headline_says_it_does() -> None:
    assert explained(compared(True, 1.0, 1.0, 1.4))  # one signal is off; the typical window is 1.15 x
    assert explained(compared(None, 1.0, 1.0, 1.0))
    assert not explained(compared(False, 1.0, 1.0, 1.0))
    assert not explained(compared(True, 1.0, 1.0, 2.2))


def test_what_could_not_be_judged_is_left_open() -> None:
    _, _, run = own("steps", seconds=2.0)
    still = type(run)("still", run.sample_time, run.position * 0.0, run.pressure_a, run.pressure_b, run.input * 0.0,
                      run.measured, False)  # fmt: skip
    (momentum,) = [f for f in findings(plain(compare(load_model(), [still], 0.5).as_dict())) if f.target == "momentum"]
    assert momentum.level == "open"
    assert "never slides" in momentum.verdict


def test_numbers_read_well() -> None:
    assert amount(0.00034, "position_m") == "0.34 mm"
    assert amount(1.86e-5, "chamber_a") == "18.6 mg/s"
    assert amount(None, "momentum") == "-"
    assert (times(1.04), times(14.2), times(123.4), times(202913.0), times(None)) == (
        "1.0 x",
        "14 x",
        "123 x",
        "202913 x",
        "-",
    )
    assert (percent(0.0), percent(0.004), percent(0.625), percent(None)) == ("0 %", "< 1 %", "62 %", "-")
    assert (number(1e-9), number(700000.0, 3), number(float("nan"))) == ("1e-09", "700000", "-")
