"""Part files: every shipped figure has a source; a user's folder adds to them; bad files are refused in words."""

from pathlib import Path

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.parts.shelf import load_shelf, read_part, rules

OWN = """name: my-valve
kind: valve
title: A valve of my own
opening: proportional
figures:
  nominal_flow: {value: 500, unit: l/min, low: 450, high: 550, source: sheet}
  bandwidth: {value: 60, unit: Hz, source: sheet}
  signal_low: {value: 0, unit: V, source: sheet}
  signal_closed: {value: 5, unit: V, source: sheet}
  signal_high: {value: 10, unit: V, source: sheet}
sources:
  sheet: {title: Data sheet of my valve, page: 3, year: 2020}
"""


def written(folder: Path, text: str = OWN, name: str = "mine.yaml") -> Path:
    """A part file."""
    path = folder / name
    path.write_text(text)
    return path


def test_every_shipped_figure_has_a_source_and_lies_within_its_interval() -> None:
    parts = load_shelf().parts
    assert sum(part.kind == "valve" for part in parts.values()) >= 18
    assert sum(part.kind == "cylinder" for part in parts.values()) == 13
    for part in parts.values():
        assert part.figures, part.name
        for figure in part.figures.values():
            assert len(figure.source) > 10
            assert figure.low <= figure.value <= figure.high
            assert not figure.rule


def test_rules_are_marked_as_rules() -> None:
    for name, rule in rules().items():
        assert rule.rule == name
        assert len(rule.source) > 10
        assert rule.low <= rule.value <= rule.high


def test_names_of_shipped_parts_are_those_of_their_files() -> None:
    assert all(part.file == f"{name}.yaml" for name, part in load_shelf().parts.items())


def test_published_figures_reach_the_machine_in_si_units() -> None:
    sy = load_shelf().find("smc-sy7000", "valve").figures
    assert (sy["conductance_filling"].value, sy["conductance_exhaust"].value) == pytest.approx((4.1e-8, 4.8e-8))
    assert (sy["critical_ratio_filling"].value, sy["switch_on"].value) == pytest.approx((0.34, 0.053))
    assert load_shelf().find("iso15552-63").figures["rod"].value == pytest.approx(0.020)


def test_a_cylinder_takes_its_stroke_from_its_name() -> None:
    part, stroke = load_shelf().cylinder("iso15552-32-250")
    assert (part.name, stroke) == ("iso15552-32", 0.25)
    assert load_shelf().cylinder("iso6432-25")[1] is None
    for name, error in {
        "iso15552-33-250": "did you mean .*iso15552-32",
        "smc-sy7000": "smc-sy7000 is a valve; this takes a cylinder",
        "iso15552-32-long": "the stroke of iso15552-32-long is 'long'",
    }.items():
        with pytest.raises(UsageError, match=error):
            load_shelf().cylinder(name)


def test_a_folder_of_ones_own_adds_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path)
    figure = load_shelf([tmp_path]).find("my-valve").figures["nominal_flow"]
    assert figure.value == pytest.approx(0.5 / 60)
    assert figure.source == "Data sheet of my valve, p. 3, 2020"
    monkeypatch.setenv("PNEUMO_PARTS", str(tmp_path))
    assert "my-valve" in load_shelf().parts


def test_a_name_is_taken_once(tmp_path: Path) -> None:
    written(tmp_path, OWN.replace("my-valve", "smc-sy7000"))
    with pytest.raises(UsageError, match=r"the name smc-sy7000 is taken by smc-sy7000.yaml"):
        load_shelf([tmp_path])


@pytest.mark.parametrize(
    ("old", "new", "error"),
    [
        ("source: sheet}\n  bandwidth", "source: shet}\n  bandwidth", r"nominal_flow: unknown source 'shet'; did you"),
        (", source: sheet}\n  bandwidth", "}\n  bandwidth", r"it names no source; every figure takes one"),
        ("unit: l/min", "unit: litres", r"nominal_flow: unit 'litres': unknown unit 'litres'"),
        ("unit: Hz, ", "", r"bandwidth: its unit is None; it takes a text such as Hz"),
        ("nominal_flow", "nominal_flo", r"unknown figure 'nominal_flo'; did you mean nominal_flow"),
        ("value: 500", "value: 300", r"its value lies outside low to high"),
        ("value: 60", "value: -60", r"bandwidth is -60 Hz; it takes a number above 0"),
        ("value: 60", "value: fast", r"bandwidth: value is 'fast'; it takes a number"),
        ("opening: proportional", "opening: slowly", r"opening is 'slowly'; it takes proportional or switched"),
        ("kind: valve", "kind: vlave", r"unknown kind 'vlave'; did you mean valve"),
        ("title: Data sheet of my valve, ", "", r"a source takes a title"),
        ("opening: proportional", "opening: switched\nways: 7/2", r"ways is '7/2'; switched valves take 3/2 or 2/2"),
        ("title: A valve of my own\n", "", r"title is None; it takes a text"),
        ("name: my-valve", "nam: my-valve", r"unknown entry 'nam'; did you mean name"),
        ("figures:", "figures: [1]\nx:", r"unknown entry 'x'"),
        ("kind: valve", "kind: cylinder", r"unknown figure 'nominal_flow'"),
    ],
)
def test_bad_files_are_refused_in_words(tmp_path: Path, old: str, new: str, error: str) -> None:
    assert old in OWN
    with pytest.raises(UsageError, match=error) as caught:
        read_part(written(tmp_path, OWN.replace(old, new, 1)))
    assert "mine.yaml" in str(caught.value)


def test_folders_without_parts_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="holds 0 part files"):
        load_shelf([tmp_path])
    with pytest.raises(UsageError, match="is no folder"):
        load_shelf([tmp_path / "none"])
