"""Charts in plain text."""

from pneumo_ros.command.chart import chart


def test_a_step_is_drawn_where_it_happens() -> None:
    time = [0.0, 1.0, 2.0, 3.0]
    text = chart(time, {"*": [0.0, 0.0, 1.0, 1.0]}, "m", width=10, height=3)
    assert text.splitlines() == [
        "1 m |       ***",
        "    |",
        "0 m |*******",
        "    +----------",
        "     0.0  3.0 s",
    ]


def test_later_curves_cover_earlier_ones() -> None:
    text = chart([0.0, 1.0], {"-": [0.0, 0.0], "*": [0.0, 1.0]}, "V", width=4, height=2)
    assert text.splitlines()[1] == "0 V |****"


def test_a_constant_is_a_line() -> None:
    assert chart([0.0, 1.0], {"*": [2.0, 2.0]}, "m", width=3, height=2).splitlines()[0] == "2 m |***"
