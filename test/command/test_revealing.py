"""The judge of diagnoses: which answer counts as right, and the printed text."""

import pytest

from pneumo_ros.command.demo.revealing import judge

VISCOUS, LOAD, SPRING = "viscous_friction", "constant_load", "spring_load"


@pytest.mark.parametrize(
    ("hidden", "added", "word", "right"),
    [
        ([], [], "exact", True),
        ([VISCOUS], [(VISCOUS, ())], "exact", True),
        ([VISCOUS], [(VISCOUS, (LOAD, SPRING))], "group", True),
        ([VISCOUS], [(LOAD, (VISCOUS, SPRING))], "group", True),
        ([VISCOUS], [(VISCOUS, (LOAD, SPRING, "line_delay"))], "vague", False),
        ([VISCOUS], [], "missed", False),
        ([VISCOUS], [(VISCOUS, ()), (LOAD, ())], "false addition", False),
        ([], [(LOAD, ())], "false addition", False),
        ([VISCOUS], [(LOAD, (SPRING,))], "wrong", False),
        ([VISCOUS, LOAD], [(LOAD, (VISCOUS,)), (VISCOUS, ())], "group", True),
        ([VISCOUS, LOAD], [(SPRING, (VISCOUS, LOAD))], "missed", False),  # one addition finds one effect
    ],
)
def test_an_answer_is_judged(hidden, added, word, right):
    judgement = judge(hidden, added)
    assert (judgement.word, judgement.right) == (word, right)


def test_a_group_is_matched_by_name_first():
    judgement = judge([VISCOUS, LOAD], [(LOAD, (VISCOUS,)), (SPRING, (VISCOUS,))])
    assert judgement.grouped == (VISCOUS, LOAD)
    assert not judgement.false


def test_groups_are_matched_so_that_most_is_found():
    assert judge([VISCOUS, LOAD], [(SPRING, (VISCOUS, LOAD)), ("line_delay", (VISCOUS,))]).right


def test_the_answer_names_what_went_wrong():
    assert judge([VISCOUS], [(VISCOUS, ())]).sentence() == "The diagnosis is right."
    told = judge([VISCOUS], [(LOAD, ())]).sentence()
    assert "wrong" in told
    assert VISCOUS in told
    assert LOAD in told
    assert LOAD in judge([VISCOUS], [(VISCOUS, ()), (LOAD, ())]).sentence()
    assert VISCOUS in judge([VISCOUS], []).sentence()
