"""Parameters as data: types, ranges, and the messages of refusals."""

import math
from typing import Any

import pytest

from pneumo_ros.axis.controller.settings import SETTINGS as CONTROLLER
from pneumo_ros.axis.controller.settings import absent, check
from pneumo_ros.axis.setting import Setting
from pneumo_ros.errors import UsageError

MASS = Setting("mass", 5.0, "moving mass", "kg", 0.1)
SHAPE = Setting("shape", "sine", "of the reference", choices=("sine", "steps"))
LEVELS = Setting("levels", [0.0, 0.06], "references", "m", -1.0, 1.0)
SEED = Setting("seed", 0, "of the noise", "", 0, 100)


@pytest.mark.parametrize(
    ("setting", "given", "taken"),
    [
        (MASS, 7, 7.0),
        (MASS, 7.5, 7.5),
        (SHAPE, "steps", "steps"),
        (LEVELS, [0, 1], [0.0, 1.0]),
        (SEED, 3, 3),
        (Setting("on", True, ""), False, False),
    ],
)
def test_good_values_are_taken_as_their_type(setting: Setting, given: Any, taken: Any) -> None:
    value = setting.coerce(given)
    assert value == taken
    assert type(value) is type(taken)


@pytest.mark.parametrize(
    ("setting", "given", "said"),
    [
        (MASS, math.nan, "mass is nan [kg]; allowed is 0.1 or more"),
        (MASS, 0.0, "allowed is 0.1 or more"),
        (MASS, "heavy", "mass is 'heavy'; it takes a number, 0.1 or more"),
        (MASS, True, "it takes a number"),
        (SEED, 1.5, "it takes a whole number"),
        (SEED, 101, "allowed is 0 to 100"),
        (SHAPE, "sin", "did you mean sine?"),
        (LEVELS, [0.0, 2.0], "allowed is -1 to 1"),
        (LEVELS, "0.0", "it takes a list"),
        (Setting("on", True, ""), 1, "it takes true or false"),
    ],
)
def test_bad_values_are_refused_in_words(setting: Setting, given: Any, said: str) -> None:
    with pytest.raises(UsageError) as refused:
        setting.coerce(given)
    assert said in str(refused.value)


def test_the_controller_refuses_a_law_that_does_not_know_the_valve() -> None:
    given = {one.name: one.default for one in CONTROLLER} | {"law": "cascade"}
    check(given)
    other = given | {"effects": ["dead_zone", "own_valve"]}
    with pytest.raises(UsageError, match="this machine lists dead_zone, own_valve: take law pid"):
        check(other | absent(other))
    check(other | absent(other) | {"law": "pid"})
