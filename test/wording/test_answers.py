"""The answer of a diagnosis in words: the sizes of an effect, each or the largest of many."""

from typing import Any

from pneumo_ros.wording.answers import answers


def added(effect: str, **parameters: tuple[float, float | None]) -> dict[str, Any]:
    """The JSON of a diagnosis that added an effect; each parameter with its deviation."""
    words = {
        key: {"value": value, "std": std, "unit": "1", "meaning": f"coefficient of the profile at {key[-2:]}/24"}
        for key, (value, std) in parameters.items()
    }
    one = {"effect": effect, "parameters": words, "indistinguishable_from": []}
    return {"added": [one | {"holdout_error_before": 9.0, "holdout_error_after": 1.0}]}


def test_of_the_many_sizes_of_a_profile_the_largest_are_named() -> None:
    profile = {f"knot_{k:02}": (1e-15, None) for k in range(20)}
    profile |= {f"knot_{20 + k}": (value, 0.01) for k, value in enumerate((0.05, -0.3, 0.2, 0.1, 0.015))}
    size = answers(added("position_dependent_friction", **profile))[0].size
    assert size.startswith("4 of 25 coefficients are not 0; the largest: coefficient of the profile at 21/24 -0.30")
    assert size.count("95 %") == 3
    assert "e-15" not in size


def test_a_profile_of_which_nothing_is_sure_is_not_listed() -> None:
    profile = {f"knot_{k:02}": (0.01, None) for k in range(25)}
    assert answers(added("position_dependent_friction", **profile))[0].size == "25 coefficients, each of which may be 0"


def test_few_sizes_are_all_named() -> None:
    size = answers(added("payload_mass", mass_added=(4.5, 0.1), other=(1.0, None)))[0].size
    assert size == "mass added 4.50 (95 %: 4.30 to 4.70); other 1 (not determined)"
