"""The answer to an unknown name."""

import pytest

from pneumo_ros.nearest import unknown_name

VERBS = ("identify", "diagnose", "simulate", "compare")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("indentify", "unknown verb 'indentify'; did you mean identify?"),
        ("SIMULATION", "unknown verb 'SIMULATION'; did you mean simulate?"),
        ("diagnosis", "unknown verb 'diagnosis'; did you mean diagnose?"),
        ("zzz", "unknown verb 'zzz'; known are compare, diagnose, identify, simulate"),
    ],
)
def test_the_nearest_names_are_offered_or_all_of_them(given: str, said: str) -> None:
    assert unknown_name("verb", given, VERBS) == said


def test_where_nothing_is_known_that_is_said() -> None:
    assert unknown_name("topic", "valve", ()) == "unknown topic 'valve'; none is known"
