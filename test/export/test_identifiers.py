"""Names that C accepts, one for each name of a machine."""

import pytest

from pneumo_ros.export.identifiers import comment, identifier, prefix_of


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mass", "mass"),
        ("double", "double_"),
        ("double_", "double__"),
        ("ω", "_u03c9"),
        ("class", "class_"),
        ("p", "p_"),
    ],
)
def test_identifier(name: str, said: str) -> None:
    assert identifier(name) == said


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("axis", "axis"),
        ("my-axis 2", "my_axis_2"),
        ("2nd", "machine_2nd"),
        ("äö", "machine_model"),
        ("unit", "unit_model"),
    ],
)
def test_prefix(name: str, said: str) -> None:
    assert prefix_of(name) == said


def test_comment_cannot_be_closed_or_nested() -> None:
    assert comment("N */ x /* y\nz") == "N * / x / * y z"
