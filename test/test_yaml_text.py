"""Malicious or endless YAML is refused with a message."""

from pathlib import Path

import pytest

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.yaml_text import DEPTH, DIGITS, load_yaml


def test_plain_yaml_is_what_it_says() -> None:
    assert load_yaml("a: [1, 2.5, 0x10, 1:30, yes]\nb: &x {c: d}\ne: *x") == {
        "a": [1, 2.5, 16, 90, True], "b": {"c": "d"}, "e": {"c": "d"},
    }  # fmt: skip
    assert load_yaml("") is None
    assert load_yaml("[" * DEPTH + "]" * DEPTH)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * (DEPTH + 1) + "]" * (DEPTH + 1), "line 1: it is nested deeper than 64 levels"),
        ("[" * 200_000, "nested deeper"),
        ("- " * 100_000, "nested deeper"),
        ("a: 1\nb: 2\na: 3", "line 1: a is given twice"),
        ("\na: " + "9" * (DIGITS + 1), "line 2: a number of 401 digits"),
        ("a: 1:" + ":".join(["59"] * 50_000), "a number of"),
        ("a: 2001-99-99", "month must be in 1..12"),
        ("a: !!int x", "invalid literal"),
        ("a: !!set [a]", "cannot be read as YAML"),
        ("a: !!python/object/apply:os.system [touch canary]", "could not determine a constructor"),
        ("a: !!python/name:os.system", "could not determine a constructor"),
        ("? [a]\n: b", "unhashable"),
        ("a: [", "line 1"),
        ("\0", "special characters are not allowed"),
    ],
)
def test_what_is_refused(text: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match=said) as refused:
        load_yaml(text)
    assert len(str(refused.value)) < 300
    assert not list(tmp_path.iterdir())


def test_a_bomb_of_references_stays_small() -> None:
    """Nine lists of nine references each: 9^9 words, which must not be expanded."""
    lines = ["a: &a [x, x, x, x, x, x, x, x, x]"]
    lines += [f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]" for a, b in zip("abcdefgh", "bcdefghi", strict=True)]
    assert len(brief(load_yaml("\n".join(lines)))) < 1000
